/**
 * planecut: exact convex-CSG modeling. Call {@link init} once, and wait for it; nothing else works before.
 *
 * @packageDocumentation
 */

export type { Axis, Matrix, Outline, Planes, Points, Vector } from "./arrays.js";
export { Cell } from "./cell.js";
export { coarsen, Coarsened, type CoarsenOptions } from "./coarsen.js";
export { Edit } from "./edit.js";
export type { EncodeOptions, Format, MeshFormat } from "./encoding.js";
export { InternalError, PlanecutError } from "./errors.js";
export { init, memoryBytes, type KernelSource } from "./kernel.js";
export { Live, type Change, type Snap, type SnapOptions } from "./live.js";
export { Buffers, Face, Gain } from "./live-faces.js";
export { Mesh, type MeshMaterials } from "./mesh.js";
export type { Place } from "./messages.js";
export { Previewer, type Preview } from "./preview.js";
export {
  box,
  capsule,
  cone,
  cube,
  cylinder,
  difference,
  extrude,
  fromMesh,
  halfspaces,
  hull,
  intersection,
  load,
  minkowski,
  prism,
  revolve,
  sphere,
  torus,
  union,
  type ExtrudeOptions,
  type LoadOptions,
  type RoundOptions,
  type ShapeOptions,
  type TakingOptions,
} from "./shapes.js";
export { Solid, type Warning } from "./solid.js";
export { Node, type BrushPart, type Operand, type Operation, type OperationPart, type Part, type Role } from "./tree.js";
export { version } from "../wasm/planecut_web.js";
