/** What comes in: numbers as arrays of any kind, flat or in rows. */

import { PlanecutError } from "./errors.js";

/** Three numbers: x, y and z. */
export type Vector = ArrayLike<number>;

/** Points: rows of x, y and z, or all numbers one after another. */
export type Points = ArrayLike<number> | ArrayLike<ArrayLike<number>>;

/** Half-spaces `n · x <= d`: rows of the outward normal and the offset, or all numbers one after another. */
export type Planes = ArrayLike<number> | ArrayLike<ArrayLike<number>>;

/** An affine map: three or four rows of four numbers, or all of them one after another, row by row. */
export type Matrix = ArrayLike<number> | ArrayLike<ArrayLike<number>>;

/** A loop of points of a plane, or several: those in others are holes. */
export type Outline = ArrayLike<ArrayLike<number>> | ArrayLike<ArrayLike<ArrayLike<number>>>;

/** An axis by its name, or a vector of any length but 0. */
export type Axis = "x" | "y" | "z" | Vector;

type Nested = ArrayLike<number> | ArrayLike<ArrayLike<number>>;

function isFlat(values: Nested): values is ArrayLike<number> {
  return values.length === 0 || typeof values[0] === "number";
}

function refuse(name: string, found: unknown, expected: string): never {
  throw new PlanecutError(`${name}: found ${found}, expected ${expected}`);
}

/**
 * All numbers one after another.
 *
 * @internal
 */
export function flat(values: Nested, width: number, name: string): Float64Array {
  if (values === null || typeof values !== "object" || typeof values.length !== "number") {
    refuse(name, values === null ? "null" : `a value of type ${typeof values}`, "an array of numbers");
  }
  if (values instanceof Float64Array) {
    return values;
  }
  if (isFlat(values)) {
    return Float64Array.from(values);
  }
  const all = new Float64Array(width * values.length);
  for (let row = 0; row < values.length; row += 1) {
    const numbers = values[row]!;
    if (numbers.length !== width) {
      refuse(`${name}[${row}]`, `${numbers.length} numbers`, `${width}`);
    }
    all.set(numbers, width * row);
  }
  return all;
}

/**
 * Numbers that count, one after another.
 *
 * @internal
 */
export function counts(values: Nested, width: number, name: string): Uint32Array {
  if (values instanceof Uint32Array) {
    return values;
  }
  const all = flat(values, width, name);
  const wrong = all.findIndex((value) => !Number.isInteger(value) || value < 0 || value > 0xffffffff);
  return wrong < 0 ? Uint32Array.from(all) : refuse(name, all[wrong], "numbers that count, from 0");
}

/**
 * The coordinates of all corners of loops, and how many corners each loop has.
 *
 * @internal
 */
export function loops(outline: Outline): [Float64Array, Uint32Array] {
  const isOne = outline.length > 0 && typeof outline[0]?.[0] === "number";
  const all = isOne ? [outline as ArrayLike<ArrayLike<number>>] : Array.from(outline as ArrayLike<ArrayLike<ArrayLike<number>>>);
  const parts = all.map((corners, k) => flat(corners, 2, isOne ? "outline" : `outline[${k}]`));
  const joined = new Float64Array(parts.reduce((sum, part) => sum + part.length, 0));
  let at = 0;
  for (const part of parts) {
    joined.set(part, at);
    at += part.length;
  }
  return [joined, Uint32Array.from(parts, (part) => part.length / 2)];
}

/**
 * An axis as a vector.
 *
 * @internal
 */
export function axisVector(axis: Axis): Float64Array {
  if (typeof axis !== "string") {
    return flat(axis, 3, "axis");
  }
  const place = ["x", "y", "z"].indexOf(axis);
  return place < 0 ? refuse("axis", JSON.stringify(axis), '"x", "y", "z" or a vector') : Float64Array.from([0, 1, 2], (k) => (k === place ? 1 : 0));
}

/**
 * A number that counts, for a parameter of 32 bits.
 *
 * @internal
 */
export function count(value: number, name: string): number {
  return Number.isInteger(value) && value >= 0 && value <= 0xffffffff ? value : refuse(name, value, "a number that counts");
}

/**
 * A number that is finite, for a message in which no other can be said.
 *
 * @internal
 */
export function finite(value: number, name: string): number {
  return Number.isFinite(value) ? value : refuse(name, value, "a finite number");
}

/**
 * Rows of four numbers.
 *
 * @internal
 */
export function rowsOfFour(values: Nested, name: string): number[][] {
  const all = flat(values, 4, name);
  all.forEach((value) => finite(value, name));
  return Array.from({ length: Math.ceil(all.length / 4) }, (_, row) => Array.from(all.subarray(4 * row, 4 * row + 4)));
}
