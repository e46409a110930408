/** What is under way while a button of the pointer is held. */

import type { Vector3 } from "three";

import type { Hit, Snapping } from "../../kernel/protocol";
import type { Viewer } from "../../view/viewer";
import type { Document } from "../document";

/** A press, what follows, and how it ends. */
export interface Gesture {
  move(event: PointerEvent): void;
  end(event: PointerEvent): void;
  cancel(): void;
}

/** How far the pointer goes before a click is a drag, in pixels. */
export const CLICK = 4;

/** Within how many pixels planes and corners attract what is dragged. */
export const ATTRACTION = 9;

/** Settings that tools look at. */
export interface ToolSettings {
  grid: number;
  snapsToPlanes: boolean;
}

/** A text beside the pointer, and what is measured. */
export interface ToolOutput {
  hint(text: string | null, event?: { clientX: number; clientY: number }): void;
  measured(text: string): void;
}

/** What gestures act on. */
export interface Scene {
  readonly document: Document;
  readonly viewer: Viewer;
  readonly output: ToolOutput;
  readonly settings: ToolSettings;
  /** Selects what was hit. */
  choose(hit: Hit | null): void;
}

/** What attracts a plane that is dragged at a place. */
export function snapping({ settings, viewer }: Scene, place: Vector3): Snapping {
  const near = settings.snapsToPlanes ? ATTRACTION * viewer.pixelAt(place) : 0;
  return { grid: settings.grid, planes: near, vertices: near };
}

/** Whether the pointer has gone further than a click. */
export function isFar(from: PointerEvent, to: PointerEvent): boolean {
  return Math.hypot(to.clientX - from.clientX, to.clientY - from.clientY) > CLICK;
}
