/** What the pointer does on the picture: choose, drag, turn, cut, measure. One tool is active at a time. */

import type { Hit } from "../kernel/protocol";
import { Highlight } from "../view/overlays";
import type { Viewer } from "../view/viewer";
import type { Document } from "./document";
import { cutBrush } from "./gestures/cut_brush";
import { dragFace } from "./gestures/drag_face";
import { isFar, type Gesture, type Scene, type ToolOutput, type ToolSettings } from "./gestures/gesture";
import { turnPlane } from "./gestures/turn_plane";
import { Measuring } from "./measuring";

export type ToolName = "select" | "turn" | "cut" | "measure";

/** The tools of the picture. */
export class Tools implements Scene {
  active: ToolName = "select";
  readonly settings: ToolSettings = { grid: 0, snapsToPlanes: true };
  private readonly hover = new Highlight(0x4aa3ff, 0.18);
  private readonly chosen = new Highlight(0xff9d2e, 0.22);
  private readonly measuring: Measuring;
  private gesture: Gesture | null = null;
  private hovered: Hit | null = null;
  private isPicking = false;
  private nextPick: PointerEvent | null = null;

  /** Is called when another tool is active. */
  onTool: (name: ToolName) => void = () => {};

  constructor(
    readonly document: Document,
    readonly viewer: Viewer,
    readonly output: ToolOutput,
  ) {
    this.measuring = new Measuring(document, viewer, output);
    viewer.overlay.add(this.hover.group, this.chosen.group, this.measuring.marks);
    const { canvas } = viewer;
    // before the camera's own listener, which would turn it
    canvas.addEventListener("pointerdown", (event) => this.down(event), { capture: true });
    canvas.addEventListener("pointermove", (event) => this.move(event));
    canvas.addEventListener("pointerup", (event) => this.up(event));
    canvas.addEventListener("pointercancel", () => this.cancel());
    canvas.addEventListener("pointerleave", () => this.setHover(null));
    document.on("selected", () => this.showSelection());
    document.on("changed", () => this.showSelection());
    document.on("opened", () => {
      this.setHover(null);
      this.measuring.clear();
    });
  }

  /** Changes the tool. */
  use(name: ToolName) {
    this.cancel();
    this.measuring.clear();
    this.active = name;
    this.viewer.canvas.dataset.tool = name;
    this.onTool(name);
    this.output.hint(null);
  }

  /** Ends what is under way, as if it had not begun. */
  cancel() {
    this.gesture?.cancel();
    this.gesture = null;
    this.viewer.controls.enabled = true;
    this.output.hint(null);
  }

  /** Whether something is dragged. */
  get isBusy(): boolean {
    return this.gesture !== null;
  }

  private down(event: PointerEvent) {
    if (event.button !== 0 || event.altKey || !event.isPrimary) {
      return;
    }
    if (this.active === "cut") {
      const { selection } = this.document;
      const brush = selection?.brush ?? this.hovered?.brush ?? null;
      this.begin(event, cutBrush(this, event, brush));
      return;
    }
    const hit = this.hovered;
    if (!hit || hit.brush === null || hit.plane === null) {
      this.begin(event, this.click(event, null), true);
      return;
    }
    const { brush, plane } = hit;
    if (this.active === "measure") {
      this.begin(event, this.click(event, hit), true);
    } else if (this.active === "turn") {
      this.begin(event, turnPlane(this, event, hit, brush, plane));
    } else {
      this.begin(event, dragFace(this, event, hit, brush, plane));
    }
  }

  private begin(event: PointerEvent, gesture: Gesture, movesCamera = false) {
    this.gesture = gesture;
    if (!movesCamera) {
      this.viewer.controls.enabled = false;
      this.viewer.canvas.setPointerCapture(event.pointerId);
    }
  }

  private move(event: PointerEvent) {
    if (this.gesture) {
      this.gesture.move(event);
    } else if (event.buttons === 0) {
      this.lookUnder(event);
    }
  }

  private up(event: PointerEvent) {
    const { gesture } = this;
    this.gesture = null;
    gesture?.end(event);
    this.viewer.controls.enabled = true;
    this.output.hint(null);
  }

  /** Asks what is under the pointer; the newest place alone while an answer is awaited. */
  private lookUnder(event: PointerEvent) {
    if (this.isPicking) {
      this.nextPick = event;
      return;
    }
    if (!this.document.source) {
      return;
    }
    this.isPicking = true;
    this.pickAt(event.clientX, event.clientY)
      .then((hit) => this.setHover(hit, event))
      .catch(() => this.setHover(null))
      .finally(() => {
        this.isPicking = false;
        const next = this.nextPick;
        this.nextPick = null;
        if (next && !this.gesture) {
          this.lookUnder(next);
        }
      });
  }

  /** The face at a place of the page; what the section has cut away is looked through. */
  async pickAt(x: number, y: number): Promise<Hit | null> {
    const { origin, direction } = this.viewer.rayAt(x, y);
    const cut = this.viewer.sectionPlane;
    if (cut && cut.distanceToPoint(origin) < 0) {
      const through = -cut.distanceToPoint(origin) / cut.normal.dot(direction);
      if (!(through > 0)) {
        return null;
      }
      origin.addScaledVector(direction, through);
    }
    const { center } = this.document;
    const from: [number, number, number] = [origin.x + center[0], origin.y + center[1], origin.z + center[2]];
    return this.document.pick(from, [direction.x, direction.y, direction.z]);
  }

  private setHover(hit: Hit | null, event?: PointerEvent) {
    this.hovered = hit;
    const { canvas } = this.viewer;
    canvas.dataset.over = hit ? "face" : "nothing";
    if (!hit) {
      this.hover.hide();
      this.output.hint(null);
    } else {
      this.hover.show(this.document.faces, [hit.face]);
      const face = this.document.faces.faces.get(hit.face);
      const entry = hit.brush === null ? undefined : this.document.brushes.get(hit.brush);
      const material = face && this.document.materials[face.material]?.name;
      const name = entry?.name ?? (hit.brush === null ? "no brush" : `brush ${hit.brush}`);
      this.output.hint(`${name} · plane ${hit.plane ?? "–"} · ${material ?? ""}`, event);
    }
    this.viewer.draw();
  }

  private showSelection() {
    const { selection, faces } = this.document;
    if (!selection) {
      this.chosen.hide();
    } else {
      const all = [...faces.facesOf(selection.brush)];
      const ofPlane = selection.plane === null ? all : all.filter((id) => faces.faces.get(id)?.plane === selection.plane);
      this.chosen.show(faces, ofPlane);
    }
    this.viewer.draw();
  }

  /** Chooses what is clicked, or nothing; measures with the tool for it. The camera turns where the pointer moves. */
  private click(event: PointerEvent, hit: Hit | null): Gesture {
    let moved = false;
    return {
      move: (now) => {
        moved ||= isFar(event, now);
      },
      end: () => {
        if (moved) {
          return;
        }
        if (this.active === "measure" && hit) {
          this.measuring.add(hit);
        } else {
          this.choose(hit);
        }
      },
      cancel: () => {},
    };
  }

  /** Selects what was hit, or nothing. */
  choose(hit: Hit | null) {
    if (this.gesture) {
      this.hover.hide();
    }
    this.document.select(hit?.brush == null ? null : { brush: hit.brush, plane: hit.plane, face: hit.face });
  }
}
