/** Convex cells. */

import type { Cell as Raw } from "../wasm/planecut_web.js";

import { halfspaces } from "./shapes.js";
import type { Solid } from "./solid.js";

/** A bounded convex body: planes, and the corners and triangles of its boundary. */
export class Cell {
  /** Four numbers of each plane that carries a face: an outward normal, which need not have unit length, and the offset `d` of `n · x <= d`. */
  readonly planes: Float64Array;
  /** x, y and z of each corner, rounded to doubles. */
  readonly positions: Float64Array;
  /** Three numbers of corners of each triangle, counter-clockwise seen from outside. */
  readonly triangles: Uint32Array;
  /** The volume. */
  readonly volume: number;
  /** The name of what it is made of. */
  readonly material: string;

  private constructor(raw: Raw) {
    ({ planes: this.planes, positions: this.positions, triangles: this.triangles, volume: this.volume, material: this.material } = raw);
  }

  /** @internal */
  static of(raw: Raw): Cell {
    const cell = new Cell(raw);
    raw.free();
    return cell;
  }

  /** The body as a solid: of its planes, exactly. */
  toSolid(): Solid {
    return halfspaces(this.planes, { material: this.material });
  }
}
