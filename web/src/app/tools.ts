/** What the pointer does on the picture: choose, drag, turn, cut, measure. One tool is active at a time. */

import { Group, Matrix4, Plane, Quaternion, Vector3 } from "three";

import type { Hit, Snapping } from "../kernel/protocol";
import { Highlight, discard, markedLine } from "../view/overlays";
import type { Viewer } from "../view/viewer";
import type { Document } from "./document";
import { PlaneMover } from "./plane_mover";

export type ToolName = "select" | "turn" | "cut" | "measure";

/** How far the pointer goes before a click is a drag, in pixels. */
const CLICK = 4;

/** Within how many pixels planes and corners attract what is dragged. */
const ATTRACTION = 9;

/** Steps of a plane that is turned with the shift key held, in radians. */
const TURN_STEP = Math.PI / 12;

/** What is under way while a button is held. */
interface Gesture {
  move(event: PointerEvent): void;
  end(event: PointerEvent): void;
  cancel(): void;
}

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

/** The tools of the picture. */
export class Tools {
  active: ToolName = "select";
  readonly settings: ToolSettings = { grid: 0, snapsToPlanes: true };
  private readonly hover = new Highlight(0x4aa3ff, 0.18);
  private readonly chosen = new Highlight(0xff9d2e, 0.22);
  private readonly marks = new Group();
  private gesture: Gesture | null = null;
  private hovered: Hit | null = null;
  private isPicking = false;
  private nextPick: PointerEvent | null = null;
  private measuredPoints: { place: Vector3; normal: Vector3 }[] = [];

  /** Is called when another tool is active. */
  onTool: (name: ToolName) => void = () => {};

  constructor(
    private readonly document: Document,
    private readonly viewer: Viewer,
    private readonly output: ToolOutput,
  ) {
    viewer.overlay.add(this.hover.group, this.chosen.group, this.marks);
    const { canvas } = viewer;
    // before the camera's own listener, which would turn it
    canvas.addEventListener("pointerdown", (event) => this.down(event), { capture: true });
    canvas.addEventListener("pointermove", (event) => this.move(event));
    canvas.addEventListener("pointerup", (event) => this.up(event));
    canvas.addEventListener("pointercancel", () => this.cancel());
    canvas.addEventListener("pointerleave", () => this.setHover(null));
    document.on("selected", () => this.showSelection());
    document.on("changed", () => this.showSelection());
    document.on("opened", () => {
      this.setHover(null);
      this.clearMarks();
    });
  }

  /** Changes the tool. */
  use(name: ToolName) {
    this.cancel();
    this.clearMarks();
    this.active = name;
    this.viewer.canvas.dataset.tool = name;
    this.onTool(name);
    this.output.hint(null);
  }

  /** Ends what is under way, as if it had not begun. */
  cancel() {
    this.gesture?.cancel();
    this.gesture = null;
    this.viewer.controls.enabled = true;
    this.output.hint(null);
  }

  /** Whether something is dragged. */
  get isBusy(): boolean {
    return this.gesture !== null;
  }

  private down(event: PointerEvent) {
    if (event.button !== 0 || event.altKey || !event.isPrimary) {
      return;
    }
    if (this.active === "cut") {
      const { selection } = this.document;
      const brush = selection?.brush ?? this.hovered?.brush ?? null;
      this.begin(event, this.cut(event, brush));
      return;
    }
    const hit = this.hovered;
    if (!hit || hit.brush === null || hit.plane === null) {
      this.begin(event, this.click(event, null), true);
      return;
    }
    const { brush, plane } = hit;
    if (this.active === "measure") {
      this.begin(event, this.click(event, hit), true);
    } else if (this.active === "turn") {
      this.begin(event, this.turn(event, hit, brush, plane));
    } else {
      this.begin(event, this.dragFace(event, hit, brush, plane));
    }
  }

  private begin(event: PointerEvent, gesture: Gesture, movesCamera = false) {
    this.gesture = gesture;
    if (!movesCamera) {
      this.viewer.controls.enabled = false;
      this.viewer.canvas.setPointerCapture(event.pointerId);
    }
  }

  private move(event: PointerEvent) {
    if (this.gesture) {
      this.gesture.move(event);
    } else if (event.buttons === 0) {
      this.lookUnder(event);
    }
  }

  private up(event: PointerEvent) {
    const { gesture } = this;
    this.gesture = null;
    gesture?.end(event);
    this.viewer.controls.enabled = true;
    this.output.hint(null);
  }

  /** Asks what is under the pointer; the newest place alone while an answer is awaited. */
  private lookUnder(event: PointerEvent) {
    if (this.isPicking) {
      this.nextPick = event;
      return;
    }
    if (!this.document.source) {
      return;
    }
    this.isPicking = true;
    this.pickAt(event.clientX, event.clientY)
      .then((hit) => this.setHover(hit, event))
      .catch(() => this.setHover(null))
      .finally(() => {
        this.isPicking = false;
        const next = this.nextPick;
        this.nextPick = null;
        if (next && !this.gesture) {
          this.lookUnder(next);
        }
      });
  }

