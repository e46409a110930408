/** What is chosen, and what can be done to it. */

import { Matrix4, Vector3 } from "three";

import type { Document } from "../app/document";
import { rowsOf } from "../app/matrix";
import type { BrushAnswer, HalfSpace, Role } from "../kernel/protocol";
import { ghost, discard } from "../view/overlays";
import type { Viewer } from "../view/viewer";
import { button, choice, field, h, numberInput, shown } from "./element";

const ROLES = ["add", "subtract", "intersect"] as const;

const ADDED = 0x3ecf8e;

/** The panel of the chosen brush and plane. */
export class Properties {
  readonly element = h("div", { class: "properties" });
  private shownFor: string | null = null;
  private preview: ReturnType<typeof ghost> | null = null;

  constructor(
    private readonly document: Document,
    private readonly viewer: Viewer,
  ) {
    document.on("selected", () => this.read());
    document.on("listed", () => this.read());
    document.on("changed", ({ step }) => {
      this.hidePreview();
      if (!step) {
        this.read();
      }
    });
    this.read();
  }

  private read() {
    this.hidePreview();
    const { selection } = this.document;
    if (!selection || !this.document.source) {
      this.shownFor = null;
      this.element.replaceChildren(h("p", { class: "note" }, "Click a face, or choose a brush in the tree. Drag a face to move its plane."));
      return;
    }
    const { brush } = selection;
    this.document
      .brush(brush)
      .then((answer) => this.show(answer))
      .catch(() => {
        // the brush is gone, after an undo for example
        if (this.document.selection?.brush === brush) {
          this.document.select(null);
        }
      });
  }

  private show(answer: BrushAnswer) {
    const { selection } = this.document;
    if (selection?.brush !== answer.brush) {
      return;
    }
    // an input that is being typed into stays where it is
    const focused = this.element.contains(document.activeElement) ? document.activeElement?.getAttribute("data-key") : null;
    const key = `${answer.brush}/${selection.plane}`;
    const plane = answer.planes.find((entry) => entry.plane === selection.plane);
    this.element.replaceChildren(this.brushPart(answer), ...(plane ? [this.planePart(answer, plane)] : []), this.planeList(answer));
    if (focused && this.shownFor === key) {
      this.element.querySelector<HTMLElement>(`[data-key="${focused}"]`)?.focus();
    }
    this.shownFor = key;
  }

  private brushPart({ brush, name, role, parent, planes }: BrushAnswer): HTMLElement {
    const names = this.document.materials.map((material) => material.name);
    const materials = new Set(planes.map(({ material }) => material));
    const material = materials.size === 1 ? planes[0]!.material : "(several)";
    const edit = (edit: { op: string } & Record<string, unknown>) => void this.document.attempt(() => this.document.edit(edit));
    const nameInput = h("input", { type: "text", value: name ?? "", placeholder: `brush ${brush}`, "data-key": "name" });
    nameInput.addEventListener("change", () => edit({ op: "rename_brush", brush, ...(nameInput.value ? { name: nameInput.value } : {}) }));
    const materialInput = h("input", { type: "text", value: material, list: "materials", "data-key": "material" });
    materialInput.addEventListener("change", () => materialInput.value && edit({ op: "set_material", brush, material: materialInput.value }));
    const roleInput = choice(ROLES, role, (value) => edit({ op: "set_role", brush, role: value as Role }), { disabled: parent !== null, "data-key": "role" });
    return h(
      "section",
      {},
      h("h3", {}, name ?? `Brush ${brush}`),
      field("Name", nameInput),
      field("Role", roleInput),
      field("Material", materialInput),
      h("datalist", { id: "materials" }, ...names.map((value) => h("option", { value }))),
      h(
        "div",
        { class: "row" },
        button("Copy", () => this.copy(brush), { keys: "Shift+D", "data-key": "copy" }),
        button("Mirror x", () => this.mirror(brush, planes.map(({ half_space }) => half_space)), { "data-key": "mirror", title: "A copy, mirrored in the plane x = 0 through the middle of the view" }),
        button("Delete", () => this.remove(brush), { keys: "Delete", class: "danger", "data-key": "delete" }),
      ),
    );
  }

