/** Convex pieces of the solid: its cells, moved apart, or few cells around it. */

import { BufferAttribute, BufferGeometry, Color, Group, LineBasicMaterial, LineSegments, Mesh, Vector3, type Material } from "three";

import type { PieceArrays } from "../kernel/protocol";
import { faceMaterial } from "./materials";

/** A piece with its own middle. */
interface Piece {
  middle: Vector3;
  start: number;
  count: number;
}

/** Meshes in one geometry, each of a colour of its own. */
export class Pieces {
  readonly group = new Group();
  readonly count: number;
  private readonly pieces: Piece[] = [];
  private readonly places: Float32Array;
  private readonly position: BufferAttribute;
  private readonly middle = new Vector3();

  constructor(arrays: PieceArrays, opacity: number) {
    const corners = arrays.triangles.length;
    this.count = arrays.counts.length / 2;
    this.places = new Float32Array(3 * corners);
    const colors = new Uint8Array(4 * corners);
    const color = new Color();
    let [vertex, triangle, corner] = [0, 0, 0];
    for (let k = 0; k < this.count; k++) {
      const [vertices, triangles] = [arrays.counts[2 * k]!, arrays.counts[2 * k + 1]!];
      // hues that follow one another are far apart
      color.setHSL((k * 0.618033988749895) % 1, 0.55, 0.56);
      const bytes = [color.r, color.g, color.b, 1].map((channel) => Math.round(255 * channel));
      const piece = { middle: new Vector3(), start: corner, count: 3 * triangles };
      for (let i = 0; i < vertices; i++) {
        piece.middle.add(new Vector3().fromArray(arrays.positions, 3 * (vertex + i)));
      }
      piece.middle.divideScalar(Math.max(1, vertices));
      for (let i = 0; i < 3 * triangles; i++, corner++) {
        const from = 3 * (vertex + arrays.triangles[3 * triangle + i]!);
        this.places.set(arrays.positions.subarray(from, from + 3), 3 * corner);
        colors.set(bytes, 4 * corner);
      }
      this.pieces.push(piece);
      this.middle.add(piece.middle);
      vertex += vertices;
      triangle += triangles;
    }
    this.middle.divideScalar(Math.max(1, this.count));
    const geometry = new BufferGeometry();
    this.position = new BufferAttribute(this.places.slice(), 3);
    geometry.setAttribute("position", this.position);
    geometry.setAttribute("color", new BufferAttribute(colors, 4, true));
    geometry.computeVertexNormals();
    const edges = new BufferGeometry();
    edges.setAttribute("position", this.position);
    edges.setIndex(new BufferAttribute(outline(this.places), 1));
    const lines = new LineSegments(edges, new LineBasicMaterial({ color: 0x1b1f27, transparent: true, opacity: 0.6 }));
    const mesh = new Mesh(geometry, faceMaterial(opacity));
    mesh.frustumCulled = false;
    lines.frustumCulled = false;
    this.group.add(mesh, lines);
  }

  /** Moves the pieces away from the middle of all, by this much of their distance from it. */
  explode(amount: number) {
    const array = this.position.array as Float32Array;
    for (const { middle, start, count } of this.pieces) {
      const shift = [middle.x - this.middle.x, middle.y - this.middle.y, middle.z - this.middle.z];
      for (let k = 3 * start; k < 3 * (start + count); k++) {
        array[k] = this.places[k]! + amount * shift[k % 3]!;
      }
    }
    this.position.needsUpdate = true;
  }

  dispose() {
    this.group.removeFromParent();
    for (const child of this.group.children as (Mesh | LineSegments)[]) {
      child.geometry.dispose();
      (child.material as Material).dispose();
    }
  }
}

/** Segments where two triangles of different directions meet; corners at one place are the same. */
function outline(places: Float32Array): Uint32Array {
  const sides = new Map<string, { from: number; to: number; normal: Vector3; isSharp: boolean; count: number }>();
  const at = (corner: number) => new Vector3().fromArray(places, 3 * corner);
  const key = (corner: number) => `${places[3 * corner]},${places[3 * corner + 1]},${places[3 * corner + 2]}`;
  for (let corner = 0; corner < places.length / 3; corner += 3) {
    const [a, b, c] = [at(corner), at(corner + 1), at(corner + 2)];
    const normal = b.clone().sub(a).cross(c.sub(a)).normalize();
    for (let k = 0; k < 3; k++) {
      const [from, to] = [corner + k, corner + ((k + 1) % 3)];
      const [p, q] = [key(from), key(to)];
      const name = p < q ? `${p} ${q}` : `${q} ${p}`;
      const side = sides.get(name);
      if (!side) {
        sides.set(name, { from, to, normal, isSharp: false, count: 1 });
      } else {
        side.isSharp ||= side.normal.dot(normal) < 0.9999;
        side.count++;
      }
    }
  }
  const segments: number[] = [];
  for (const { from, to, isSharp, count } of sides.values()) {
    if (isSharp || count === 1) {
      segments.push(from, to);
    }
  }
  return new Uint32Array(segments);
}
