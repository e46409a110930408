/** The calls of an edit. */

import type { Live as Raw, Made } from "../wasm/planecut_web.js";

import type { Matrix, Planes } from "./arrays.js";
import { PlanecutError } from "./errors.js";
import { guarded } from "./kernel.js";
import { messages, type Message, type Place } from "./messages.js";
import type { Solid } from "./solid.js";
import { Node, type Operand, type Operation, type Role } from "./tree.js";

/** The calls of one edit; see {@link Live.edit}. What is refused throws a `PlanecutError`. */
export class Edit {
  readonly #raw: Raw;
  #isOver = false;

  /** @internal */
  constructor(raw: Raw) {
    this.#raw = raw;
  }

  /** @internal */
  close(): void {
    this.#isOver = true;
  }

  /** Moves a plane of a brush along its normal, to an offset for the normal as it was given. */
  movePlane(brush: number, plane: number, offset: number): void {
    this.apply(messages.movePlane(brush, plane, offset));
  }

  /** Puts another half-space, outward normal and offset, in the place of a plane of a brush; the plane keeps its number. */
  turnPlane(brush: number, plane: number, to: Planes): void {
    this.apply(messages.turnPlane(brush, plane, to));
  }

  /** Gives a brush another material, by its name; all of it, or one of its planes. */
  setMaterial(brush: number, material: string, plane?: number): void {
    this.apply(messages.setMaterial(brush, material, plane));
  }

  /** Gives a brush another name; null takes its name away. */
  renameBrush(brush: number, name: string | null): void {
    this.apply(messages.renameBrush(brush, name));
  }

  /** Copies brushes to where an affine map takes them; each copy comes directly behind its original. Returns the numbers of the copies. */
  copyBrushes(brushes: ArrayLike<number>, matrix: Matrix): number[] {
    return this.apply(messages.copyBrushes(brushes, matrix)).copies;
  }

  /** The same by the mirror image in a plane, normal and offset. */
  mirrorBrushes(brushes: ArrayLike<number>, plane: Planes): number[] {
    return this.apply(messages.mirrorBrushes(brushes, plane)).copies;
  }

  /** Copies brushes several times, each copy moved on by an affine map from the one before it. Returns the numbers of the first copies of all, then of the second ones, and so on. */
  arrayBrushes(brushes: ArrayLike<number>, matrix: Matrix, count: number): number[] {
    return this.apply(messages.arrayBrushes(brushes, matrix, count)).copies;
  }

  /** Cuts a brush down to a half-space, outward normal and offset. Returns the number of the plane in the brush. */
  addPlane(brush: number, plane: Planes, material?: string): number {
    return this.apply(messages.addPlane(brush, plane, material)).plane!;
  }

  /** Takes a plane out of a brush, which grows to what its other planes leave. */
  removePlane(brush: number, plane: number): void {
    this.apply(messages.removePlane(brush, plane));
  }

  /** Adds a solid of one convex body or closed mesh as a brush after all others. Returns its number. */
  addBrush(solid: Solid, role: Role = "add"): number {
    return this.done(() => this.#raw.addBrush(solid.raw, role)).brush!;
  }

  /** Takes a brush out. */
  removeBrush(brush: number): void {
    this.apply(messages.removeBrush(brush));
  }

  /** Puts a solid of one convex body or closed mesh in the place of a brush; its planes get new numbers. */
  replaceBrush(brush: number, solid: Solid): void {
    this.done(() => this.#raw.replaceBrush(brush, solid.raw));
  }

  /** Moves a brush by an affine map; its planes keep their numbers. */
  transformBrush(brush: number, matrix: Matrix): void {
    this.apply(messages.transformBrush(brush, matrix));
  }

  /** Gives a brush or an operation another role. Only parts of the model itself have one, not the operands of an operation. */
  setRole(operand: Operand, role: Role): void {
    this.apply(messages.setRole(operand, role));
  }

  /** Makes another operation of an operation, on the same operands. */
  setOperation(node: Node, operation: Operation): void {
    this.apply(messages.setOperation(node, operation));
  }

  /**
   * Makes operands of one operation, or parts of the model, those of a new operation, in the order in which they are there; it takes the place, and the role, of the first of them. Returns the new
   * operation.
   */
  wrap(operands: readonly Operand[], operation: Operation): Node {
    return new Node(this.apply(messages.wrap(operands, operation)).node!);
  }

  /** Puts the operands of an operation in its place. */
  dissolve(node: Node): void {
    this.apply(messages.dissolve(node));
  }

  /** Moves a brush or an operation, with all below it, to another place in the tree. What it leaves closes up: the second operand of a difference may become the first. */
  moveOperand(operand: Operand, place: Place = {}): void {
    this.apply(messages.moveOperand(operand, place));
  }

  /** Moves a brush before another one, to where that one is in the tree; without another it becomes the last one where it is. */
  moveBrushBefore(brush: number, before?: number | null): void {
    this.apply(messages.moveBrushBefore(brush, before));
  }

  /** Takes an operation out with all brushes and operations below it. */
  removeNode(node: Node): void {
    this.apply(messages.removeNode(node));
  }

  private apply(message: Message) {
    return this.done(() => this.#raw.apply(JSON.stringify(message)));
  }

  /** What a call has made, as values of JavaScript alone. */
  private done(work: () => Made): { brush: number | undefined; plane: number | undefined; node: number | undefined; copies: number[] } {
    if (this.#isOver) {
      throw new PlanecutError("found an edit that is over, expected calls within the function given to edit");
    }
    return guarded(() => {
      const made = work();
      const { brush, plane, node, copies } = made;
      made.free();
      return { brush, plane, node, copies: Array.from(copies) };
    });
  }
}
