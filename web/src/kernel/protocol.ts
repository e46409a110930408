/**
 * What the page and its worker say to each other.
 *
 * A request names a call of {@link Calls} and has a number, which its answer repeats. Arrays are handed over, not copied.
 */

/** Faces of the solid as a renderer takes them; see the class of the same name of the kernel. */
export interface FaceArrays {
  ids: Uint32Array;
  materials: Uint32Array;
  sources: Float64Array;
  counts: Uint32Array;
  positions: Float32Array;
  normals: Float32Array;
  triangles: Uint32Array;
  outlines: Uint32Array;
}

/** Meshes one after another. */
export interface PieceArrays {
  counts: Uint32Array;
  positions: Float32Array;
  triangles: Uint32Array;
  materials: Uint32Array;
}

/** A convex body, or an operation on such. */
export type Operand = { brush: number } | { node: number };

export type Role = "add" | "subtract" | "intersect";

export type Operation = "union" | "intersection" | "difference" | "xor" | "complement";

/** Four numbers of a half-space: all points with `a x + b y + c z <= d`. */
export type HalfSpace = [number, number, number, number];

/** An edit, as `planecut edit` reads it; the keys depend on `op`. */
export type Edit = { op: string } & Record<string, unknown>;

/** What an edit has done. */
export interface EditAnswer {
  ok: boolean;
  error?: string;
  brushes: number[];
  brush?: number;
  plane?: number;
  node?: number;
  copies?: number[];
  undo: number;
  redo: number;
  step: boolean;
}

/** What an edit has done, with the faces that it has changed. */
export interface Edited {
  answer: EditAnswer;
  removed: Uint32Array;
  added: FaceArrays;
  /** Milliseconds that the kernel took. */
  time: number;
}

/** A brush as it is listed. */
export interface BrushEntry {
  brush: number;
  name: string | null;
  material: string;
}

export interface TreeAnswer {
  parts: (Operand & { role: Role })[];
  nodes: { node: number; operation: Operation; parent: number | null; operands: Operand[] }[];
}

export interface Measures {
  volume: number;
  area: number;
  centroid: [number, number, number] | null;
  min: [number, number, number] | null;
  max: [number, number, number] | null;
  materials: { name: string; area: number; volume?: number }[];
  brushes: number;
  faces: number;
  triangles: number;
}

export interface MassProperties {
  mass: number;
  center: [number, number, number];
  /** xx, yy, zz, xy, xz and yz of the tensor about the center. */
  inertia: [number, number, number, number, number, number];
}

export interface BrushAnswer {
  brush: number;
  name: string | null;
  role: Role;
  parent: number | null;
  planes: { plane: number; half_space: HalfSpace; material: string }[];
}

export interface MaterialEntry {
  name: string;
  /** Linear red, green and blue. */
  color: [number, number, number];
}

export interface Hit {
  face: number;
  distance: number;
  point: [number, number, number];
  brush: number | null;
  plane: number | null;
}

export interface Warning {
  line: number;
  message: string;
  leftOut: number;
}

/** A model that was opened. */
export interface Opened {
  warnings: Warning[];
  center: [number, number, number];
  faces: FaceArrays;
  materials: MaterialEntry[];
  undo: number;
  redo: number;
  /** Milliseconds that reading and evaluating took. */
  time: number;
}

export interface Source {
  name: string;
  bytes: Uint8Array;
  parameters: Record<string, number>;
}

/** What a plane that is dragged may stick to; distances in units of the model, 0 for none. */
export interface Snapping {
  grid: number;
  planes: number;
  vertices: number;
}

export type Removal =
  | { gain: "nothing" | "unbounded" }
  | { gain: "piece"; volume: number; positions: [number, number, number][]; triangles: [number, number, number][] };

export interface CoarsenSettings {
  maxCells?: number;
  maxExcess?: number;
  maxVertices?: number;
  clearRadius?: number;
}

export interface ColliderArrays {
  pieces: PieceArrays;
  volume: number;
  excess: number;
}

/** The calls of the worker. */
export interface Calls {
  /** Reads a file, then does edits to it that were done before. */
  open(source: Source, edits: Edit[]): Opened;
  edit(edit: Edit): Edited;
  /** Moves a plane towards another place, to where it snaps. */
  drag(brush: number, plane: number, to: HalfSpace, snapping: Snapping): Edited & { to: HalfSpace; snapped: string | null };
  brush(brush: number): BrushAnswer;
  brushes(): BrushEntry[];
  tree(): TreeAnswer;
  measures(volumes: boolean): Measures;
  mass(density: number): MassProperties | null;
  materials(): MaterialEntry[];
  pick(origin: [number, number, number], direction: [number, number, number]): Hit | null;
  previewRemovePlane(brush: number, plane: number): Removal;
  encode(format: string): Uint8Array;
  cells(): PieceArrays;
  coarsen(settings: CoarsenSettings): ColliderArrays;
  /** Bytes of the kernel's memory. */
  memory(): number;
  /** For tests: fails as a bug in the kernel does. */
  fail(): never;
}

export type CallName = keyof Calls;

export interface Request {
  id: number;
  call: CallName;
  args: unknown[];
}

/** What went wrong, as it crosses threads. */
export interface Fault {
  message: string;
  line: number | null;
  jsonPath: string | null;
  /** Whether the worker cannot go on. */
  isFatal: boolean;
}

export type Response = { id: number; result: unknown } | { id: number; fault: Fault } | { ready: true } | { fault: Fault };
