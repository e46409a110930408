/** Volume, area, mass and inertia of the solid, and what the measuring tool has measured. */

import type { Document } from "../app/document";
import { button, field, h, numberInput, shown } from "./element";

/** The panel of measures. */
export class MeasurePanel {
  readonly element: HTMLElement;
  private readonly solid = h("dl", { id: "measures" });
  private readonly mass = h("dl", { id: "mass" });
  private readonly measured = h("p", { class: "note", role: "status" }, "With the measuring tool, click two places: distances, and the angle between the faces.");
  private density = 1000;

  constructor(private readonly document: Document) {
    this.element = h(
      "div",
      { class: "measures" },
      h("h3", {}, "Solid"),
      this.solid,
      h("h3", {}, "Mass"),
      field("Density", numberInput(this.density, (value) => this.setDensity(value), { min: 0 }), "per unit³"),
      h("div", { class: "row" }, button("Mass and inertia", () => void this.weigh())),
      this.mass,
      h("h3", {}, "Measured"),
      this.measured,
    );
    document.on("measured", () => this.render());
    document.on("opened", () => this.mass.replaceChildren());
    document.on("changed", () => this.mass.replaceChildren());
  }

  /** Shows what was measured in the picture. */
  tell(text: string) {
    this.measured.textContent = text;
  }

  private setDensity(density: number) {
    this.density = density;
    void this.weigh();
  }

  private async weigh() {
    await this.document.attempt(async () => {
      const mass = await this.document.kernel.call("mass", this.density);
      if (!mass) {
        this.mass.replaceChildren(...entries([["Mass", "nothing"]]));
        return;
      }
      const [xx, yy, zz, xy, xz, yz] = mass.inertia.map((value) => shown(value));
      this.mass.replaceChildren(
        ...entries([
          ["Mass", shown(mass.mass, 8)],
          ["Center", mass.center.map((value) => shown(value)).join(", ")],
          ["Inertia xx, yy, zz", `${xx}, ${yy}, ${zz}`],
          ["Inertia xy, xz, yz", `${xy}, ${xz}, ${yz}`],
        ]),
      );
    });
  }

  private render() {
    const { measures } = this.document;
    if (!measures) {
      return;
    }
    const vector = (value: readonly number[] | null) => value?.map((part) => shown(part)).join(", ") ?? "–";
    const size = measures.min && measures.max ? measures.max.map((high, k) => high - measures.min![k]!) : null;
    this.solid.replaceChildren(
      ...entries([
        ["Volume", shown(measures.volume, 9)],
        ["Area", shown(measures.area, 9)],
        ["Centroid", vector(measures.centroid)],
        ["Size", vector(size)],
        ["Brushes", measures.brushes.toLocaleString("en")],
        ["Faces", measures.faces.toLocaleString("en")],
        ["Triangles", measures.triangles.toLocaleString("en")],
      ]),
    );
  }
}

function entries(rows: [string, string][]): HTMLElement[] {
  return rows.map(([name, value]) => h("div", {}, h("dt", {}, name), h("dd", {}, value)));
}
