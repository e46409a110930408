/** The text of what is open: changed text is built as soon as it is right, and what is wrong is marked at its line. */

import type { Document } from "../app/document";
import { KernelError } from "../kernel/client";
import { h } from "./element";
import type { TextPane } from "./text";

/** How long after the last letter the text is built, in milliseconds. */
const DELAY = 350;

/** Longest text that is shown. */
const LONGEST = 2_000_000;

/** A panel that loads the editor of texts when it is first seen. */
export class SourcePane {
  readonly element = h("div", { class: "source" });
  private readonly state = h("p", { class: "note", role: "status" });
  private readonly host = h("div", { class: "source-text" });
  private pane: TextPane | null = null;
  private isDark = false;
  private timer: ReturnType<typeof setTimeout> | null = null;
  private ownText: string | null = null;
  private hasStarted = false;

  constructor(private readonly document: Document) {
    this.element.append(this.host, this.state);
    document.on("opened", () => this.show());
    new IntersectionObserver(([entry]) => entry?.isIntersecting && this.start()).observe(this.element);
  }

  setTheme(isDark: boolean) {
    this.isDark = isDark;
    this.pane?.setTheme(isDark);
  }

  private start() {
    if (this.hasStarted) {
      return;
    }
    this.hasStarted = true;
    void import("./text").then(({ TextPane }) => {
      this.pane = new TextPane(this.host, (text) => this.changed(text));
      this.pane.setTheme(this.isDark);
      this.show();
    });
  }

  private show() {
    const { source } = this.document;
    if (!this.pane || !source) {
      return;
    }
    const isText = /\.(json|map|csg|obj)$/i.test(source.name) && source.bytes.length <= LONGEST;
    const text = isText ? new TextDecoder().decode(source.bytes) : "";
    this.host.hidden = !isText;
    this.state.textContent = isText ? "Built as you type." : "This file is no text, or too long to be shown.";
    if (isText && text !== this.ownText) {
      this.pane.show(text, source.name.endsWith(".json"));
    }
  }

  private changed(text: string) {
    if (this.timer !== null) {
      clearTimeout(this.timer);
    }
    this.timer = setTimeout(() => void this.build(text), DELAY);
  }

  private async build(text: string) {
    const { source, edits } = this.document;
    if (!source) {
      return;
    }
    this.ownText = text;
    try {
      await this.document.open({ ...source, bytes: new TextEncoder().encode(text), parameters: {}, origin: {} });
      this.pane?.mark(null);
      this.state.textContent = edits.length > 0 ? "Built. Edits made in the picture are gone." : "Built.";
    } catch (error) {
      const message = error instanceof Error ? error.message : String(error);
      this.state.textContent = message;
      if (error instanceof KernelError && error.line !== null) {
        this.pane?.mark({ message, line: error.line });
      }
    } finally {
      this.ownText = null;
    }
  }
}
