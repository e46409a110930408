/** Few convex cells around solids, meshes and hulls. */

import { Coarsened as Raw } from "../wasm/planecut_web.js";

import { flat, type Points } from "./arrays.js";
import { Cell } from "./cell.js";
import { encodeText, type EncodeOptions, type MeshFormat } from "./encoding.js";
import { guarded } from "./kernel.js";
import { Mesh } from "./mesh.js";
import { operandsOf, Solid } from "./solid.js";

/** How something is coarsened. */
export interface CoarsenOptions {
  /** Maximum number of cells. Without it and `maxExcess`, what can be merged without adding anything is. */
  maxCells?: number;
  /** Maximum volume added, relative to the solid's; then there are as few cells as can be found. */
  maxExcess?: number;
  /** Maximum number of vertices of each cell, at least 8. */
  maxVertices?: number;
  /** Maximum number of faces of each cell, at least 6. */
  maxFaces?: number;
  /** A solid, or several, into which no cell grows, as the openings of doors. */
  keepClear?: Solid | readonly Solid[];
  /** What a ball of this radius can reach from outside stays clear. */
  clearRadius?: number;
  /** Maximum distance between parts of one cell. */
  maxGap?: number;
  /** Thinner cells grow until they are not; the thickness of a shell. */
  minThickness?: number;
  /** How much volume that cells share counts, relative to volume that is added. */
  overlapWeight?: number;
  /** Whether parts of different materials stay apart. */
  byMaterial?: boolean;
  /** Cells within the solid instead of around it. */
  inner?: boolean;
  /** How a mesh is taken: "auto" as a solid where it bounds one, else as a "shell"; "filled" where it goes around more than half. */
  surface?: "auto" | "shell" | "filled";
  /** Caps that are not given are those of this engine (docs/engines.md). */
  engine?: "mujoco" | "physx" | "bullet" | "jolt" | "rapier" | "godot" | "unity" | "unreal";
}

/** Few convex cells, and what they add. */
export class Coarsened {
  /** @internal */
  readonly raw: Raw;
  /** The cells. They may overlap. The hull of the corners of each holds all that its planes bound. */
  readonly cells: readonly Cell[];
  /** The volume that the union of the cells adds, relative to that of the solid; negative for cells within it. */
  readonly excess: number;
  /** The same for the sum of the volumes of the cells: what overlaps counts more than once. */
  readonly sumExcess: number;
  /** Whether the cells hold all of the solid, proven by how they were made; false for cells within it. */
  readonly encloses: boolean;
  /** The volume of the solid. */
  readonly volumeIn: number;
  /** The volume of the union of the cells. */
  readonly volumeOut: number;
  /** What was enclosed: "filled" is what an open mesh goes around more than half, "shell" are triangles of some thickness. */
  readonly enclosed: "solid" | "filled" | "shell";
  /** The thickness of a shell, else null. */
  readonly thickness: number | null;
  /** Where a radius was to be kept clear: by how much less than it a ball keeps clear, else null. */
  readonly clearTolerance: number | null;
  /** How triangles were taken, where that may not be what was meant, else null. */
  readonly note: string | null;

  private constructor(raw: Raw) {
    this.raw = raw;
    this.cells = raw.cells().map((cell) => Cell.of(cell));
    [this.excess, this.sumExcess, this.encloses] = [raw.excess(), raw.sumExcess(), raw.encloses()];
    [this.volumeIn, this.volumeOut] = [raw.volumeIn(), raw.volumeOut()];
    this.enclosed = raw.enclosed() as "solid" | "filled" | "shell";
    this.thickness = raw.thickness() ?? null;
    this.clearTolerance = raw.clearTolerance() ?? null;
    this.note = raw.note() ?? null;
  }

  /** @internal */
  static of(raw: Raw): Coarsened {
    return new Coarsened(raw);
  }

  /** The union of the cells. */
  toSolid(): Solid {
    return guarded(() => Solid.of(this.raw.toSolid()));
  }

  /** The cells as a file of a format: each as a mesh of its own. */
  encode(format: MeshFormat, options: EncodeOptions = {}): Uint8Array {
    return guarded(() => this.raw.encode(format, encodeText(options)));
  }

  /** Gives the memory back at once, instead of when the garbage collector comes by. */
  free(): void {
    this.raw.free();
  }

  /** As {@link free}, for `using`. */
  [Symbol.dispose](): void {
    this.free();
  }
}

/**
 * Few convex cells that enclose a solid, with as little added as can be found: for colliders.
 *
 * @param subject - A solid; a mesh, closed or not; or a list of convex hulls that others made, each a cell or the coordinates of its corners.
 */
export function coarsen(subject: Solid | Mesh | readonly (Cell | Points)[], options: CoarsenOptions = {}): Coarsened {
  const { keepClear = [], ...rest } = options;
  const text = JSON.stringify(rest);
  return guarded(() => {
    const clear = operandsOf(keepClear instanceof Solid ? [keepClear] : keepClear, "keepClear");
    try {
      if (subject instanceof Solid) {
        return Coarsened.of(Raw.ofSolid(subject.raw, text, clear));
      }
      if (subject instanceof Mesh) {
        return Coarsened.of(Raw.ofMesh(subject.raw, text, clear));
      }
      const hulls = subject.map((hull, k) => (hull instanceof Cell ? hull.positions : flat(hull, 3, `hull ${k}`)));
      const all = new Float64Array(hulls.reduce((sum, hull) => sum + hull.length, 0));
      hulls.reduce((at, hull) => (all.set(hull, at), at + hull.length), 0);
      return Coarsened.of(Raw.ofHulls(all, Uint32Array.from(hulls, (hull) => hull.length / 3), text, clear));
    } finally {
      clear.free();
    }
  });
}
