/** A plane that is turned. */

import { Quaternion, Vector3 } from "three";

import type { Hit } from "../../kernel/protocol";
import { PlaneMover } from "../plane_mover";
import type { Gesture, Scene } from "./gesture";

/** Steps of a plane that is turned with the shift key held, in radians. */
const TURN_STEP = Math.PI / 12;

/** Turns a plane about the place where it was taken hold of. */
export function turnPlane(scene: Scene, event: PointerEvent, hit: Hit, brush: number, plane: number): Gesture {
  const { document, viewer, output } = scene;
  const pivot = new Vector3(...hit.point);
  const mover = new PlaneMover(document, brush, plane, () => ({ grid: 0, planes: 0, vertices: 0 }));
  const from = { x: event.clientX, y: event.clientY };
  const right = new Vector3().setFromMatrixColumn(viewer.camera.matrixWorld, 0);
  const up = new Vector3().setFromMatrixColumn(viewer.camera.matrixWorld, 1);
  scene.choose(hit);
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
      output.hint(`${((yaw * 180) / Math.PI).toFixed(1)}° · ${((pitch * 180) / Math.PI).toFixed(1)}°`, now);
    },
    end: () => void mover.commit(),
    cancel: () => void mover.cancel(),
  };
}
