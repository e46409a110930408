/** Keys of the page, and what turns the view. */

import { Spherical, Vector3 } from "three";

import type { Viewer } from "../view/viewer";
import { h } from "./element";

export interface Shortcut {
  /** As `aria-keyshortcuts` has it. */
  keys: string;
  text: string;
  action: () => void;
}

/** Radians that an arrow key turns the view. */
const TURN = Math.PI / 24;

const MOUSE: [string, string][] = [
  ["Click", "Choose a face and its brush"],
  ["Drag a face", "Move its plane along its normal"],
  ["Drag beside the solid, or with Alt", "Turn the view"],
  ["Right button, or two fingers", "Move the view"],
  ["Wheel, or pinch", "Nearer and away"],
  ["Arrow keys, + and − on the picture", "Turn the view; nearer and away"],
];

/** Listens for keys, and gives a table of them. */
export function shortcuts(all: Shortcut[], canvas: HTMLCanvasElement, viewer: Viewer): HTMLElement {
  const byKeys = new Map(all.map((shortcut) => [shortcut.keys.toLowerCase(), shortcut]));
  addEventListener("keydown", (event) => {
    const target = event.target as HTMLElement;
    const isTyped = target.closest("input:not([type=checkbox]):not([type=range]), textarea, select, [contenteditable=true], dialog[open]");
    if (isTyped && !(event.ctrlKey || event.metaKey) && event.key !== "Escape") {
      return;
    }
    if (isTyped && (event.ctrlKey || event.metaKey) && /^[zyacvx]$/i.test(event.key)) {
      // the text has a history of its own
      return;
    }
    const shortcut = byKeys.get(nameOf(event));
    if (shortcut && !target.closest("dialog[open]")) {
      event.preventDefault();
      shortcut.action();
    }
  });
  canvas.addEventListener("keydown", (event) => {
    if (turn(event.key, viewer)) {
      event.preventDefault();
      event.stopPropagation();
    }
  });
  const row = ([keys, text]: [string, string]) => h("tr", {}, h("td", {}, h("kbd", {}, keys)), h("td", {}, text));
  return h("table", {}, ...MOUSE.map(row), ...all.map(({ keys, text }) => row([keys, text])));
}

function nameOf(event: KeyboardEvent): string {
  const digit = /^Digit(\d)$/.exec(event.code)?.[1];
  const isShifted = event.shiftKey && (digit !== undefined || /^[a-z]$/i.test(event.key));
  const key = (isShifted && digit ? digit : event.key).toLowerCase();
  return [(event.ctrlKey || event.metaKey) && "control", isShifted && "shift", key].filter(Boolean).join("+");
}

/** Turns the view, or goes nearer or away; whether the key does. */
function turn(key: string, viewer: Viewer): boolean {
  const { camera, controls } = viewer;
  const from = camera.position.clone().sub(controls.target);
  // the vertical axis is z here, and y in three.js
  const sphere = new Spherical().setFromVector3(new Vector3(from.x, from.z, -from.y));
  const steps: Record<string, () => void> = {
    ArrowLeft: () => (sphere.theta -= TURN),
    ArrowRight: () => (sphere.theta += TURN),
    ArrowUp: () => (sphere.phi -= TURN),
    ArrowDown: () => (sphere.phi += TURN),
    "+": () => (sphere.radius /= 1.1),
    "=": () => (sphere.radius /= 1.1),
    "-": () => (sphere.radius *= 1.1),
  };
  const step = steps[key];
  if (!step) {
    return false;
  }
  viewer.release();
  step();
  const { x, y, z } = new Vector3().setFromSpherical(sphere.makeSafe());
  camera.position.copy(controls.target).add(new Vector3(x, -z, y));
  controls.update();
  viewer.draw();
  viewer.onCamera();
  return true;
}
