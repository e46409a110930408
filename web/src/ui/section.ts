/** The panel of the section: a plane along an axis, along a face, or anywhere, and how far in it lies. */

import { Plane, Vector3, type Box3 } from "three";

import type { Document } from "../app/document";
import { button, choice, field, h, slider, toggle } from "./element";

/** A section plane, as an address has it. */
export interface SectionState {
  /** A direction of any length. */
  normal: [number, number, number];
  /** The place along it, from 0 where the model begins to 1 where it ends. */
  at: number;
  /** Whether the other side is seen. */
  isFlipped: boolean;
}

const AXES: Record<string, SectionState["normal"]> = { x: [1, 0, 0], y: [0, 1, 0], z: [0, 0, 1] };
const FREE = "free";

/** How far a box reaches along a direction. */
function reach(box: Box3, direction: Vector3): [number, number] {
  let [low, high] = [Infinity, -Infinity];
  for (let k = 0; k < 8; k++) {
    const corner = new Vector3(k & 1 ? box.max.x : box.min.x, k & 2 ? box.max.y : box.min.y, k & 4 ? box.max.z : box.min.z);
    const along = corner.dot(direction);
    [low, high] = [Math.min(low, along), Math.max(high, along)];
  }
  return [low, high];
}

/** The plane of a section through what a box holds; what lies on its negative side is cut away. */
export function sectionPlane({ normal, at, isFlipped }: SectionState, box: Box3): Plane {
  const direction = new Vector3(...normal).normalize();
  const [low, high] = reach(box, direction);
  // a little beyond either end, so that a slider at its end shows all or nothing
  const offset = low + (high - low) * (1.002 * at - 0.001);
  return isFlipped ? new Plane(direction, -offset) : new Plane(direction.negate(), offset);
}

/** Controls of a section. */
export class SectionPart {
  readonly element = h("div");
  state: SectionState | null = null;
  private isFree = false;
  private readonly alongFace: HTMLButtonElement;

  /** `changed` is called when the plane is another one. */
  constructor(
    private readonly document: Document,
    private readonly changed: () => void,
  ) {
    this.alongFace = button("Along the chosen face", () => this.layAlongFace(), { id: "section-along" });
    document.on("selected", () => this.showSelection());
    this.render();
  }

  /** Sets what an address says. */
  set(state: SectionState | null) {
    const isPlane = state && state.normal?.length === 3 && state.normal.every(Number.isFinite) && Number.isFinite(state.at) && new Vector3(...state.normal).length() > 0;
    this.state = isPlane ? state : null;
    this.isFree = axisOf(this.state) === FREE;
    this.render();
  }

  toggle() {
    this.state = this.state ? null : { normal: [1, 0, 0], at: 0.5, isFlipped: false };
    this.isFree = false;
    this.render();
    this.changed();
  }

  private change(part: Partial<SectionState>) {
    if (this.state) {
      Object.assign(this.state, part);
      this.changed();
    }
  }

  private showSelection() {
    this.alongFace.disabled = this.document.selection?.plane == null;
  }

  /** Through the chosen face, which is what the section shows then. */
  private layAlongFace() {
    const { selection, faces } = this.document;
    const ids = selection ? [...faces.facesOf(selection.brush)].filter((id) => faces.faces.get(id)?.plane === selection.plane) : [];
    const [id] = ids;
    const normal = id === undefined ? null : faces.faces.get(id)!.normal;
    if (id === undefined || !normal) {
      this.document.say("The chosen plane has no face in sight to lay the section along.");
      return;
    }
    const direction = new Vector3(...normal);
    const [low, high] = reach(faces.box(), direction);
    const along = new Vector3().fromArray(faces.trianglesOf(id)).dot(direction);
    this.state = { normal: [...normal], at: high > low ? Math.min(1, Math.max(0, (along - low) / (high - low))) : 0.5, isFlipped: false };
    this.isFree = axisOf(this.state) === FREE;
    this.render();
    this.changed();
  }

  private render() {
    const { state } = this;
    this.showSelection();
    this.element.replaceChildren(
      h("h3", {}, "Section"),
      toggle("Cut open", state !== null, () => this.toggle(), { id: "section-toggle" }),
      ...(state
        ? [
            field("Across", choice([...Object.keys(AXES), FREE], this.isFree ? FREE : axisOf(state), (name) => this.turnTo(name), { id: "section-axis" })),
            ...(this.isFree ? this.angles(state) : []),
            field("Place", slider(0, 1, state.at, (at) => this.change({ at }), { id: "section-place" })),
            toggle("Other side", state.isFlipped, (isFlipped) => this.change({ isFlipped })),
          ]
        : []),
      h("div", { class: "row" }, this.alongFace),
    );
  }

  private turnTo(name: string) {
    this.isFree = name === FREE;
    this.change(this.isFree ? {} : { normal: [...AXES[name]!] });
    this.render();
  }

  /** Sliders of a direction: about the z axis, and up from the x–y plane. */
  private angles(state: SectionState): HTMLElement[] {
    const [x, y, z] = state.normal;
    const degrees = 180 / Math.PI;
    let [turn, tilt] = [Math.atan2(y, x) * degrees, Math.atan2(z, Math.hypot(x, y)) * degrees];
    const set = () => {
      const [a, b] = [turn / degrees, tilt / degrees];
      this.change({ normal: [Math.cos(a) * Math.cos(b), Math.sin(a) * Math.cos(b), Math.sin(b)] });
    };
    return [
      field("Turn", slider(-180, 180, turn, (value) => ((turn = value), set()), { id: "section-turn" }), "°"),
      field("Tilt", slider(-90, 90, tilt, (value) => ((tilt = value), set()), { id: "section-tilt" }), "°"),
    ];
  }
}

/** The name of the axis that a section lies across. */
function axisOf(state: SectionState | null): string {
  return Object.entries(AXES).find(([, axis]) => state?.normal.every((value, k) => value === axis[k]))?.[0] ?? FREE;
}
