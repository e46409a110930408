/** Solids of parameters, points, outlines and meshes. */

import { Solid as Raw } from "../wasm/planecut_web.js";

import { count, flat, loops, type Outline, type Planes, type Points, type Vector } from "./arrays.js";
import { guarded } from "./kernel.js";
import { Mesh, type MeshMaterials } from "./mesh.js";
import { combined, operandsOf, Solid } from "./solid.js";

/** What all shapes have. */
export interface ShapeOptions {
  /** The name of what it is made of. */
  material?: string;
}

/** A shape with corners on circles. */
export interface RoundOptions extends ShapeOptions {
  /** Number of sides around, 3 to 10,000. The first corner is at angle 0. */
  segments?: number;
}

/** How a mesh is taken as a solid. */
export interface TakingOptions {
  /** What of a mesh that crosses itself is inside: points of these winding numbers. */
  winding?: "positive" | "nonzero" | "odd";
  /** Vertices of a mesh that differ by no more than this in each coordinate are joined. */
  close?: number;
}

const shape = (make: () => Raw): Solid => guarded(() => Solid.of(make()));

/**
 * A box between two corners, with sides along the axes.
 *
 * @param min - The lowest coordinates.
 * @param max - The highest coordinates, each above that of `min`.
 */
export function box(min: Vector, max: Vector, { material }: ShapeOptions = {}): Solid {
  return shape(() => Raw.cuboid(flat(min, 3, "min"), flat(max, 3, "max"), material));
}

/** A cube around the origin, or with its lowest corner there. */
export function cube(size: number, { center = true, material }: ShapeOptions & { center?: boolean } = {}): Solid {
  const low = center ? -size / 2 : 0;
  return box([low, low, low], [low + size, low + size, low + size], { ...(material !== undefined && { material }) });
}

/** A sphere around the origin: rings of sides, with corners on the sphere; half as many rings from pole to pole as there are sides around. */
export function sphere(radius: number, { segments = 32, material }: RoundOptions = {}): Solid {
  return shape(() => Raw.sphere(radius, count(segments, "segments"), material));
}

/**
 * A cylinder, cone or frustum along z from 0.
 *
 * @param height - Above 0.
 * @param radius - Of the bottom, not below 0.
 * @param options - `topRadius`: that of the top, by default that of the bottom. One of the two may be 0.
 */
export function cylinder(height: number, radius: number, options: RoundOptions & { topRadius?: number } = {}): Solid {
  const { segments = 48, topRadius = radius, material } = options;
  return shape(() => Raw.cylinder(height, radius, topRadius, count(segments, "segments"), material));
}

/** A cone along z from 0, with its tip at the top. */
export function cone(height: number, radius: number, options: RoundOptions = {}): Solid {
  return cylinder(height, radius, { ...options, topRadius: 0 });
}

/** A prism along z from 0, over a regular polygon with corners on a circle. */
export function prism(height: number, radius: number, sides: number, { material }: ShapeOptions = {}): Solid {
  return shape(() => Raw.prism(height, radius, count(sides, "sides"), material));
}

/** A capsule along z: a cylinder between two half spheres. */
export function capsule(height: number, radius: number, { segments = 32, material }: RoundOptions = {}): Solid {
  return shape(() => Raw.capsule(height, radius, count(segments, "segments"), material));
}

/**
 * A torus around the z axis.
 *
 * @param radius - Of the circle in the middle of the tube.
 * @param tube - Radius of the tube, below that of the circle.
 * @param options - `tubeSegments`: number of sides of the tube.
 */
export function torus(radius: number, tube: number, options: RoundOptions & { tubeSegments?: number } = {}): Solid {
  const { segments = 48, tubeSegments = 24, material } = options;
  return shape(() => Raw.torus(radius, tube, count(segments, "segments"), count(tubeSegments, "tubeSegments"), material));
}

/** The convex body `n · x <= d` of half-spaces; normals need not have unit length. It may be unbounded, or empty. */
export function halfspaces(planes: Planes, { material }: ShapeOptions = {}): Solid {
  return shape(() => Raw.halfspaces(flat(planes, 4, "planes"), material));
}

/** The convex hull of points that are not all in one plane, or of solids together. */
export function hull(of: Points | readonly Solid[], { material }: ShapeOptions = {}): Solid {
  if (Array.isArray(of) && of[0] instanceof Solid) {
    return shape(() => {
      const operands = operandsOf(of as readonly Solid[], "of");
      try {
        return Raw.hullOfSolids(operands, material);
      } finally {
        operands.free();
      }
    });
  }
  return shape(() => Raw.hullOfPoints(flat(of as Points, 3, "points"), material));
}

