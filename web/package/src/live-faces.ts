/** What users and renderers see of a live model. */

import type { Buffers as RawBuffers, Face as RawFace } from "../wasm/planecut_web.js";

/** A planar, connected region of the boundary, of one material. */
export class Face {
  /** The brush that it is of, where that is known. */
  readonly brush: number | null;
  /** The plane of that brush. */
  readonly plane: number | null;
  /** The name of what it is made of. */
  readonly material: string;
  /** The unit outward normal. */
  readonly normal: Float64Array;
  /** x, y and z of each corner. */
  readonly positions: Float64Array;
  /** Three numbers of corners of each triangle, counter-clockwise seen from outside. */
  readonly triangles: Uint32Array;

  private constructor(raw: RawFace) {
    this.brush = raw.brush ?? null;
    this.plane = raw.plane ?? null;
    ({ material: this.material, normal: this.normal, positions: this.positions, triangles: this.triangles } = raw);
  }

  /** @internal */
  static of(raw: RawFace): Face {
    const face = new Face(raw);
    raw.free();
    return face;
  }
}

/** Faces in single precision, in one list of vertices and one of triangles. Faces share no vertices, as each has a normal of its own. */
export class Buffers {
  /** x, y and z of each corner, relative to the center. */
  readonly positions: Float32Array;
  /** The unit outward normal at each corner. */
  readonly normals: Float32Array;
  /** Three numbers of corners of each triangle, counter-clockwise seen from outside. */
  readonly indices: Uint32Array;
  /** The numbers of the faces, in the order in which they were asked for. */
  readonly faces: Uint32Array;
  /** For each face the name of what it is made of. */
  readonly materials: string[];
  /** Where the corners of each face begin, and last where those of the last one end. */
  readonly vertexStarts: Uint32Array;
  /** Where the triangles of each face begin, and last where those of the last one end. */
  readonly indexStarts: Uint32Array;

  private constructor(raw: RawBuffers) {
    ({ positions: this.positions, normals: this.normals, indices: this.indices } = raw);
    ({ faces: this.faces, materials: this.materials, vertexStarts: this.vertexStarts, indexStarts: this.indexStarts } = raw);
  }

  /** @internal */
  static of(raw: RawBuffers): Buffers {
    const buffers = new Buffers(raw);
    raw.free();
    return buffers;
  }
}

/** @internal */
export type RawGain = { gain: string; volume: number; planes: number[][]; positions: number[][]; triangles: number[][] };

/** What a brush would gain without a plane: a convex body. */
export class Gain {
  /** Four numbers of each plane. */
  readonly planes: Float64Array;
  /** x, y and z of each corner. */
  readonly positions: Float64Array;
  /** Three numbers of corners of each triangle, counter-clockwise seen from outside. */
  readonly triangles: Uint32Array;
  /** The volume. */
  readonly volume: number;

  private constructor({ planes, positions, triangles, volume }: RawGain) {
    this.planes = Float64Array.from(planes.flat());
    this.positions = Float64Array.from(positions.flat());
    this.triangles = Uint32Array.from(triangles.flat());
    this.volume = volume;
  }

  /** @internal */
  static of(raw: RawGain): Gain | "unbounded" | null {
    return raw.gain === "piece" ? new Gain(raw) : raw.gain === "unbounded" ? "unbounded" : null;
  }
}
