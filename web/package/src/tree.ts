/** The tree of a live model. */

import { PlanecutError } from "./errors.js";

/** What a part of a model does to what is there before it. */
export type Role = "add" | "subtract" | "intersect";

/** An operation on operands: "difference" takes the others from the first, "complement" is that of the union. */
export type Operation = "union" | "intersection" | "difference" | "xor" | "complement";

/** An operation in the tree of a live model, by its number: a name and nothing more. Brushes are named by numbers alone. */
export class Node {
  /** The number of the operation; none is given twice. */
  readonly number: number;

  /** The operation of a number. */
  constructor(number: number) {
    this.number = number;
  }

  /** How messages name it. */
  toString(): string {
    return `Node(${this.number})`;
  }
}

/** A brush by its number, or an operation. */
export type Operand = number | Node;

/** A brush in the tree. */
export interface BrushPart {
  /** Its number. */
  brush: number;
  /** What it does, where it is a part of the model itself. */
  role?: Role;
}

/** An operation in the tree. */
export interface OperationPart {
  /** What names it. */
  node: Node;
  /** What it does with its operands. */
  operation: Operation;
  /** Its operands, in their order. */
  operands: Part[];
  /** What it does, where it is a part of the model itself. */
  role?: Role;
}

/** A brush or an operation in the tree. */
export type Part = BrushPart | OperationPart;

/** @internal */
export type RawPart = { brush?: number; node?: number; role?: Role };

/** @internal */
export type RawNode = { node: number; operation: Operation; operands: RawPart[] };

/**
 * The parts of a model, with all below them.
 *
 * @internal
 */
export function partsOf(parts: readonly RawPart[], nodes: readonly RawNode[]): Part[] {
  const all = new Map(nodes.map((node) => [node.node, node]));
  const top: Part[] = [];
  // trees may be deeper than calls
  const waiting: [readonly RawPart[], Part[]][] = [[parts, top]];
  for (let next = waiting.pop(); next; next = waiting.pop()) {
    const [from, to] = next;
    for (const { brush, node, role } of from) {
      const own = role === undefined ? {} : { role };
      if (brush !== undefined) {
        to.push({ brush, ...own });
        continue;
      }
      const { operation, operands } = all.get(node!)!;
      const part: OperationPart = { node: new Node(node!), operation, operands: [], ...own };
      to.push(part);
      waiting.push([operands, part.operands]);
    }
  }
  return top;
}

/**
 * An operand as messages name it.
 *
 * @internal
 */
export function operandOf(operand: Operand, name: string): RawPart {
  if (operand instanceof Node) {
    return { node: operand.number };
  }
  if (!Number.isInteger(operand) || operand < 0) {
    throw new PlanecutError(`${name}: found ${String(operand)}, expected the number of a brush or a Node`);
  }
  return { brush: operand };
}
