/** What is drawn over the solid: faces that are pointed at or selected, bodies that an edit would add, measured distances. */

import { BufferAttribute, BufferGeometry, DoubleSide, Group, Line, LineBasicMaterial, LineSegments, Mesh, MeshBasicMaterial, Object3D, Vector3 } from "three";

import type { FaceStore } from "./faces";

/** Draws some faces of the solid in one colour. */
export class Highlight {
  readonly group = new Group();
  private readonly fill: Mesh;
  private readonly outline: LineSegments;

  constructor(color: number, opacity: number) {
    const fill = new MeshBasicMaterial({ color, transparent: true, opacity, depthWrite: false, side: DoubleSide });
    fill.polygonOffset = true;
    fill.polygonOffsetFactor = -1;
    fill.polygonOffsetUnits = -1;
    this.fill = new Mesh(new BufferGeometry(), fill);
    this.outline = new LineSegments(new BufferGeometry(), new LineBasicMaterial({ color, depthTest: false, transparent: true }));
    this.fill.renderOrder = 2;
    this.outline.renderOrder = 3;
    this.fill.frustumCulled = false;
    this.outline.frustumCulled = false;
    this.group.add(this.fill, this.outline);
    this.group.visible = false;
  }

  show(faces: FaceStore, ids: Iterable<number>) {
    const [triangles, outlines]: [Float32Array[], Float32Array[]] = [[], []];
    for (const id of ids) {
      triangles.push(faces.trianglesOf(id));
      outlines.push(faces.outlineOf(id));
    }
    replace(this.fill, triangles);
    replace(this.outline, outlines);
    this.group.visible = triangles.length > 0;
  }

  hide() {
    this.group.visible = false;
  }
}

function replace(object: Mesh | LineSegments, parts: Float32Array[]) {
  const all = new Float32Array(parts.reduce((sum, part) => sum + part.length, 0));
  let at = 0;
  for (const part of parts) {
    all.set(part, at);
    at += part.length;
  }
  object.geometry.dispose();
  object.geometry = new BufferGeometry().setAttribute("position", new BufferAttribute(all, 3));
}

/** A body that is not there yet. */
export function ghost(positions: Float32Array, indices: Uint32Array, color: number): Group {
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(positions, 3));
  geometry.setIndex(new BufferAttribute(indices, 1));
  const material = new MeshBasicMaterial({ color, transparent: true, opacity: 0.4, depthWrite: false, side: DoubleSide });
  const wire = new MeshBasicMaterial({ color, wireframe: true, transparent: true, opacity: 0.5, depthTest: false });
  const group = new Group();
  group.add(new Mesh(geometry, material), new Mesh(geometry, wire));
  group.renderOrder = 4;
  return group;
}

/** A line through some places, with a mark at each. */
export function markedLine(places: Vector3[], size: number, color: number): Group {
  const group = new Group();
  const material = new LineBasicMaterial({ color, depthTest: false, transparent: true });
  const line = new Line(new BufferGeometry().setFromPoints(places), material);
  line.renderOrder = 5;
  group.add(line);
  const arms: Vector3[] = [];
  for (const place of places) {
    for (const axis of [new Vector3(size, 0, 0), new Vector3(0, size, 0), new Vector3(0, 0, size)]) {
      arms.push(place.clone().sub(axis), place.clone().add(axis));
    }
  }
  const marks = new LineSegments(new BufferGeometry().setFromPoints(arms), material);
  marks.renderOrder = 5;
  group.add(marks);
  return group;
}

/** Takes an object out of the picture, with what it holds on the graphics card. */
export function discard(object: Object3D | null) {
  object?.removeFromParent();
  object?.traverse((child) => {
    if (child instanceof Mesh || child instanceof Line) {
      child.geometry.dispose();
      (child.material as MeshBasicMaterial).dispose();
    }
  });
}
