/** Solids. */

import { Operands, Solid as Raw } from "../wasm/planecut_web.js";

import { axisVector, flat, type Axis, type Matrix, type Points, type Vector } from "./arrays.js";
import { Cell } from "./cell.js";
import { encodeText, type EncodeOptions, type Format } from "./encoding.js";
import { PlanecutError } from "./errors.js";
import { guarded } from "./kernel.js";
import { Mesh } from "./mesh.js";

/** What was repaired, left out or is doubtful in a file. */
export interface Warning {
  /** The line, counted from 1; 0 where there is none. */
  line: number;
  /** What was noticed. */
  message: string;
  /** How many bodies were left out. */
  leftOut: number;
}

/**
 * A solid: a set of points of space, made of convex bodies and closed meshes by set operations.
 *
 * Solids never change, and cost little until something is asked of them. The first question about the boundary (`volume`, `mesh()`, …) works it out, later ones know it.
 * Lengths are in your units; z is up, axes are right-handed, angles are in degrees.
 */
export class Solid {
  /** @internal */
  readonly raw: Raw;

  private constructor(raw: Raw) {
    this.raw = raw;
  }

  /** @internal */
  static of(raw: Raw): Solid {
    return new Solid(raw);
  }

  /** What lies in this solid or in any of others. */
  union(...others: readonly Solid[]): Solid {
    return combined("union", [this, ...others]);
  }

  /** What lies in this solid and in none of others. */
  subtract(...others: readonly Solid[]): Solid {
    return combined("difference", [this, ...others]);
  }

  /** What lies in this solid and in all others. */
  intersect(...others: readonly Solid[]): Solid {
    return combined("intersection", [this, ...others]);
  }

  /** What lies in one of both solids and not in the other. */
  xor(other: Solid): Solid {
    return combined("xor", [this, other]);
  }

  /** What does not lie in this solid: unbounded, where the solid is bounded. */
  complement(): Solid {
    return combined("complement", [this]);
  }

  /** The solid moved by a vector. */
  translate(offset: Vector): Solid {
    return guarded(() => new Solid(this.raw.translate(flat(offset, 3, "offset"))));
  }

  /**
   * The solid turned about an axis through the origin, counter-clockwise seen from the tip of the axis.
   *
   * @param axis - "x", "y", "z" or a vector.
   * @param degrees - The angle. Multiples of 90 are exact.
   */
  rotate(axis: Axis, degrees: number): Solid {
    return guarded(() => new Solid(this.raw.rotate(axisVector(axis), degrees)));
  }

  /** The solid scaled about the origin, by one factor or by one for each axis. */
  scale(factors: number | Vector): Solid {
    const all = typeof factors === "number" ? [factors, factors, factors] : factors;
    return guarded(() => new Solid(this.raw.scale(flat(all, 3, "factors"))));
  }

  /** The solid mirrored in the plane through the origin with a normal. */
  mirror(normal: Vector): Solid {
    return guarded(() => new Solid(this.raw.mirror(flat(normal, 3, "normal"))));
  }

  /** The solid moved by an affine map: three rows of four numbers, or four of which the last is 0, 0, 0, 1. */
  transform(matrix: Matrix): Solid {
    return guarded(() => new Solid(this.raw.transform(flat(matrix, 4, "matrix"))));
  }

  /**
   * The same solid, all of one material.
   *
   * @param name - Its name.
   * @param color - Linear red, green and blue from 0 to 1; without it files have a colour that depends on the name.
   */
  withMaterial(name: string, color?: Vector): Solid {
    return guarded(() => new Solid(this.raw.withMaterial(name, color && flat(color, 3, "color"))));
  }

  /**
   * The same solid as one body: its boundary as a closed mesh, its vertices rounded to doubles. What is made of it later takes no account of how it was made: worth it for pieces that are used
   * again and again.
   */
  asOneBody(): Solid {
    return guarded(() => new Solid(this.raw.asOneBody()));
  }

  /** The connected parts of the solid, each of disjoint convex bodies. Parts that touch along an edge or in a corner are apart. */
  components(): Solid[] {
    return guarded(() => this.raw.components().map((part) => new Solid(part)));
  }

  /** The volume. A `PlanecutError` for a solid that is unbounded, as of all that is asked of the boundary. */
  get volume(): number {
    return guarded(() => this.raw.volume());
  }

  /** The area of the boundary. */
  get area(): number {
    return guarded(() => this.raw.area());
  }

  /** The center of mass of a solid of the same density everywhere; NaN where the solid is empty. */
  get centroid(): Float64Array {
    return guarded(() => this.raw.centroid());
  }

  /** The least x, y and z, and then the greatest; NaN where the solid is empty. */
  get bounds(): Float64Array {
    return guarded(() => this.raw.bounds());
  }

  /** Whether there is nothing inside. */
  get isEmpty(): boolean {
    return guarded(() => this.raw.isEmpty());
  }

  /** How many convex bodies and closed meshes it is made of, each as often as it is used. */
  get bodyCount(): number {
    return guarded(() => this.raw.bodyCount());
  }

  /** What was repaired, left out or is doubtful in the file that the solid was read from. */
  get warnings(): Warning[] {
    return guarded(() => JSON.parse(this.raw.warnings()) as Warning[]);
  }

  /**
   * For each point whether the solid holds it; its boundary belongs to it. Exact for convex bodies; for closed meshes, points on the boundary may count either way.
   *
   * @param points - Rows of x, y and z, or all numbers one after another.
   */
  contains(points: Points): boolean[] {
    return guarded(() => Array.from(this.raw.contains(flat(points, 3, "points")), (held) => held === 1));
  }

  /**
   * For each ray the distance from its origin to where it first meets the boundary, from either side; infinite where it does not.
   *
   * @param origins - Rows of x, y and z, or all numbers one after another.
   * @param directions - The same, or one direction for all; of any length but 0.
   */
  rayCast(origins: Points, directions: Points): Float64Array {
    return guarded(() => this.raw.rayCast(flat(origins, 3, "origins"), flat(directions, 3, "directions")));
  }

  /** The boundary as a watertight mesh. */
  mesh(): Mesh {
    return guarded(() => Mesh.of(this.raw.mesh()));
  }

  /** The solid as disjoint convex cells, the union of which it is. */
  cells(): Cell[] {
    return guarded(() => this.raw.cells().map((cell) => Cell.of(cell)));
  }

  /** The boundary as a file of a format, or for `map` and `csg` the convex bodies. */
  encode(format: Format, options: EncodeOptions = {}): Uint8Array {
    return guarded(() => this.raw.encode(format, encodeText(options)));
  }

  /** Gives the memory back at once, instead of when the garbage collector comes by. Solids that were made of this one stay. */
  free(): void {
    this.raw.free();
  }

  /** As {@link free}, for `using`. */
  [Symbol.dispose](): void {
    this.free();
  }
}

/**
 * Solids as the kernel takes several.
 *
 * @internal
 */
export function operandsOf(solids: Iterable<Solid>, name: string): Operands {
  const operands = new Operands();
  for (const solid of solids) {
    if (!(solid instanceof Solid)) {
      operands.free();
      throw new PlanecutError(`${name}: found a value of type ${typeof solid}, expected solids`);
    }
    operands.push(solid.raw);
  }
  return operands;
}

/**
 * Solids combined by an operation.
 *
 * @internal
 */
export function combined(operation: string, solids: Iterable<Solid>): Solid {
  return guarded(() => {
    const operands = operandsOf(solids, "solids");
    try {
      return Solid.of(operands.combine(operation));
    } finally {
      operands.free();
    }
  });
}
