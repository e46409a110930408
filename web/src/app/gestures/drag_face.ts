/** A face that is dragged along its normal. */

import { Vector3 } from "three";

import type { Hit } from "../../kernel/protocol";
import { PlaneMover } from "../plane_mover";
import { isFar, snapping, type Gesture, type Scene } from "./gesture";

/** Follows a plane along its normal. */
export function dragFace(scene: Scene, event: PointerEvent, hit: Hit, brush: number, plane: number): Gesture {
  const { document, viewer, output } = scene;
  const place = document.placed(hit.point);
  const mover = new PlaneMover(document, brush, plane, () => snapping(scene, place));
  let isDrag = false;
  return {
    move: (now) => {
      if (!isDrag && !isFar(event, now)) {
        return;
      }
      if (!isDrag) {
        isDrag = true;
        scene.choose(hit);
      }
      const { half } = mover;
      if (!half) {
        return;
      }
      const normal = new Vector3(half[0], half[1], half[2]);
      const length = normal.length();
      const nearest = nearestAlong(place, normal.normalize(), viewer.rayAt(now.clientX, now.clientY));
      if (nearest !== null) {
        // no more digits than the pointer has pixels
        const step = 10 ** Math.floor(Math.log10(viewer.pixelAt(place)));
        const offset = Number((Math.round((half[3] / length + nearest) / step) * step).toPrecision(12));
        const along = offset - half[3] / length;
        mover.to([half[0], half[1], half[2], offset * length]);
        output.hint(`${along >= 0 ? "+" : "−"}${Math.abs(along).toPrecision(4)}${mover.snapped ? ` · ${mover.snapped}` : ""}`, now);
      }
    },
    end: () => {
      if (isDrag) {
        void mover.commit();
      } else {
        scene.choose(hit);
      }
    },
    cancel: () => void mover.cancel(),
  };
}

/** How far along a line through a place the point is that is nearest to a ray; nothing where the two are parallel. */
function nearestAlong(place: Vector3, direction: Vector3, ray: { origin: Vector3; direction: Vector3 }): number | null {
  const between = place.clone().sub(ray.origin);
  const cosine = direction.dot(ray.direction);
  const across = 1 - cosine * cosine;
  return across < 1e-6 ? null : (cosine * between.dot(ray.direction) - between.dot(direction)) / across;
}
