/** A plane that follows the pointer. */

import type { HalfSpace, Snapping } from "../kernel/protocol";
import type { Document } from "./document";

/** Moves a plane of a brush as one step: the newest place alone is asked for while an answer is awaited. */
export class PlaneMover {
  /** Where the plane was at first. */
  half: HalfSpace | null = null;
  snapped: string | null = null;
  private target: HalfSpace | null = null;
  private running: Promise<void> | null = null;
  private hasBegun = false;

  constructor(
    private readonly document: Document,
    private readonly brush: number,
    private readonly plane: number,
    private readonly snapping: () => Snapping,
  ) {
    document
      .halfSpace(brush, plane)
      .then((half) => (this.half = half))
      .catch((error: unknown) => document.fail(error));
  }

  to(target: HalfSpace) {
    this.target = target;
    this.running ??= this.run();
  }

  async commit() {
    await this.running;
    if (this.hasBegun) {
      await this.document.attempt(() => this.document.edit({ op: "commit" }));
    }
  }

  async cancel() {
    this.target = null;
    await this.running;
    if (this.hasBegun) {
      await this.document.attempt(() => this.document.edit({ op: "cancel" }));
    }
  }

  private async run() {
    try {
      if (!this.hasBegun) {
        await this.document.edit({ op: "begin" });
        this.hasBegun = true;
      }
      while (this.target) {
        const target = this.target;
        this.target = null;
        const { snapped } = await this.document.drag(this.brush, this.plane, target, this.snapping());
        this.snapped = snapped;
      }
    } catch (error) {
      this.document.fail(error);
    } finally {
      this.running = null;
    }
  }
}
