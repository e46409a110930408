/** What the page says: the last lines of the status bar, read out by screen readers, and whether the kernel is at work. */

import type { Document } from "../app/document";
import { button, h } from "./element";

/** How long work goes on before there is a button to end it, in milliseconds. */
const PATIENCE = 600;

/** How long a note stays, in milliseconds; errors stay until they are closed. */
const NOTE = 6000;

/** The status bar. */
export class Messages {
  readonly element: HTMLElement;
  private readonly list = h("div", { class: "messages", role: "log", "aria-live": "polite" });
  private readonly counts = h("span", { class: "counts" });
  private readonly busy: HTMLElement;
  private busyTimer: ReturnType<typeof setTimeout> | null = null;

  constructor(document: Document) {
    const stop = button("Stop", () => document.kernel.restart("stopped by the user"), { title: "End what the kernel is doing and go back to the last good state" });
    this.busy = h("span", { class: "busy", hidden: true }, "Working… ", stop);
    this.element = h("footer", {}, this.counts, this.busy, this.list);
    document.on("said", ({ text, kind, line }) => this.say(text, kind, line ?? null));
    document.on("measured", (measures) => {
      const numbers = [measures.brushes, measures.faces, measures.triangles].map((value) => value.toLocaleString("en"));
      this.counts.textContent = `${numbers[0]} brushes · ${numbers[1]} faces · ${numbers[2]} triangles`;
    });
    document.kernel.onBusy = (isBusy) => this.setBusy(isBusy);
  }

  say(text: string, kind: "note" | "error", line: number | null) {
    const whole = line !== null && !text.includes(`:${line}`) ? `${text} (line ${line})` : text;
    const entry = h("p", { class: `message ${kind}`, ...(kind === "error" ? { role: "alert" } : {}) }, whole);
    entry.append(button("✕", () => entry.remove(), { title: "Close", "aria-label": "Close this message", class: "close" }));
    this.list.append(entry);
    while (this.list.children.length > 4) {
      this.list.firstChild?.remove();
    }
    if (kind === "note") {
      setTimeout(() => entry.remove(), NOTE);
    }
  }

  private setBusy(isBusy: boolean) {
    if (this.busyTimer !== null) {
      clearTimeout(this.busyTimer);
      this.busyTimer = null;
    }
    if (isBusy) {
      this.busyTimer = setTimeout(() => (this.busy.hidden = false), PATIENCE);
    } else {
      this.busy.hidden = true;
    }
  }
}
