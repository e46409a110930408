/**
 * The kernel as a page's worker uses it: a model that messages and calls drive.
 *
 * @packageDocumentation
 */

export { Colliders, Edited, Editor, Faces, Pieces, simulateBug, version } from "../wasm/planecut_web.js";
export { init, memoryBytes } from "./kernel.js";
