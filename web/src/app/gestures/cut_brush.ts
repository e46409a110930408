/** A brush that is cut by a line across the picture. */

import { Plane, Vector3, type Group } from "three";

import { discard, markedLine } from "../../view/overlays";
import type { Gesture, Scene } from "./gesture";

/** Cuts a brush by the plane through the camera and a line on the picture. */
export function cutBrush({ document, viewer, output }: Scene, event: PointerEvent, brush: number | null): Gesture {
  const start = viewer.rayAt(event.clientX, event.clientY);
  let mark: Group | null = null;
  const planeTo = (now: PointerEvent): Plane | null => {
    const end = viewer.rayAt(now.clientX, now.clientY);
    const normal = start.direction.clone().cross(end.direction);
    if (now.shiftKey) {
      straighten(normal);
    }
    if (normal.lengthSq() < 1e-12) {
      return null;
    }
    const depth = viewer.camera.position.distanceTo(viewer.controls.target);
    return new Plane().setFromNormalAndCoplanarPoint(normal.normalize(), start.at(depth, new Vector3()));
  };
  const erase = () => {
    discard(mark);
    mark = null;
  };
  return {
    move: (now) => {
      erase();
      const depth = 1.02 * viewer.camera.near;
      const ends = [start, viewer.rayAt(now.clientX, now.clientY)].map((ray) => ray.at(depth, new Vector3()));
      mark = markedLine(ends, 0, 0xff5a4e);
      viewer.overlay.add(mark);
      output.hint(brush === null ? "begin on a brush, or choose one" : "cut: what lies right of the line goes", now);
      viewer.draw();
    },
    end: (now) => {
      erase();
      viewer.draw();
      const plane = planeTo(now);
      if (brush === null || !plane) {
        document.say(brush === null ? "Choose a brush to cut, or begin the cut on one." : "The line is too short to cut along.");
        return;
      }
      const [x, y, z] = [plane.normal.x, plane.normal.y, plane.normal.z];
      const { center } = document;
      const offset = -plane.constant + x * center[0] + y * center[1] + z * center[2];
      void document.attempt(async () => {
        const answer = await document.edit({ op: "add_plane", brush, plane: [x, y, z, offset] });
        document.select({ brush, plane: answer.plane ?? null, face: null });
      });
    },
    cancel: erase,
  };
}

/** Turns a direction to the nearest axis. */
function straighten(direction: Vector3) {
  const sizes = direction.toArray().map(Math.abs);
  const axis = sizes.indexOf(Math.max(...sizes));
  const sign = Math.sign(direction.getComponent(axis)) || 1;
  direction.set(0, 0, 0).setComponent(axis, sign);
}
