/** How the picture is drawn: edges, x-ray, section, cells moved apart, colliders. */

import { Vector3 } from "three";

import type { Document } from "../app/document";
import { Pieces } from "../view/pieces";
import type { Viewer } from "../view/viewer";
import { button, field, h, numberInput, shown, slider, toggle } from "./element";
import { SectionPart, sectionPlane, type SectionState } from "./section";

/** What can be set, as an address has it. */
export interface LookState {
  edges: boolean;
  xray: boolean;
  section: SectionState | null;
}

/** The panel of the picture. */
export class LookPanel {
  readonly element: HTMLElement;
  /** Is called when something is set. */
  onChange: () => void = () => {};
  private shading = { edges: true, xray: false };
  private cells: Pieces | null = null;
  private colliders: Pieces | null = null;
  private explosion = 0.6;
  private readonly section: SectionPart;
  private readonly cellsPart = h("div");
  private readonly collidersPart = h("div");
  private readonly shadingPart = h("div");
  private colliderLimit = 16;
  private colliderTimer: ReturnType<typeof setTimeout> | null = null;
  private colliderRun = 0;

  constructor(
    private readonly document: Document,
    private readonly viewer: Viewer,
  ) {
    this.section = new SectionPart(document, () => this.applySection());
    this.element = h("div", { class: "look" }, this.shadingPart, this.section.element, this.cellsPart, this.collidersPart);
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

  get state(): LookState {
    return { ...this.shading, section: this.section.state };
  }

  /** Sets what an address says. */
  set({ edges, xray, section }: LookState) {
    this.shading = { edges, xray };
    this.section.set(section);
    this.apply();
  }

  toggleXray() {
    this.shading.xray = !this.shading.xray;
    this.apply();
  }

  toggleEdges() {
    this.shading.edges = !this.shading.edges;
    this.apply();
  }

  toggleSection() {
    this.section.toggle();
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
    this.viewer.setLook({ ...this.shading, solid: !this.cells });
    this.render();
    this.applySection();
  }

  private applySection() {
    const { state } = this.section;
    this.viewer.setSection(state && sectionPlane(state, this.document.faces.box()));
    this.onChange();
  }

  private render() {
    const { edges, xray } = this.shading;
    this.shadingPart.replaceChildren(
      h("h3", {}, "Shading"),
      toggle("Edges", edges, () => this.toggleEdges()),
      toggle("X-ray", xray, () => this.toggleXray()),
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
