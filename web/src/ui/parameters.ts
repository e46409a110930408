/** Parameters of a model file as sliders: each change builds the model again. */

import type { Document } from "../app/document";
import { field, h, numberInput, slider } from "./element";

/** The numbers that a model file names as parameters; expressions follow from others. */
export function parametersOf(text: string): Record<string, number> {
  try {
    const { parameters } = JSON.parse(text) as { parameters?: Record<string, unknown> };
    return Object.fromEntries(Object.entries(parameters ?? {}).filter((entry): entry is [string, number] => typeof entry[1] === "number"));
  } catch {
    return {};
  }
}

/** The panel of parameters. */
export class ParameterPanel {
  readonly element = h("div", { class: "parameters" });
  private running: Promise<void> | null = null;
  private wanted: Record<string, number> | null = null;

  constructor(private readonly document: Document) {
    document.on("opened", () => this.running || this.render());
    this.render();
  }

  private render() {
    const { source } = this.document;
    const stated = source?.name.endsWith(".json") ? parametersOf(new TextDecoder().decode(source.bytes)) : {};
    const names = Object.keys(stated);
    if (names.length === 0) {
      this.element.replaceChildren(h("p", { class: "note" }, "This model has no parameters. A model file can name some: \"parameters\": {\"width\": 40}."));
      return;
    }
    const rows = names.map((name) => {
      const value = source?.parameters[name] ?? stated[name]!;
      const isCount = Number.isInteger(stated[name]) && Math.abs(stated[name]!) < 64;
      const [low, high] = range(stated[name]!);
      const number = numberInput(value, (next) => {
        track.value = String(next);
        this.set(name, next);
      });
      const track = slider(low, high, value, (next) => {
        number.value = String(Number(next.toPrecision(5)));
        this.set(name, number.valueAsNumber);
      }, { step: isCount ? 1 : (high - low) / 400, "aria-label": name });
      return h("div", {}, field(name, number), track);
    });
    this.element.replaceChildren(h("p", { class: "note" }, "Edits of brushes are done again after each change, where they can be."), ...rows);
  }

  /** Builds the model with another value: the newest alone, where one comes before the last is built. */
  private set(name: string, value: number) {
    const { source } = this.document;
    this.wanted = { ...(this.wanted ?? source?.parameters), [name]: value };
    this.running ??= this.run();
  }

  private async run() {
    while (this.wanted) {
      const parameters = this.wanted;
      this.wanted = null;
      const { source, edits } = this.document;
      if (source) {
        await this.document.attempt(() => this.build({ ...source, parameters }, [...edits]));
      }
    }
    this.running = null;
  }

  private async build(source: NonNullable<Document["source"]>, edits: Parameters<Document["open"]>[1]) {
    try {
      await this.document.open(source, edits);
    } catch (error) {
      if (!edits?.length) {
        throw error;
      }
      // the edits may name brushes that are no more
      await this.document.open(source);
      this.document.say("With these parameters the edits of brushes cannot be done again: they are gone.");
    }
  }
}

/** From where to where a parameter slides. */
function range(value: number): [number, number] {
  if (value === 0) {
    return [-1, 1];
  }
  return value > 0 ? [Number.isInteger(value) && value < 64 ? 1 : value / 4, Math.max(value * 3, value + 4)] : [value * 3, 0];
}
