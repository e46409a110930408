/** Live models: edits that cost what they touch. */

import { Live as Raw } from "../wasm/planecut_web.js";

import { finite, flat, rowsOfFour, type Planes, type Vector } from "./arrays.js";
import { Edit } from "./edit.js";
import { PlanecutError } from "./errors.js";
import { guarded } from "./kernel.js";
import { Buffers, Face, Gain } from "./live-faces.js";
import { Mesh } from "./mesh.js";
import { Previewer } from "./preview.js";
import { Solid } from "./solid.js";
import { partsOf, type Part, type Role, type RawNode, type RawPart } from "./tree.js";

/** What an edit has changed. */
export interface Change {
  /** The numbers of the faces that are no more. */
  removed: Uint32Array;
  /** The numbers of those that are new, which may be those of faces that were removed. */
  added: Uint32Array;
  /** The numbers of the brushes that came, went or are of other planes, roles or places. */
  brushes: number[];
}

/** What a plane that is dragged is near. */
export interface SnapOptions {
  /** The step of a grid. It has an effect where nothing else is near. */
  grid?: number;
  /** Maximum distance from parallel planes of faces of other brushes. */
  planes?: number;
  /** Maximum distance from corners of the solid. */
  vertices?: number;
}

/** Where a plane snaps to. */
export interface Snap {
  /** The half-space, for `turnPlane`. */
  plane: [number, number, number, number];
  /** What is there. */
  target: "plane" | "vertex" | "grid";
  /** How far away it is. */
  distance: number;
}

interface RawMeasures {
  volume: number;
  area: number;
  centroid: number[] | null;
  min: number[] | null;
  max: number[] | null;
  materials: { name: string; area: number; volume?: number }[];
}

/**
 * A model that is edited: each edit costs what it touches, and says which faces it changed.
 *
 * Its brushes are the convex bodies (and closed meshes) of a solid, numbered from 0 in their order; faces have numbers, too, which may be used again once a face is gone.
 */
export class Live {
  readonly #raw: Raw;
  readonly #previewer: Previewer;

  /** A model of the bodies of a solid. What combines them one after another gives them roles; bodies within nested operations stay operands of these (see `tree`). */
  constructor(solid: Solid) {
    this.#raw = guarded(() => new Raw(solid.raw));
    this.#previewer = new Previewer(this.#raw);
  }

