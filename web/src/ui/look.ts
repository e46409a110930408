/** How the picture is drawn: edges, x-ray, section, cells moved apart, colliders. */

import { Plane, Vector3 } from "three";

import type { Document } from "../app/document";
import { Pieces } from "../view/pieces";
import type { Viewer } from "../view/viewer";
import { button, choice, field, h, numberInput, shown, slider, toggle } from "./element";

const AXES = ["x", "y", "z"] as const;

/** What can be set, as an address has it. */
export interface LookState {
  edges: boolean;
  xray: boolean;
  /** The axis and the place of a section along it, 0 to 1. */
  section: { axis: number; at: number; isFlipped: boolean } | null;
}

/** The panel of the picture. */
export class LookPanel {
  readonly element: HTMLElement;
  /** Is called when something is set. */
  onChange: () => void = () => {};
  readonly state: LookState = { edges: true, xray: false, section: null };
  private cells: Pieces | null = null;
  private colliders: Pieces | null = null;
  private explosion = 0.6;
  private readonly sectionPart = h("div");
  private readonly cellsPart = h("div");
  private readonly collidersPart = h("div");
  private readonly shading = h("div");
  private colliderLimit = 16;
  private colliderTimer: ReturnType<typeof setTimeout> | null = null;
  private colliderRun = 0;

  constructor(
    private readonly document: Document,
    private readonly viewer: Viewer,
  ) {
    this.element = h("div", { class: "look" }, this.shading, this.sectionPart, this.cellsPart, this.collidersPart);
    document.on("opened", () => {
      this.hideCells();
      this.hideColliders();
      this.apply();
    });
    document.on("changed", ({ step }) => {
      // pieces are of the model as it was
      if (!step) {
        this.hideCells();
        if (this.colliders) {
          this.coarsenSoon();
        }
      }
    });
    viewer.onFrame = () => {
      const box = document.faces.box();
      if (viewer.sectionPlane && !box.isEmpty()) {
        viewer.section.place(box.getCenter(new Vector3()), box.getSize(new Vector3()).length() / 2);
      }
    };
    this.render();
  }

  /** Sets what an address says. */
  set(state: LookState) {
    Object.assign(this.state, state);
    this.apply();
  }

  toggleXray() {
    this.state.xray = !this.state.xray;
    this.apply();
  }

  toggleEdges() {
    this.state.edges = !this.state.edges;
    this.apply();
  }

  toggleSection() {
    this.state.section = this.state.section ? null : { axis: 0, at: 0.5, isFlipped: false };
    this.apply();
  }

  async toggleCells() {
    if (this.cells) {
      this.hideCells();
      return;
    }
    await this.document.attempt(async () => {
      this.cells = new Pieces(await this.document.kernel.call("cells"), 1);
      this.cells.explode(this.explosion);
      this.viewer.scene.add(this.cells.group);
      this.apply();
    });
  }

  async toggleColliders() {
    if (this.colliders) {
      this.hideColliders();
    } else {
      await this.coarsen();
    }
  }

  private apply() {
    const { edges, xray, section } = this.state;
    this.viewer.setLook({ edges, xray, solid: !this.cells });
    this.viewer.setSection(section && this.planeOf(section));
    this.render();
    this.onChange();
  }

  private planeOf({ axis, at, isFlipped }: NonNullable<LookState["section"]>): Plane {
    const box = this.document.faces.box();
    const [low, high] = [box.min.getComponent(axis), box.max.getComponent(axis)];
    // a little beyond either end, so that a slider at its end shows all or nothing
    const offset = low + (high - low) * (1.002 * at - 0.001);
    const normal = new Vector3().setComponent(axis, isFlipped ? 1 : -1);
    return new Plane(normal, isFlipped ? -offset : offset);
  }

  private render() {
    const { state } = this;
    this.shading.replaceChildren(
      h("h3", {}, "Shading"),
      toggle("Edges", state.edges, () => this.toggleEdges()),
      toggle("X-ray", state.xray, () => this.toggleXray()),
    );
    const { section } = state;
    const change = (part: Partial<NonNullable<LookState["section"]>>) => {
      if (this.state.section) {
        Object.assign(this.state.section, part);
        this.viewer.setSection(this.planeOf(this.state.section));
        this.onChange();
      }
    };
    this.sectionPart.replaceChildren(
      h("h3", {}, "Section"),
      toggle("Cut open", section !== null, () => this.toggleSection(), { id: "section-toggle" }),
      ...(section
        ? [
            field("Axis", choice(AXES, AXES[section.axis]!, (axis) => change({ axis: AXES.indexOf(axis as "x") }))),
            field("Place", slider(0, 1, section.at, (at) => change({ at }), { id: "section-place" })),
            toggle("Other side", section.isFlipped, (isFlipped) => change({ isFlipped })),
          ]
        : []),
    );
    this.cellsPart.replaceChildren(
      h("h3", {}, "Convex cells"),
      toggle("Move apart", this.cells !== null, () => void this.toggleCells(), { id: "cells-toggle" }),
      ...(this.cells
        ? [
            field(
              "Distance",
              slider(0, 2, this.explosion, (amount) => {
                this.explosion = amount;
                this.cells?.explode(amount);
                this.viewer.draw();
              }),
            ),
            h("p", { class: "note" }, `${this.cells.count} cells, which do not overlap`),
          ]
        : []),
    );
    this.renderColliders(null);
  }

  private renderColliders(result: { excess: number; count: number } | null) {
    if (result === null && this.colliders) {
      return;
    }
    const set = (limit: number) => {
      this.colliderLimit = Math.max(1, Math.round(limit));
      this.coarsenSoon();
    };
    this.collidersPart.replaceChildren(
      h("h3", {}, "Colliders"),
      toggle("Show hulls", this.colliders !== null, () => void this.toggleColliders(), { id: "colliders-toggle" }),
      ...(this.colliders && result
        ? [
            field("At most", slider(0, 8, Math.log2(this.colliderLimit), (value) => set(2 ** value), { id: "colliders-limit", "aria-valuetext": `${this.colliderLimit} hulls` })),
            field("", numberInput(this.colliderLimit, set, { min: 1, max: 1024, step: 1, "aria-label": "Maximum number of hulls" })),
            h("p", { class: "note", id: "colliders-result" }, `${result.count} hulls hold the solid and add ${shown(100 * result.excess, 4)} % of its volume`),
            h("div", { class: "row" }, button("Hide", () => this.hideColliders())),
          ]
        : []),
    );
  }

  private coarsenSoon() {
    if (this.colliderTimer !== null) {
      clearTimeout(this.colliderTimer);
    }
    this.colliderTimer = setTimeout(() => void this.coarsen(), 150);
  }

  private async coarsen() {
    const run = ++this.colliderRun;
    await this.document.attempt(async () => {
      const { pieces, excess } = await this.document.kernel.call("coarsen", { maxCells: this.colliderLimit });
      if (run !== this.colliderRun) {
        return;
      }
      this.colliders?.dispose();
      this.colliders = new Pieces(pieces, 0.45);
      this.viewer.scene.add(this.colliders.group);
      this.renderColliders({ excess, count: this.colliders.count });
      this.viewer.draw();
    });
  }

  private hideColliders() {
    this.colliderRun++;
    this.colliders?.dispose();
    this.colliders = null;
    this.renderColliders(null);
    this.viewer.draw();
  }

  private hideCells() {
    if (this.cells) {
      this.cells.dispose();
      this.cells = null;
      this.apply();
    }
  }
}
