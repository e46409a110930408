/** The brushes and operations in their order: a list of rows, of which those in view are there. */

import type { Document } from "../app/document";
import type { Operand } from "../kernel/protocol";
import { h } from "./element";

const ROW = 26;

const SIGNS: Record<string, string> = { add: "+", subtract: "−", intersect: "∩", union: "∪", difference: "∖", intersection: "∩", xor: "⊕", complement: "∁" };

interface Row {
  depth: number;
  /** What stands before the name. */
  sign: string;
  /** What a screen reader says for it. */
  role: string;
  name: string;
  material: string;
  brush: number | null;
  node: number | null;
}

/** A list of the tree. */
export class TreeList {
  readonly element: HTMLElement;
  private readonly search = h("input", { type: "search", placeholder: "Find by name or material", "aria-label": "Find brushes by name or material" });
  private readonly list: HTMLElement;
  private readonly space = h("div", { class: "tree-space" });
  private readonly count = h("p", { class: "note" });
  private rows: Row[] = [];
  private found: Row[] = [];
  private active = 0;

  constructor(private readonly document: Document) {
    this.list = h("div", { class: "tree-list", role: "listbox", tabindex: "0", "aria-label": "Brushes and operations" }, this.space);
    this.element = h("div", { class: "tree" }, this.search, this.list, this.count);
    this.search.addEventListener("input", () => this.filter());
    this.list.addEventListener("scroll", () => this.render());
    this.list.addEventListener("keydown", (event) => this.key(event));
    this.list.addEventListener("focus", () => this.render());
    new ResizeObserver(() => this.render()).observe(this.list);
    document.on("listed", () => this.read());
    document.on("selected", () => this.follow());
  }

  private read() {
    const { tree, brushes } = this.document;
    const nodes = new Map(tree.nodes.map((node) => [node.node, node]));
    this.rows = [];
    const push = (operand: Operand, role: string, depth: number) => {
      if ("brush" in operand) {
        const entry = brushes.get(operand.brush);
        const name = entry?.name ?? `brush ${operand.brush}`;
        this.rows.push({ depth, sign: SIGNS[role] ?? "", role, name, material: entry?.material ?? "", brush: operand.brush, node: null });
        return;
      }
      const node = nodes.get(operand.node);
      if (node) {
        this.rows.push({ depth, sign: SIGNS[role] ?? "", role, name: `${node.operation} ${operand.node}`, material: "", brush: null, node: operand.node });
        node.operands.forEach((below, k) => push(below, node.operation === "difference" ? (k === 0 ? "add" : "subtract") : node.operation, depth + 1));
      }
    };
    tree.parts.forEach((part) => push(part, part.role, 0));
    this.filter();
  }

  private filter() {
    const text = this.search.value.trim().toLowerCase();
    const matches = (row: Row) => row.name.toLowerCase().includes(text) || row.material.toLowerCase().includes(text);
    this.found = text ? this.rows.filter(matches) : this.rows;
    this.count.textContent = `${this.found.length} of ${this.rows.length}`;
    this.active = Math.min(this.active, Math.max(0, this.found.length - 1));
    this.render();
  }

  /** Shows the row of what was chosen elsewhere. */
  private follow() {
    const { selection } = this.document;
    const row = selection ? this.found.findIndex(({ brush }) => brush === selection.brush) : -1;
    if (row >= 0) {
      this.active = row;
      const top = row * ROW;
      const { scrollTop, clientHeight } = this.list;
      if (top < scrollTop || top + ROW > scrollTop + clientHeight) {
        this.list.scrollTop = top - clientHeight / 2;
      }
    }
    this.render();
  }

  private key(event: KeyboardEvent) {
    const page = Math.max(1, Math.floor(this.list.clientHeight / ROW) - 1);
    const steps: Record<string, number> = { ArrowDown: 1, ArrowUp: -1, PageDown: page, PageUp: -page, Home: -Infinity, End: Infinity };
    const step = steps[event.key];
    if (step === undefined || this.found.length === 0) {
      return;
    }
    event.preventDefault();
    event.stopPropagation();
    this.active = Math.min(this.found.length - 1, Math.max(0, this.active + step));
    this.choose(this.active);
  }

  private choose(at: number) {
    this.active = at;
    const row = this.found[at];
    this.document.select(row?.brush == null ? null : { brush: row.brush, plane: null, face: null });
  }

  private render() {
    const { selection } = this.document;
    const first = Math.max(0, Math.floor(this.list.scrollTop / ROW) - 4);
    const last = Math.min(this.found.length, Math.ceil((this.list.scrollTop + this.list.clientHeight) / ROW) + 4);
    this.space.style.height = `${this.found.length * ROW}px`;
    const rows = this.found.slice(first, last).map((row, k) => {
      const at = first + k;
      const isChosen = row.brush !== null && row.brush === selection?.brush;
      const element = h(
        "div",
        { class: "tree-row", role: "option", id: `row-${at}`, "aria-selected": isChosen ? "true" : "false", "aria-setsize": this.found.length, "aria-posinset": at + 1, onclick: () => this.choose(at) },
        h("span", { class: "sign", "aria-label": row.role }, row.sign),
        h("span", { class: "name" }, row.name),
        h("span", { class: "material" }, row.material),
      );
      element.style.top = `${at * ROW}px`;
      element.style.paddingInlineStart = `${8 + 14 * row.depth}px`;
      return element;
    });
    this.space.replaceChildren(...rows);
    this.list.setAttribute("aria-activedescendant", `row-${this.active}`);
  }
}
