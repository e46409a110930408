/** What an edit would change, without doing it. */

import type { Live as Raw, Preview as RawPreview } from "../wasm/planecut_web.js";

import { guarded } from "./kernel.js";
import { Face } from "./live-faces.js";
import { messages } from "./messages.js";
import type { Solid } from "./solid.js";
import type { Role } from "./tree.js";

/** What an edit would change. */
export interface Preview {
  /** By how much the volume would grow; negative where it would shrink. */
  volumeChange: number;
  /** The numbers of the brushes that would come, go or change. */
  brushes: number[];
  /** The numbers of the faces that would be no more. */
  removed: Uint32Array;
  /** The faces that would be new. They have no numbers, and tell of no brush and no plane. */
  added: Face[];
}

type Messages = typeof messages;

/** The calls of an edit of which each is one message. */
type Calls = { [Name in keyof Messages]: (...args: Parameters<Messages[Name]>) => Preview };

/** The calls of an edit, each of which says what it would change instead of doing it; see {@link Live.preview}. */
export interface Previewer extends Calls {}

/** The calls of an edit, each of which says what it would change instead of doing it; see {@link Live.preview}. */
export class Previewer {
  readonly #raw: Raw;

  /** @internal */
  constructor(raw: Raw) {
    this.#raw = raw;
    for (const [name, message] of Object.entries(messages)) {
      const call = (...args: unknown[]) => previewed(() => this.#raw.preview(JSON.stringify((message as (...args: unknown[]) => unknown)(...args))));
      Object.defineProperty(this, name, { value: call });
    }
  }

  /** What `addBrush` would change. */
  addBrush(solid: Solid, role: Role = "add"): Preview {
    return previewed(() => this.#raw.previewAddBrush(solid.raw, role));
  }

  /** What `replaceBrush` would change. */
  replaceBrush(brush: number, solid: Solid): Preview {
    return previewed(() => this.#raw.previewReplaceBrush(brush, solid.raw));
  }
}

function previewed(work: () => RawPreview): Preview {
  return guarded(() => {
    const raw = work();
    const { volumeChange, brushes, removed, added } = raw;
    raw.free();
    return { volumeChange, brushes: Array.from(brushes), removed, added: added.map((face) => Face.of(face)) };
  });
}