  /** The face at a place of the page; what the section has cut away is looked through. */
  async pickAt(x: number, y: number): Promise<Hit | null> {
    const { origin, direction } = this.viewer.rayAt(x, y);
    const cut = this.viewer.sectionPlane;
    if (cut && cut.distanceToPoint(origin) < 0) {
      const through = -cut.distanceToPoint(origin) / cut.normal.dot(direction);
      if (!(through > 0)) {
        return null;
      }
      origin.addScaledVector(direction, through);
    }
    const { center } = this.document;
    const from: [number, number, number] = [origin.x + center[0], origin.y + center[1], origin.z + center[2]];
    return this.document.pick(from, [direction.x, direction.y, direction.z]);
  }

  private setHover(hit: Hit | null, event?: PointerEvent) {
    this.hovered = hit;
    const { canvas } = this.viewer;
    canvas.dataset.over = hit ? "face" : "nothing";
    if (!hit) {
      this.hover.hide();
      this.output.hint(null);
    } else {
      this.hover.show(this.document.faces, [hit.face]);
      const face = this.document.faces.faces.get(hit.face);
      const entry = hit.brush === null ? undefined : this.document.brushes.get(hit.brush);
      const material = face && this.document.materials[face.material]?.name;
      const name = entry?.name ?? (hit.brush === null ? "no brush" : `brush ${hit.brush}`);
      this.output.hint(`${name} · plane ${hit.plane ?? "–"} · ${material ?? ""}`, event);
    }
    this.viewer.draw();
  }

  private showSelection() {
    const { selection, faces } = this.document;
    if (!selection) {
      this.chosen.hide();
    } else {
      const all = [...faces.facesOf(selection.brush)];
      const ofPlane = selection.plane === null ? all : all.filter((id) => faces.faces.get(id)?.plane === selection.plane);
      this.chosen.show(faces, ofPlane);
    }
    this.viewer.draw();
  }

  /** Chooses what is clicked, or nothing; measures with the tool for it. The camera turns where the pointer moves. */
  private click(event: PointerEvent, hit: Hit | null): Gesture {
    const from = { x: event.clientX, y: event.clientY };
    let moved = false;
    return {
      move: (now) => {
        moved ||= Math.hypot(now.clientX - from.x, now.clientY - from.y) > CLICK;
      },
      end: () => {
        if (moved) {
          return;
        }
        if (this.active === "measure" && hit) {
          this.measureAt(hit);
        } else {
          this.choose(hit);
        }
      },
      cancel: () => {},
    };
  }

  private choose(hit: Hit | null) {
    this.document.select(hit?.brush == null ? null : { brush: hit.brush, plane: hit.plane, face: hit.face });
  }

  /** A place relative to the center, as everything in the picture is. */
  private placed([x, y, z]: [number, number, number]): Vector3 {
    const { center } = this.document;
    return new Vector3(x - center[0], y - center[1], z - center[2]);
  }

  /** Follows a plane along its normal. */
  private dragFace(event: PointerEvent, hit: Hit, brush: number, plane: number): Gesture {
    const place = this.placed(hit.point);
    const mover = new PlaneMover(this.document, brush, plane, () => this.snapping(place));
    const from = { x: event.clientX, y: event.clientY };
    let isDrag = false;
    return {
      move: (now) => {
        if (!isDrag && Math.hypot(now.clientX - from.x, now.clientY - from.y) <= CLICK) {
          return;
        }
        if (!isDrag) {
          isDrag = true;
          this.choose(hit);
          this.hover.hide();
        }
        const { half } = mover;
        if (!half) {
          return;
        }
        const normal = new Vector3(half[0], half[1], half[2]);
        const length = normal.length();
        const nearest = nearestAlong(place, normal.normalize(), this.viewer.rayAt(now.clientX, now.clientY));
        if (nearest !== null) {
          // no more digits than the pointer has pixels
          const step = 10 ** Math.floor(Math.log10(this.viewer.pixelAt(place)));
          const offset = Number((Math.round((half[3] / length + nearest) / step) * step).toPrecision(12));
          const along = offset - half[3] / length;
          mover.to([half[0], half[1], half[2], offset * length]);
          this.output.hint(`${along >= 0 ? "+" : "−"}${Math.abs(along).toPrecision(4)}${mover.snapped ? ` · ${mover.snapped}` : ""}`, now);
        }
      },
      end: () => {
        if (isDrag) {
          void mover.commit();
        } else {
          this.choose(hit);
        }
      },
      cancel: () => void mover.cancel(),
    };
  }