  /**
   * Edits the model: all calls of the edit are one step for `undo`; none where nothing changes. If the function throws, nothing of it is done.
   *
   * @param work - Makes the calls; what it returns is returned. It must not be asynchronous.
   */
  edit<T>(work: (edit: Edit) => T): T {
    guarded(() => this.#raw.begin());
    const edit = new Edit(this.#raw);
    let result: T;
    try {
      result = work(edit);
      if (result instanceof Promise) {
        throw new PlanecutError("found an edit that returns a promise, expected one that is complete when it returns");
      }
    } catch (error) {
      edit.close();
      try {
        guarded(() => this.#raw.cancel());
      } catch {
        // after a bug nothing can be taken back; what went wrong first is what counts
      }
      throw error;
    }
    edit.close();
    guarded(() => this.#raw.commit());
    return result;
  }

  /** What the last edit changed, or the last `undo` or `redo`. */
  get change(): Change {
    return guarded(() => ({ removed: this.#raw.removed(), added: this.#raw.added(), brushes: Array.from(this.#raw.changed()) }));
  }

  /** Undoes the last edit that is not yet undone. */
  undo(): void {
    guarded(() => this.#raw.undo());
  }

  /** Does the edit again that was last undone. */
  redo(): void {
    guarded(() => this.#raw.redo());
  }

  /** How many edits can be undone, and how many done again. */
  get steps(): { undo: number; redo: number } {
    const [undo = 0, redo = 0] = guarded(() => this.#raw.history());
    return { undo, redo };
  }

  /** The calls of an edit, each of which says what it would change and does nothing. Worked out on a copy: what is dragged is better shown by edits and `undo`. */
  get preview(): Previewer {
    return this.#previewer;
  }

  /**
   * What a brush would gain without one of its planes: nothing (null), an unbounded part ("unbounded") or a convex body. The cost is that of the brush alone.
   */
  previewRemovePlane(brush: number, plane: number): Gain | "unbounded" | null {
    return Gain.of(this.query({ query: "preview_remove_plane", brush: finite(brush, "brush"), plane: finite(plane, "plane") }));
  }

  /** The numbers of the brushes. */
  get brushes(): number[] {
    return guarded(() => Array.from(this.#raw.brushes()));
  }

  /** The role of a brush; "add" within nested operations. */
  role(brush: number): Role {
    return this.query<{ role: Role }>({ query: "brush", brush: finite(brush, "brush") }).role;
  }

  /** The name of a brush, null where it has none. */
  brushName(brush: number): string | null {
    return this.query<{ name: string | null }>({ query: "brush", brush: finite(brush, "brush") }).name;
  }

  /** The planes of a brush: from the number of each, by which edits name it, to its normal and offset. */
  planes(brush: number): Map<number, [number, number, number, number]> {
    type Plane = { plane: number; half_space: [number, number, number, number] };
    const { planes } = this.query<{ planes: Plane[] }>({ query: "brush", brush: finite(brush, "brush") });
    return new Map(planes.map(({ plane, half_space }) => [plane, half_space]));
  }

  /** The parts of the model, which are combined one after another by their roles: brushes, and operations on brushes and other operations. */
  get tree(): Part[] {
    const { parts, nodes } = this.query<{ parts: RawPart[]; nodes: RawNode[] }>({ query: "tree" });
    return partsOf(parts, nodes);
  }

  /** The numbers of the faces. */
  get faces(): Uint32Array {
    return guarded(() => this.#raw.faces());
  }

  /** A face by its number. */
  face(id: number): Face {
    return guarded(() => Face.of(this.#raw.face(id)));
  }

  /**
   * Faces as a renderer takes them, in one call: after an edit, those of `change.added`.
   *
   * @param faces - Their numbers.
   * @param center - What positions are relative to. Near the model, single precision loses least.
   */
  buffers(faces: ArrayLike<number>, center: Vector = [0, 0, 0]): Buffers {
    return guarded(() => Buffers.of(this.#raw.buffers(Float64Array.from(faces), flat(center, 3, "center"))));
  }

  /** The first face that a ray meets, and the distance; null where it meets none. */
  pick(origin: Vector, direction: Vector): { face: number; distance: number } | null {
    const [face, distance] = guarded(() => this.#raw.pick(flat(origin, 3, "origin"), flat(direction, 3, "direction")));
    return face === undefined || distance === undefined ? null : { face, distance };
  }

  /**
   * What a plane of a brush that is about to move snaps to; null where nothing is near enough.
   *
   * @param to - Where it is about to go: outward normal and offset.
   */
  snap(brush: number, plane: number, to: Planes, options: SnapOptions = {}): Snap | null {
    type Answer = { to: [number, number, number, number]; distance: number; target: Record<string, unknown> };
    const [half] = rowsOfFour(to, "to");
    const { snap } = this.query<{ snap: Answer | null }>({ query: "snap", brush: finite(brush, "brush"), plane: finite(plane, "plane"), to: half, ...options });
    if (!snap) {
      return null;
    }
    const target = "vertex" in snap.target ? "vertex" : "grid" in snap.target ? "grid" : "plane";
    return { plane: snap.to, target, distance: snap.distance };
  }

  /** The mesh of the solid, the same as that of a new model. */
  mesh(): Mesh {
    return guarded(() => Mesh.of(this.#raw.mesh()));
  }

  /** The volume. Like all measures it is kept up with each edit, and is, bit for bit, that of a new model. */
  get volume(): number {
    return this.measures().volume;
  }

  /** The area of the boundary. */
  get area(): number {
    return this.measures().area;
  }

  /** The center of mass of a solid of the same density everywhere; NaN where the solid is empty. */
  get centroid(): Float64Array {
    return Float64Array.from(this.measures().centroid ?? [NaN, NaN, NaN]);
  }

  /** The least x, y and z, and then the greatest; NaN where the solid is empty. */
  get bounds(): Float64Array {
    const { min, max } = this.measures();
    return Float64Array.from([...(min ?? [NaN, NaN, NaN]), ...(max ?? [NaN, NaN, NaN])]);
  }

  /** The area of the boundary by the name of the material, of those that it has. */
  get areas(): Map<string, number> {
    return sums(this.measures().materials.map(({ name, area }) => [name, area]));
  }

  /** The volume of what is made of each material, by name. Where brushes overlap, what was added last is there; together they are the volume of the solid. */
  get volumes(): Map<string, number> {
    return sums(this.measures(true).materials.map(({ name, volume }) => [name, volume ?? 0]));
  }

  /** The model as it is now, as a solid. */
  toSolid(): Solid {
    return guarded(() => Solid.of(this.#raw.toSolid()));
  }

  /** Gives the memory back at once, instead of when the garbage collector comes by. */
  free(): void {
    this.#raw.free();
  }

  /** As {@link free}, for `using`. */
  [Symbol.dispose](): void {
    this.free();
  }

  private measures(volumes = false): RawMeasures {
    return this.query({ query: "measures", volumes });
  }

  private query<T>(question: Record<string, unknown>): T {
    return guarded(() => JSON.parse(this.#raw.query(JSON.stringify(question))) as T);
  }
}

/** Sums of values of one name, of those above 0. */
function sums(entries: [string, number][]): Map<string, number> {
  const all = new Map<string, number>();
  for (const [name, value] of entries) {
    if (value > 0) {
      all.set(name, (all.get(name) ?? 0) + value);
    }
  }
  return all;
}
