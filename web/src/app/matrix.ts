/** Matrices as edits have them. */

import type { Matrix4 } from "three";

/** The rows of a matrix, without the last. */
export function rowsOf(matrix: Matrix4): number[][] {
  const all = matrix.clone().transpose().toArray();
  return [all.slice(0, 4), all.slice(4, 8), all.slice(8, 12)];
}
