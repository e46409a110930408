/** The model that is open: what was read, what was done to it, and what the page knows of it. */

import { Vector3 } from "three";

import { Kernel, KernelError } from "../kernel/client";
import type { BrushAnswer, BrushEntry, Edit, EditAnswer, Edited, HalfSpace, Hit, MaterialEntry, Measures, Opened, Snapping, TreeAnswer, Warning } from "../kernel/protocol";
import { FaceStore } from "../view/faces";
import type { ModelFile } from "./files";

/** What is chosen: a brush, and one of its planes where a face is. */
export interface Selection {
  brush: number;
  plane: number | null;
  /** The face that was clicked, while it is there. */
  face: number | null;
}

/** What listeners are told of. */
export interface Events {
  /** Another model is open. */
  opened: Opened;
  /** The model has changed; whether a step is open that may go on. */
  changed: { step: boolean };
  /** Names, materials, order or number of brushes have changed. */
  listed: null;
  selected: Selection | null;
  measured: Measures;
  /** Something to be said to the user. */
  said: { text: string; kind: "note" | "error"; line?: number | null };
}

type Listeners = { [Name in keyof Events]: ((event: Events[Name]) => void)[] };

/** How often measures are asked for while something is dragged, in milliseconds. */
const MEASURE_INTERVAL = 120;

/** Milliseconds that edits took: in the kernel, on their way, and to write them into the buffers. */
export interface EditTimes {
  kernel: number[];
  transfer: number[];
  upload: number[];
}

/** An open model. */
export class Document {
  readonly kernel = new Kernel();
  faces = new FaceStore();
  source: ModelFile | null = null;
  center: [number, number, number] = [0, 0, 0];
  materials: MaterialEntry[] = [];
  tree: TreeAnswer = { parts: [], nodes: [] };
  brushes = new Map<number, BrushEntry>();
  measures: Measures | null = null;
  warnings: Warning[] = [];
  selection: Selection | null = null;
  history = { undo: 0, redo: 0 };
  readonly times: EditTimes = { kernel: [], transfer: [], upload: [] };

  private readonly listeners: Listeners = { opened: [], changed: [], listed: [], selected: [], measured: [], said: [] };
  /** All edits since the file was read, as they can be done again. */
  private log: Edit[] = [];
  private measuredAt = 0;
  private measureTimer: ReturnType<typeof setTimeout> | null = null;
  private listTimer: ReturnType<typeof setTimeout> | null = null;

  constructor() {
    this.kernel.onRestart = (reason) => void this.recover(reason);
  }

  on<Name extends keyof Events>(name: Name, listener: (event: Events[Name]) => void) {
    (this.listeners[name] as ((event: Events[Name]) => void)[]).push(listener);
  }

  say(text: string, kind: "note" | "error" = "note", line: number | null = null) {
    this.emit("said", { text, kind, line });
  }

  /** The edits that were done, in a form that can be done again. */
  get edits(): readonly Edit[] {
    return this.log;
  }

  /** Opens a file, and does edits to it; what was open before stays where that fails. */
  async open(source: ModelFile, edits: readonly Edit[] = []): Promise<void> {
    const opened = await this.kernel.call("open", source, [...edits]);
    this.source = source;
    this.log = [...edits];
    this.warnings = opened.warnings;
    this.take(opened);
    this.select(null);
    this.emit("opened", opened);
    await this.refresh();
  }

  /** A place relative to the center, as everything in the picture is. */
  placed([x, y, z]: [number, number, number]): Vector3 {
    const { center } = this;
    return new Vector3(x - center[0], y - center[1], z - center[2]);
  }

  /** Does an edit. */
  async edit(edit: Edit): Promise<EditAnswer> {
    const begin = performance.now();
    const edited = await this.kernel.call("edit", edit);
    return this.apply(edit, edited, begin);
  }

  /** The same as part of an open step, for a plane that is dragged; tells where it went. */
  async drag(brush: number, plane: number, to: HalfSpace, snapping: Snapping): Promise<{ to: HalfSpace; snapped: string | null }> {
    const begin = performance.now();
    const edited = await this.kernel.call("drag", brush, plane, to, snapping);
    this.apply({ op: "move_plane", brush, plane, to: edited.to }, edited, begin);
    return edited;
  }

  /** Does edits as one step; none where one is refused. */
  async step(edits: Edit[]): Promise<EditAnswer | null> {
    let answer: EditAnswer | null = null;
    await this.edit({ op: "begin" });
    try {
      for (const edit of edits) {
        answer = await this.edit(edit);
      }
    } catch (error) {
      await this.edit({ op: "cancel" });
      throw error;
    }
    await this.edit({ op: "commit" });
    return answer;
  }

  /** Does an edit that a button asks for; says what is wrong where it is refused. */
  async attempt(work: () => Promise<unknown>): Promise<boolean> {
    try {
      await work();
      return true;
    } catch (error) {
      this.fail(error);
      return false;
    }
  }