  /** Turns a plane about the place where it was taken hold of. */
  private turn(event: PointerEvent, hit: Hit, brush: number, plane: number): Gesture {
    const pivot = new Vector3(...hit.point);
    const mover = new PlaneMover(this.document, brush, plane, () => ({ grid: 0, planes: 0, vertices: 0 }));
    const from = { x: event.clientX, y: event.clientY };
    const right = new Vector3().setFromMatrixColumn(this.viewer.camera.matrixWorld, 0);
    const up = new Vector3().setFromMatrixColumn(this.viewer.camera.matrixWorld, 1);
    this.choose(hit);
    return {
      move: (now) => {
        const { half } = mover;
        if (!half) {
          return;
        }
        const angle = (pixels: number) => {
          const radians = pixels * 0.008;
          return now.shiftKey ? Math.round(radians / TURN_STEP) * TURN_STEP : radians;
        };
        const [yaw, pitch] = [angle(now.clientX - from.x), angle(now.clientY - from.y)];
        const turned = new Quaternion().setFromAxisAngle(up, yaw).multiply(new Quaternion().setFromAxisAngle(right, pitch));
        const normal = new Vector3(half[0], half[1], half[2]).applyQuaternion(turned);
        mover.to([normal.x, normal.y, normal.z, normal.dot(pivot)]);
        this.output.hint(`${((yaw * 180) / Math.PI).toFixed(1)}° · ${((pitch * 180) / Math.PI).toFixed(1)}°`, now);
      },
      end: () => void mover.commit(),
      cancel: () => void mover.cancel(),
    };
  }

  /** Cuts a brush by the plane through the camera and a line on the picture. */
  private cut(event: PointerEvent, brush: number | null): Gesture {
    const start = this.viewer.rayAt(event.clientX, event.clientY);
    let mark: Group | null = null;
    const planeTo = (now: PointerEvent): Plane | null => {
      const end = this.viewer.rayAt(now.clientX, now.clientY);
      const normal = start.direction.clone().cross(end.direction);
      if (now.shiftKey) {
        straighten(normal);
      }
      if (normal.lengthSq() < 1e-12) {
        return null;
      }
      const depth = this.viewer.camera.position.distanceTo(this.viewer.controls.target);
      return new Plane().setFromNormalAndCoplanarPoint(normal.normalize(), start.at(depth, new Vector3()));
    };
    const erase = () => {
      discard(mark);
      mark = null;
    };
    return {
      move: (now) => {
        erase();
        const depth = 1.02 * this.viewer.camera.near;
        const ends = [start, this.viewer.rayAt(now.clientX, now.clientY)].map((ray) => ray.at(depth, new Vector3()));
        mark = markedLine(ends, 0, 0xff5a4e);
        this.viewer.overlay.add(mark);
        this.output.hint(brush === null ? "begin on a brush, or choose one" : "cut: what lies right of the line goes", now);
        this.viewer.draw();
      },
      end: (now) => {
        erase();
        this.viewer.draw();
        const plane = planeTo(now);
        if (brush === null || !plane) {
          this.document.say(brush === null ? "Choose a brush to cut, or begin the cut on one." : "The line is too short to cut along.");
          return;
        }
        const [x, y, z] = [plane.normal.x, plane.normal.y, plane.normal.z];
        const { center } = this.document;
        const offset = -plane.constant + x * center[0] + y * center[1] + z * center[2];
        void this.document.attempt(async () => {
          const answer = await this.document.edit({ op: "add_plane", brush, plane: [x, y, z, offset] });
          this.document.select({ brush, plane: answer.plane ?? null, face: null });
        });
      },
      cancel: erase,
    };
  }

  private measureAt(hit: Hit) {
    const face = this.document.faces.faces.get(hit.face);
    const place = this.nearestCorner(hit);
    this.measuredPoints.push({ place, normal: new Vector3(...(face?.normal ?? [0, 0, 1])) });
    if (this.measuredPoints.length > 2) {
      this.measuredPoints = this.measuredPoints.slice(-1);
    }
    const points = this.measuredPoints;
    discardChildren(this.marks);
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
    const place = this.placed(hit.point);
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

  private clearMarks() {
    this.measuredPoints = [];
    discardChildren(this.marks);
    this.viewer.draw();
  }

  private snapping(place: Vector3): Snapping {
    const near = this.settings.snapsToPlanes ? ATTRACTION * this.viewer.pixelAt(place) : 0;
    return { grid: this.settings.grid, planes: near, vertices: near };
  }
}

/** How far along a line through a place the point is that is nearest to a ray; nothing where the two are parallel. */
function nearestAlong(place: Vector3, direction: Vector3, ray: { origin: Vector3; direction: Vector3 }): number | null {
  const between = place.clone().sub(ray.origin);
  const cosine = direction.dot(ray.direction);
  const across = 1 - cosine * cosine;
  return across < 1e-6 ? null : (cosine * between.dot(ray.direction) - between.dot(direction)) / across;
}

/** Turns a direction to the nearest axis. */
function straighten(direction: Vector3) {
  const sizes = direction.toArray().map(Math.abs);
  const axis = sizes.indexOf(Math.max(...sizes));
  const sign = Math.sign(direction.getComponent(axis)) || 1;
  direction.set(0, 0, 0).setComponent(axis, sign);
}

function discardChildren(group: Group) {
  [...group.children].forEach((child) => discard(child));
}

/** Rows of a matrix, as edits have them. */
export function rowsOf(matrix: Matrix4): number[][] {
  const all = matrix.clone().transpose().toArray();
  return [all.slice(0, 4), all.slice(4, 8), all.slice(8, 12)];
}