  private planePart(answer: BrushAnswer, { plane, half_space, material }: BrushAnswer["planes"][number]): HTMLElement {
    const { brush } = answer;
    const offset = half_space[3];
    const edit = (edit: { op: string } & Record<string, unknown>) => void this.document.attempt(() => this.document.edit(edit));
    const turn = (to: HalfSpace) => edit({ op: "move_plane", brush, plane, to });
    const component = (k: number) => {
      const input = numberInput(half_space[k]!, (value) => turn(half_space.map((old, i) => (i === k ? value : old)) as HalfSpace), { "data-key": `normal-${k}` });
      input.setAttribute("aria-label", `Normal ${"xyz"[k]}`);
      return input;
    };
    const materialInput = h("input", { type: "text", value: material, list: "materials", "data-key": "plane-material" });
    materialInput.addEventListener("change", () => materialInput.value && edit({ op: "set_material", brush, plane, material: materialInput.value }));
    const remove = button("Remove plane", () => this.removePlane(brush, plane), { keys: "X", "data-key": "remove-plane", title: "Take the plane out; the green body is what the brush gains" });
    for (const event of ["pointerenter", "focus"]) {
      remove.addEventListener(event, () => void this.showPreview(brush, plane));
    }
    for (const event of ["pointerleave", "blur"]) {
      remove.addEventListener(event, () => this.hidePreview());
    }
    return h(
      "section",
      {},
      h("h3", {}, `Plane ${plane}`),
      field("Offset", numberInput(offset, (value) => edit({ op: "move_plane", brush, plane, offset: value }), { "data-key": "offset" })),
      h("div", { class: "field" }, h("span", {}, "Normal"), component(0), component(1), component(2)),
      field("Material", materialInput),
      h("div", { class: "row" }, remove, button("Flip", () => this.flip(brush, plane), { keys: "F", "data-key": "flip", title: "Keep the other side of the plane" })),
    );
  }

  private planeList({ brush, planes }: BrushAnswer): HTMLElement {
    const { selection } = this.document;
    const entry = ({ plane, half_space: [x, y, z, offset], material }: BrushAnswer["planes"][number]) => {
      const isChosen = plane === selection?.plane;
      const text = `${shown(x, 3)} x + ${shown(y, 3)} y + ${shown(z, 3)} z ≤ ${shown(offset, 5)}`;
      const choose = () => this.document.select({ brush, plane: isChosen ? null : plane, face: null });
      return h("li", {}, h("button", { type: "button", class: "plane", "aria-pressed": isChosen ? "true" : "false", "data-key": `plane-${plane}`, onclick: choose }, h("b", {}, String(plane)), h("span", {}, text), h("i", {}, material)));
    };
    return h("section", {}, h("h3", {}, `${planes.length} planes`), h("ul", { class: "planes" }, ...planes.slice(0, 200).map(entry), planes.length > 200 ? h("li", { class: "note" }, `and ${planes.length - 200} more`) : null));
  }

  /** Copies a brush beside itself, and chooses the copy. */
  copy(brush: number) {
    const size = this.document.faces.box().getSize(new Vector3());
    const shift = new Matrix4().makeTranslation(rounded(size.x / 8), 0, 0);
    void this.document.attempt(async () => {
      const { copies } = await this.document.edit({ op: "copy_brushes", brushes: [brush], matrix: rowsOf(shift) });
      this.document.select(copies?.[0] === undefined ? null : { brush: copies[0], plane: null, face: null });
    });
  }

  /** Deletes a brush. */
  remove(brush: number) {
    void this.document.attempt(async () => {
      await this.document.edit({ op: "remove_brush", brush });
      this.document.select(null);
    });
  }

  /** Takes a plane out of a brush. */
  removePlane(brush: number, plane: number) {
    void this.document.attempt(async () => {
      await this.document.edit({ op: "remove_plane", brush, plane });
      this.document.select({ brush, plane: null, face: null });
    });
  }

  /** Keeps the other side of a plane. */
  flip(brush: number, plane: number) {
    void this.document.attempt(async () => {
      const half = await this.document.halfSpace(brush, plane);
      if (half) {
        await this.document.edit({ op: "move_plane", brush, plane, to: half.map((value) => -value) });
      }
    });
  }

  private mirror(brush: number, planes: HalfSpace[]) {
    // the plane of the brush that is farthest along x, so that the copy lies beside it
    const along = planes.filter(([x, y, z]) => x > 0.999 * Math.hypot(x, y, z));
    const plane = along[0] ?? [1, 0, 0, this.document.center[0]];
    void this.document.attempt(() => this.document.edit({ op: "mirror_brushes", brushes: [brush], plane }));
  }

  private async showPreview(brush: number, plane: number) {
    try {
      const removal = await this.document.kernel.call("previewRemovePlane", brush, plane);
      this.hidePreview();
      if (removal.gain === "unbounded") {
        this.document.say("Without this plane the brush has no end.");
      } else if (removal.gain === "piece" && this.document.selection?.brush === brush) {
        const { center } = this.document;
        const places = removal.positions.flatMap((at) => at.map((value, k) => value - center[k]!));
        this.preview = ghost(new Float32Array(places), new Uint32Array(removal.triangles.flat()), ADDED);
        this.viewer.overlay.add(this.preview);
        this.viewer.draw();
      }
    } catch (error) {
      this.document.fail(error);
    }
  }

  private hidePreview() {
    if (this.preview) {
      discard(this.preview);
      this.preview = null;
      this.viewer.draw();
    }
  }
}

/** A length with one digit. */
function rounded(length: number): number {
  return Number(Math.max(length, 1e-6).toPrecision(1));
}