  fail(error: unknown) {
    if (error instanceof KernelError && error.isFatal) {
      // the restart says it
      return;
    }
    this.say(error instanceof Error ? error.message : String(error), "error", error instanceof KernelError ? error.line : null);
  }

  select(selection: Selection | null) {
    this.selection = selection;
    this.emit("selected", selection);
  }

  async pick(origin: [number, number, number], direction: [number, number, number]): Promise<Hit | null> {
    return this.kernel.call("pick", origin, direction);
  }

  async brush(brush: number): Promise<BrushAnswer> {
    return this.kernel.call("brush", brush);
  }

  /** A plane of a brush; nothing where the brush has none of this number. */
  async halfSpace(brush: number, plane: number): Promise<HalfSpace | null> {
    const { planes } = await this.brush(brush);
    return planes.find((entry) => entry.plane === plane)?.half_space ?? null;
  }

  /** Asks for what lists and panels show. */
  async refresh() {
    const [brushes, tree, materials] = await Promise.all([this.kernel.call("brushes"), this.kernel.call("tree"), this.kernel.call("materials")]);
    this.brushes = new Map(brushes.map((entry) => [entry.brush, entry]));
    this.tree = tree;
    this.setMaterials(materials);
    this.emit("listed", null);
    await this.measure();
  }

  private take(opened: Opened) {
    this.faces.dispose();
    this.center = opened.center;
    this.faces = new FaceStore(Math.max(1024, Math.ceil(opened.faces.positions.length / 3 / 0.8)));
    this.setMaterials(opened.materials);
    this.faces.change([], opened.faces);
    this.history = { undo: opened.undo, redo: opened.redo };
  }

  private setMaterials(materials: MaterialEntry[]) {
    this.materials = materials;
    this.faces.setMaterials(materials);
  }

  private apply(edit: Edit, { answer, removed, added, time }: Edited, begin: number): EditAnswer {
    const arrived = performance.now();
    const newest = added.materials.reduce((most, material) => Math.max(most, material), -1);
    this.faces.change(removed, added);
    note(this.times.kernel, time);
    note(this.times.transfer, arrived - begin - time);
    note(this.times.upload, performance.now() - arrived);
    this.record(edit);
    this.history = { undo: answer.undo, redo: answer.redo };
    const { selection } = this;
    if (selection?.face != null && !this.faces.faces.has(selection.face)) {
      selection.face = null;
    }
    this.emit("changed", { step: answer.step });
    if (newest >= this.materials.length || !answer.step) {
      this.refreshSoon();
    } else {
      this.measureSoon();
    }
    return answer;
  }

  /** Notes what has to be done again after a restart: of a drag only where it ends. */
  private record(edit: Edit) {
    const last = this.log.at(-1);
    if (edit.op === "cancel") {
      const begin = this.log.findLastIndex(({ op }) => op === "begin");
      this.log.length = Math.max(0, begin);
      return;
    }
    const isSame = last?.op === "move_plane" && edit.op === "move_plane" && last.brush === edit.brush && last.plane === edit.plane;
    if (isSame && this.log.at(-2)?.op === "begin") {
      this.log[this.log.length - 1] = edit;
    } else {
      this.log.push(edit);
    }
  }

  private async recover(reason: string) {
    const { source, log } = this;
    if (!source) {
      this.say(`The kernel has ended and was started again: ${reason}`, "error");
      return;
    }
    const edits = log.at(-1)?.op === "begin" ? log.slice(0, -1) : log;
    try {
      await this.open(source, isOpen(edits) ? [...edits, { op: "commit" }] : edits);
      this.say(`The kernel has ended (${reason}). It was started again with the last good state.`, "error");
    } catch (error) {
      this.say(`The kernel has ended (${reason}), and the last good state could not be opened: ${(error as Error).message}`, "error");
    }
  }

  private refreshSoon() {
    if (this.listTimer === null) {
      this.listTimer = setTimeout(() => {
        this.listTimer = null;
        this.refresh().catch((error: unknown) => this.fail(error));
      }, 30);
    }
  }

  private measureSoon() {
    const wait = Math.max(0, this.measuredAt + MEASURE_INTERVAL - performance.now());
    if (this.measureTimer === null) {
      this.measureTimer = setTimeout(() => {
        this.measureTimer = null;
        this.measure().catch((error: unknown) => this.fail(error));
      }, wait);
    }
  }

  private async measure() {
    this.measuredAt = performance.now();
    this.measures = await this.kernel.call("measures", false);
    this.emit("measured", this.measures);
  }

  private emit<Name extends keyof Events>(name: Name, event: Events[Name]) {
    for (const listener of this.listeners[name]) {
      listener(event);
    }
  }
}

/** Whether a step is begun among edits that is not ended. */
function isOpen(edits: readonly Edit[]): boolean {
  const begin = edits.findLastIndex(({ op }) => op === "begin");
  return begin >= 0 && !edits.slice(begin).some(({ op }) => op === "commit" || op === "cancel");
}

function note(times: number[], time: number) {
  times.push(time);
  if (times.length > 1000) {
    times.shift();
  }
}