/** The Minkowski sum of two solids: all sums of a point of the one and a point of the other. */
export function minkowski(a: Solid, b: Solid, { material }: ShapeOptions = {}): Solid {
  return shape(() => Raw.minkowski(a.raw, b.raw, material));
}

/** How an outline is extruded. */
export interface ExtrudeOptions extends ShapeOptions {
  /** Degrees by which the top is turned, clockwise seen from above. */
  twist?: number;
  /** How much wider the top is than the bottom: a number, or one for x and one for y. */
  scale?: number | ArrayLike<number>;
  /** Number of layers; by default 1, and one for each 5 degrees of twist. */
  slices?: number;
}

/**
 * An outline extruded along z from 0.
 *
 * @param outline - A loop of points, or a list of loops: what lies within an odd number of them, so that loops in others are holes. They may run either way.
 * @param height - Above 0.
 */
export function extrude(outline: Outline, height: number, { twist = 0, scale = 1, slices, material }: ExtrudeOptions = {}): Solid {
  const [x, y] = typeof scale === "number" ? [scale, scale] : flat(scale, 2, "scale");
  return shape(() => {
    const [corners, lengths] = loops(outline);
    return Raw.extrude(corners, lengths, height, twist, x ?? NaN, y ?? NaN, slices === undefined ? undefined : count(slices, "slices"), material);
  });
}

/**
 * An outline revolved about the z axis: its x becomes the distance from the axis, its y becomes z.
 *
 * @param outline - As for {@link extrude}, without negative x.
 * @param options - `angle`: degrees, above 0 and at most 360; `segments` are those of a whole turn.
 */
export function revolve(outline: Outline, { segments = 64, angle = 360, material }: RoundOptions & { angle?: number } = {}): Solid {
  return shape(() => Raw.revolve(...loops(outline), angle, count(segments, "segments"), material));
}

/**
 * The solid that a closed mesh bounds; a `PlanecutError` says which edge is open, and where, if it is not closed.
 *
 * A mesh that is a convex body becomes one; any other is a part of the solid as it stands, exactly and without being cut: it may cross itself, lie upon itself and be nested in itself.
 *
 * @param mesh - A mesh, or the coordinates of vertices together with `triangles`.
 */
export function fromMesh(mesh: Mesh, options?: TakingOptions): Solid;
export function fromMesh(positions: Points, triangles: ArrayLike<number> | ArrayLike<ArrayLike<number>>, options?: TakingOptions & MeshMaterials): Solid;
export function fromMesh(
  first: Mesh | Points,
  second?: TakingOptions | ArrayLike<number> | ArrayLike<ArrayLike<number>>,
  third: TakingOptions & MeshMaterials = {},
): Solid {
  const isMesh = first instanceof Mesh;
  const { winding = "positive", close = 0, ...materials } = (isMesh ? (second ?? {}) : third) as TakingOptions & MeshMaterials;
  const mesh = isMesh ? first : new Mesh(first, second as ArrayLike<number>, materials);
  try {
    return shape(() => Raw.fromMesh(mesh.raw, JSON.stringify({ winding, close })));
  } finally {
    if (!isMesh) {
      mesh.free();
    }
  }
}

/** How a file is read. */
export interface LoadOptions extends TakingOptions {
  /** Values for parameters of a model file, by name. */
  parameters?: Readonly<Record<string, number>>;
  /** Whether solids that the file states and that cannot be made are left out, with a warning, instead of being an error. */
  allowLoss?: boolean;
}

/**
 * Reads a solid from the bytes of a file. What was repaired or is doubtful is in its `warnings`.
 *
 * @param bytes - A model file (.json), a Quake-family map (.map), an evaluated tree of OpenSCAD (.csg), or a closed mesh (.obj, .stl, .ply, .glb, .gltf).
 * @param name - Its name, the ending of which tells of which kind it is; errors begin with it.
 */
export function load(bytes: Uint8Array | ArrayBuffer | string, name: string, options: LoadOptions = {}): Solid {
  const data = typeof bytes === "string" ? new TextEncoder().encode(bytes) : new Uint8Array(bytes);
  return shape(() => Raw.load(data, name, JSON.stringify(options)));
}

/** What lies in any of some solids; nothing where there are none. */
export function union(solids: Iterable<Solid>): Solid {
  return combined("union", solids);
}

/** What lies in all of some solids, at least one. */
export function intersection(solids: Iterable<Solid>): Solid {
  return combined("intersection", solids);
}

/** What lies in a solid and in none of others. */
export function difference(solid: Solid, others: Iterable<Solid>): Solid {
  return combined("difference", [solid, ...others]);
}
