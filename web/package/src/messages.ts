/** The calls of an edit as the messages that the kernel reads. */

import { finite, rowsOfFour, type Matrix, type Planes } from "./arrays.js";
import { PlanecutError } from "./errors.js";
import { Node, operandOf, type Operand, type Operation, type Role } from "./tree.js";

/** An edit as the kernel reads it. */
export type Message = Record<string, unknown>;

/** The calls as messages, for edits and for previews. */
export const messages = {
  movePlane: (brush: number, plane: number, offset: number): Message => ({ op: "move_plane", brush: finite(brush, "brush"), plane: finite(plane, "plane"), offset: finite(offset, "offset") }),
  turnPlane: (brush: number, plane: number, to: Planes): Message => ({ op: "move_plane", brush: finite(brush, "brush"), plane: finite(plane, "plane"), to: one(to, "to") }),
  setMaterial: (brush: number, material: string, plane?: number): Message => ({ op: "set_material", brush: finite(brush, "brush"), material, plane }),
  renameBrush: (brush: number, name: string | null): Message => ({ op: "rename_brush", brush: finite(brush, "brush"), name: name ?? undefined }),
  copyBrushes: (brushes: ArrayLike<number>, matrix: Matrix): Message => ({ op: "copy_brushes", brushes: list(brushes), matrix: rowsOfFour(matrix, "matrix") }),
  mirrorBrushes: (brushes: ArrayLike<number>, plane: Planes): Message => ({ op: "mirror_brushes", brushes: list(brushes), plane: one(plane, "plane") }),
  arrayBrushes: (brushes: ArrayLike<number>, matrix: Matrix, count: number): Message => ({ op: "array_brushes", brushes: list(brushes), matrix: rowsOfFour(matrix, "matrix"), count: finite(count, "count") }),
  addPlane: (brush: number, plane: Planes, material?: string): Message => ({ op: "add_plane", brush: finite(brush, "brush"), plane: one(plane, "plane"), material }),
  removePlane: (brush: number, plane: number): Message => ({ op: "remove_plane", brush: finite(brush, "brush"), plane: finite(plane, "plane") }),
  removeBrush: (brush: number): Message => ({ op: "remove_brush", brush: finite(brush, "brush") }),
  transformBrush: (brush: number, matrix: Matrix): Message => ({ op: "transform_brush", brush: finite(brush, "brush"), matrix: rowsOfFour(matrix, "matrix") }),
  setRole: (operand: Operand, role: Role): Message => ({ op: "set_role", ...operandOf(operand, "operand"), role }),
  setOperation: (node: Node, operation: Operation): Message => ({ op: "set_operation", node: nodeOf(node, "node"), operation }),
  wrap: (operands: readonly Operand[], operation: Operation): Message => ({ op: "wrap", operands: operands.map((operand) => operandOf(operand, "operands")), operation }),
  dissolve: (node: Node): Message => ({ op: "dissolve", node: nodeOf(node, "node") }),
  moveOperand: (operand: Operand, { to, before }: Place = {}): Message => ({
    op: "move_operand",
    operand: operandOf(operand, "operand"),
    to: to && nodeOf(to, "to"),
    before: before === undefined || before === null ? undefined : operandOf(before, "before"),
  }),
  moveBrushBefore: (brush: number, before?: number | null): Message => ({ op: "move_brush_before", brush: finite(brush, "brush"), before: before ?? undefined }),
  removeNode: (node: Node): Message => ({ op: "remove_node", node: nodeOf(node, "node") }),
};

/** Where an operand goes. */
export interface Place {
  /** The operation that it is to be an operand of; without it, it becomes a part of the model itself. */
  to?: Node | null;
  /** The operand there before which it goes; without it, it becomes the last one. */
  before?: Operand | null;
}

function one(plane: Planes, name: string): number[] {
  const rows = rowsOfFour(plane, name);
  if (rows.length !== 1 || rows[0]!.length !== 4) {
    throw new PlanecutError(`${name}: found ${rows.flat().length} numbers, expected a normal and an offset`);
  }
  return rows[0]!;
}

function list(brushes: ArrayLike<number>): number[] {
  return Array.from(brushes, (brush) => finite(brush, "brushes"));
}

function nodeOf(node: unknown, name: string): number {
  if (!(node instanceof Node)) {
    throw new PlanecutError(`${name}: found ${String(node)}, expected a Node`);
  }
  return node.number;
}
