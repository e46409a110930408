/** Moves, turns and scales a whole brush by handles in the picture: each drag is one step. */

import { Matrix4, Object3D, Vector3 } from "three";
import { TransformControls } from "three/addons/controls/TransformControls.js";

import type { Viewer } from "../view/viewer";
import type { Document } from "./document";
import { rowsOf } from "./matrix";
import type { Tools } from "./tools";

export type GizmoMode = "translate" | "rotate" | "scale";

/** Handles at the middle of the chosen brush. */
export class Gizmo {
  mode: GizmoMode | null = null;
  private readonly controls: TransformControls;
  private readonly handle = new Object3D();
  /** Where the handle was when the drag began. */
  private start = new Matrix4();
  private brush: number | null = null;
  private target: Matrix4 | null = null;
  private running: Promise<void> | null = null;
  private hasMoved = false;

  constructor(
    private readonly document: Document,
    private readonly viewer: Viewer,
    private readonly tools: Tools,
  ) {
    this.controls = new TransformControls(viewer.camera, viewer.canvas);
    viewer.scene.add(this.handle, this.controls.getHelper());
    this.controls.addEventListener("change", () => viewer.draw());
    this.controls.addEventListener("objectChange", () => this.follow());
    this.controls.addEventListener("mouseDown", () => this.begin());
    this.controls.addEventListener("mouseUp", () => void this.end());
    document.on("selected", () => this.attach());
    document.on("changed", ({ step }) => step || this.attach());
  }

  /** Shows handles of a kind, or none. */
  use(mode: GizmoMode | null) {
    this.mode = mode;
    if (mode) {
      this.controls.setMode(mode);
    }
    this.attach();
  }

  /** Whether the pointer is on a handle, or holds one. */
  get isInUse(): boolean {
    return this.controls.axis !== null || this.controls.dragging;
  }

  private attach() {
    const { selection, faces } = this.document;
    if (this.controls.dragging) {
      return;
    }
    this.brush = selection?.brush ?? null;
    const points: Vector3[] = [];
    if (this.brush !== null) {
      for (const id of faces.facesOf(this.brush)) {
        const outline = faces.outlineOf(id);
        for (let k = 0; k < outline.length; k += 3) {
          points.push(new Vector3().fromArray(outline, k));
        }
      }
    }
    if (!this.mode || points.length === 0) {
      this.controls.detach();
      this.viewer.draw();
      return;
    }
    const [low, high] = [points[0]!.clone(), points[0]!.clone()];
    points.forEach((point) => {
      low.min(point);
      high.max(point);
    });
    this.handle.position.copy(low.add(high).multiplyScalar(0.5));
    this.handle.rotation.set(0, 0, 0);
    this.handle.scale.set(1, 1, 1);
    const { grid } = this.tools.settings;
    this.controls.setTranslationSnap(grid > 0 ? grid : null);
    this.controls.setRotationSnap(grid > 0 ? Math.PI / 12 : null);
    this.controls.attach(this.handle);
    this.viewer.draw();
  }

  private begin() {
    this.handle.updateMatrix();
    this.start = this.handle.matrix.clone();
    this.hasMoved = false;
    this.viewer.controls.enabled = false;
  }

  private follow() {
    this.handle.updateMatrix();
    const { center } = this.document;
    const toCenter = new Matrix4().makeTranslation(-center[0], -center[1], -center[2]);
    const back = new Matrix4().makeTranslation(...center);
    const motion = this.handle.matrix.clone().multiply(this.start.clone().invert());
    this.target = back.multiply(motion).multiply(toCenter);
    this.running ??= this.run();
  }

  /** Transforms the brush as it was, not as it is: many small motions would add up their rounding. */
  private async run() {
    try {
      while (this.target && this.brush !== null) {
        const matrix = rowsOf(this.target);
        this.target = null;
        if (this.hasMoved) {
          await this.document.edit({ op: "cancel" });
        }
        await this.document.edit({ op: "begin" });
        this.hasMoved = true;
        await this.document.edit({ op: "transform_brush", brush: this.brush, matrix });
      }
    } catch (error) {
      this.document.fail(error);
    } finally {
      this.running = null;
    }
  }

  private async end() {
    this.viewer.controls.enabled = true;
    await this.running;
    if (this.hasMoved) {
      await this.document.attempt(() => this.document.edit({ op: "commit" }));
    }
    this.attach();
  }
}
