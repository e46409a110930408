/** The kernel in a thread of its own: answers the calls of {@link Calls} one after another. */

import { Editor, init, memoryBytes, simulateBug } from "planecut/editor";

import type { Calls, CallName, Edit, EditAnswer, Fault, FaceArrays, MaterialEntry, PieceArrays, Request, Response } from "./protocol";

let editor: Editor | null = null;

function opened(): Editor {
  if (!editor) {
    throw new Error("found no model, expected one that is open");
  }
  return editor;
}

/** The answer to a message, which throws where it is refused. */
function ask<T>(message: Record<string, unknown>): T {
  const answer = JSON.parse(opened().answer(JSON.stringify(message))) as { ok: boolean; error?: string };
  if (!answer.ok) {
    throw new Error(answer.error);
  }
  return answer as T;
}

/** The arrays of an object of the kernel, which is freed. */
function arraysOf(faces: FaceArrays & { free(): void }): FaceArrays {
  const { ids, materials, sources, counts, positions, normals, triangles, outlines } = faces;
  faces.free();
  return { ids, materials, sources, counts, positions, normals, triangles, outlines };
}

function piecesOf(pieces: PieceArrays & { free(): void }): PieceArrays {
  const { counts, positions, triangles, materials } = pieces;
  pieces.free();
  return { counts, positions, triangles, materials };
}

function edit(message: Edit) {
  const begin = performance.now();
  const edited = opened().edit(JSON.stringify(message));
  const time = performance.now() - begin;
  const answer = JSON.parse(edited.answer) as EditAnswer;
  const { removed, added } = edited;
  const arrays = arraysOf(added);
  edited.free();
  if (!answer.ok) {
    throw new Error(answer.error);
  }
  return { answer, removed, added: arrays, time };
}

function materials(): MaterialEntry[] {
  const colors = opened().colors();
  const { materials } = ask<{ materials: { name: string }[] }>({ query: "materials" });
  return materials.map(({ name }, k) => ({ name, color: [colors[3 * k]!, colors[3 * k + 1]!, colors[3 * k + 2]!] }));
}

const calls: Calls = {
  open({ name, bytes, parameters }, edits) {
    const begin = performance.now();
    const next = new Editor(bytes, name, JSON.stringify(parameters));
    // the model before stays until there is another
    editor?.free();
    editor = next;
    let history = { undo: 0, redo: 0 };
    for (const message of edits) {
      history = ask<EditAnswer>(message);
    }
    const [x, y, z] = next.center();
    const time = performance.now() - begin;
    return {
      warnings: JSON.parse(next.warnings()),
      center: [x!, y!, z!],
      faces: arraysOf(next.faces()),
      materials: materials(),
      undo: history.undo,
      redo: history.redo,
      time,
    };
  },
  edit,
  drag(brush, plane, to, { grid, planes, vertices }) {
    const begin = performance.now();
    const query: Record<string, unknown> = { query: "snap", brush, plane, to };
    Object.entries({ grid, planes, vertices }).forEach(([key, value]) => value > 0 && (query[key] = value));
    const { snap } = ask<{ snap: { to: typeof to; target: Record<string, unknown> } | null }>(query);
    const target = snap ? snap.to : to;
    const edited = edit({ op: "move_plane", brush, plane, to: target });
    const snapped = snap ? (Object.keys(snap.target).find((key) => key !== "plane") ?? null) : null;
    return { ...edited, to: target, snapped: snapped === "brush" ? "plane" : snapped, time: performance.now() - begin };
  },
  brush: (brush) => ask({ query: "brush", brush }),
  brushes: () => JSON.parse(opened().brushes()),
  tree: () => ask({ query: "tree" }),
  measures: (volumes) => ask({ query: "measures", volumes }),
  mass: (density) => JSON.parse(opened().mass(density)),
  materials,
  pick: (origin, direction) => ask<{ hit: ReturnType<Calls["pick"]> }>({ query: "pick", origin, direction }).hit,
  previewRemovePlane: (brush, plane) => ask({ query: "preview_remove_plane", brush, plane }),
  encode: (format) => opened().encode(format, "{}"),
  cells: () => piecesOf(opened().cells()),
  coarsen(settings) {
    const colliders = opened().coarsen(JSON.stringify(settings));
    const { pieces, volume, excess } = colliders;
    const arrays = piecesOf(pieces);
    colliders.free();
    return { pieces: arrays, volume, excess };
  },
  memory: () => memoryBytes(),
  fail: () => simulateBug() as never,
};

/** The buffers of typed arrays within a value, which are handed over. */
function buffersOf(value: unknown, found: ArrayBuffer[] = []): ArrayBuffer[] {
  if (ArrayBuffer.isView(value)) {
    found.push(value.buffer as ArrayBuffer);
  } else if (value && typeof value === "object") {
    Object.values(value).forEach((part) => buffersOf(part, found));
  }
  return found;
}

function faultOf(error: unknown): Fault {
  const { message, line, jsonPath } = error as { message?: string; line?: number | null; jsonPath?: string | null };
  // what the kernel refuses is an error of its own; anything that WebAssembly itself throws leaves it in no known state
  const isFatal = error instanceof WebAssembly.RuntimeError || error instanceof RangeError;
  return { message: message ?? String(error), line: line ?? null, jsonPath: jsonPath ?? null, isFatal };
}

function post(response: Response, transfer: ArrayBuffer[] = []) {
  postMessage(response, { transfer });
}

addEventListener("message", ({ data }: MessageEvent<Request>) => {
  const { id, call, args } = data;
  try {
    const result = (calls[call as CallName] as (...args: unknown[]) => unknown)(...args);
    post({ id, result }, buffersOf(result));
  } catch (error) {
    post({ id, fault: faultOf(error) });
  }
});

init().then(
  () => post({ ready: true }),
  (error: unknown) => post({ fault: { ...faultOf(error), isFatal: true } }),
);
