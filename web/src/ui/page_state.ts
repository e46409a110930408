/** What is open, from where, and how it is seen: kept in the address of the page, and read from it when the page begins. */

import type { Document } from "../app/document";
import { sourceOfAddress, type ModelFile } from "../app/files";
import type { Edit } from "../kernel/protocol";
import type { Viewer } from "../view/viewer";
import { readAddress, writeAddress } from "./address";
import { exampleAddress } from "./gallery";
import type { LookPanel } from "./look";

/** What is shown where an address says nothing. */
const FIRST_EXAMPLE = "castle.json";

/** How long changes are gathered before the address follows, in milliseconds. */
const DELAY = 400;

/** The state of the page. */
export class PageState {
  private timer: ReturnType<typeof setTimeout> | null = null;

  constructor(
    private readonly document: Document,
    private readonly viewer: Viewer,
    private readonly look: LookPanel,
  ) {}

  /** Opens a model; says what is wrong where it cannot be opened. */
  async open(load: () => ModelFile | Promise<ModelFile>, edits: readonly Edit[] = []): Promise<boolean> {
    return this.document.attempt(async () => this.document.open(await load(), edits));
  }

  /** Writes the state into the address soon. */
  remember() {
    this.timer ??= setTimeout(() => void this.rememberNow(), DELAY);
  }

  /** Writes the state into the address; tells whether all of it fits. */
  async rememberNow(): Promise<boolean> {
    if (this.timer !== null) {
      clearTimeout(this.timer);
      this.timer = null;
    }
    const { document, viewer } = this;
    const { center, source } = document;
    const from = viewer.camera.position.toArray().map((value, k) => value + center[k]!);
    const to = viewer.controls.target.toArray().map((value, k) => value + center[k]!);
    const origin = source?.origin ?? {};
    const isOwn = source && !origin.file && !origin.example;
    return writeAddress({
      ...origin,
      ...(isOwn ? { source: { name: source.name, bytes: source.bytes } } : {}),
      parameters: source?.parameters ?? {},
      edits: [...document.edits],
      camera: [...from, ...to],
      look: this.look.state,
    });
  }

  /** Opens what the address says, or the first example. */
  async restore() {
    const { document, viewer } = this;
    const state = await readAddress();
    const parameters = state.parameters ?? {};
    let isOpen = false;
    if (state.file) {
      const { file } = state;
      // first, so that no change is missed
      this.watch(file);
      isOpen = await this.open(async () => ({ ...(await sourceOfAddress(file)), parameters }), state.edits);
    } else if (state.source) {
      const source = { ...state.source, parameters, origin: {} };
      isOpen = await this.open(() => source, state.edits);
    }
    if (!isOpen) {
      const isKnown = !state.file && !state.source && state.example !== undefined && exampleAddress(state.example) !== null;
      const example = isKnown ? state.example! : FIRST_EXAMPLE;
      const load = async () => ({ ...(await sourceOfAddress(exampleAddress(example)!, example)), parameters: isKnown ? parameters : {} });
      await this.open(load, isKnown ? state.edits : []);
    }
    if (state.look) {
      this.look.set(state.look);
    }
    if (state.camera) {
      const [x, y, z, u, v, w] = state.camera as [number, number, number, number, number, number];
      viewer.release();
      viewer.camera.position.copy(document.placed([x, y, z]));
      viewer.controls.target.copy(document.placed([u, v, w]));
      viewer.controls.update();
    }
    viewer.frame();
  }

  /** Opens the file again when the server says that it has changed; only `planecut view` does. */
  private watch(file: string) {
    if (!new URLSearchParams(location.search).has("file")) {
      return;
    }
    const events = new EventSource("/changes");
    events.addEventListener("change", () => {
      const hadEdits = this.document.edits.length > 0;
      const parameters = this.document.source?.parameters ?? {};
      void this.open(async () => ({ ...(await sourceOfAddress(file)), parameters })).then((isOpen) => {
        if (isOpen) {
          this.document.say(hadEdits ? "The file has changed and was read again; edits made here are gone." : "The file has changed and was read again.");
        }
      });
    });
  }
}
