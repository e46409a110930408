/** Distances and angles between places that are clicked. */

import { Group, Vector3 } from "three";

import type { Hit } from "../kernel/protocol";
import { discard, markedLine } from "../view/overlays";
import type { Viewer } from "../view/viewer";
import type { Document } from "./document";
import { ATTRACTION, type ToolOutput } from "./gestures/gesture";

/** Two places, and the marks on them. */
export class Measuring {
  readonly marks = new Group();
  private points: { place: Vector3; normal: Vector3 }[] = [];

  constructor(
    private readonly document: Document,
    private readonly viewer: Viewer,
    private readonly output: ToolOutput,
  ) {}

  /** Forgets the places. */
  clear() {
    this.points = [];
    this.erase();
    this.viewer.draw();
  }

  /** Takes the place that was clicked: after the second one there is a distance. */
  add(hit: Hit) {
    const face = this.document.faces.faces.get(hit.face);
    const place = this.nearestCorner(hit);
    this.points.push({ place, normal: new Vector3(...(face?.normal ?? [0, 0, 1])) });
    if (this.points.length > 2) {
      this.points = this.points.slice(-1);
    }
    const { points } = this;
    this.erase();
    this.marks.add(markedLine(points.map((point) => point.place), 5 * this.viewer.pixelAt(place), 0xffd54a));
    this.viewer.draw();
    const [first, second] = points;
    if (first && second) {
      const between = second.place.clone().sub(first.place);
      const angle = (Math.acos(Math.min(1, Math.max(-1, first.normal.dot(second.normal)))) * 180) / Math.PI;
      const [dx, dy, dz] = between.toArray().map((value) => value.toPrecision(6));
      this.output.measured(`Distance ${between.length().toPrecision(7)} (x ${dx}, y ${dy}, z ${dz}) · angle between the faces ${angle.toFixed(3)}°`);
    } else {
      this.output.measured("Click a second place.");
    }
  }

  /** The corner of the face near the pointer, or the place itself. */
  private nearestCorner(hit: Hit): Vector3 {
    const place = this.document.placed(hit.point);
    const corners = this.document.faces.outlineOf(hit.face);
    let nearest = ATTRACTION * this.viewer.pixelAt(place);
    let found = place;
    for (let k = 0; k < corners.length; k += 3) {
      const corner = new Vector3().fromArray(corners, k);
      const distance = corner.distanceTo(place);
      if (distance < nearest) {
        [nearest, found] = [distance, corner];
      }
    }
    return found;
  }

  private erase() {
    [...this.marks.children].forEach((child) => discard(child));
  }
}
