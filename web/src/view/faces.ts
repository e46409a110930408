/** The faces of the solid in buffers that are patched in place: an edit writes what it has changed, and nothing else is uploaded. */

import { Box3, BufferAttribute, BufferGeometry, Color, DynamicDrawUsage, Sphere, Vector3 } from "three";

import type { FaceArrays, MaterialEntry } from "../kernel/protocol";
import { Slots, type Slot } from "./slots";

/** A face as the page knows it. */
export interface Face {
  id: number;
  material: number;
  /** -1 for none. */
  brush: number;
  /** -1 for none. */
  plane: number;
  normal: [number, number, number];
  vertices: Slot;
  /** In numbers, three for each triangle. */
  triangles: Slot;
  /** In numbers, two for each segment. */
  outline: Slot;
}

/** How much larger a buffer becomes where it is full. */
const GROWTH = 1.5;

/** An attribute that grows, and the ranges within it. */
class Pool {
  slots: Slots;

  constructor(
    public capacity: number,
    private grown: (capacity: number) => void,
  ) {
    this.slots = new Slots(capacity);
  }

  take(count: number): Slot {
    let slot = this.slots.take(count);
    while (!slot) {
      this.capacity = Math.ceil(Math.max(this.capacity * GROWTH, this.slots.used + count));
      this.slots.grow(this.capacity);
      this.grown(this.capacity);
      slot = this.slots.take(count);
    }
    return slot;
  }
}

function grown<T extends Float32Array | Uint32Array | Uint8Array>(old: BufferAttribute, array: T, normalized = false): BufferAttribute {
  array.set(old.array as unknown as ArrayLike<number>);
  const next = new BufferAttribute(array, old.itemSize, normalized);
  next.setUsage(DynamicDrawUsage);
  return next;
}

/** Two geometries, of triangles and of outlines, that have their vertices in common. */
export class FaceStore {
  readonly surface = new BufferGeometry();
  readonly outlines = new BufferGeometry();
  readonly faces = new Map<number, Face>();
  private byBrush = new Map<number, Set<number>>();
  private vertices: Pool;
  private triangles: Pool;
  private segments: Pool;
  private colors: Color[] = [];
  private bounds = new Box3();
  private boundsAreExact = false;

  constructor(vertices = 1024) {
    this.vertices = new Pool(vertices, (count) => this.growVertices(count));
    this.triangles = new Pool(3 * vertices, (count) => this.growIndex(this.surface, count));
    this.segments = new Pool(2 * vertices, (count) => this.growIndex(this.outlines, count));
    const attribute = (array: Float32Array | Uint8Array, size: number, normalized = false) =>
      new BufferAttribute(array, size, normalized).setUsage(DynamicDrawUsage);
    this.setAttribute("position", attribute(new Float32Array(3 * vertices), 3));
    this.setAttribute("normal", attribute(new Float32Array(3 * vertices), 3));
    this.surface.setAttribute("color", attribute(new Uint8Array(4 * vertices), 4, true));
    this.surface.setIndex(new BufferAttribute(new Uint32Array(this.triangles.capacity), 1).setUsage(DynamicDrawUsage));
    this.outlines.setIndex(new BufferAttribute(new Uint32Array(this.segments.capacity), 1).setUsage(DynamicDrawUsage));
    // the renderer asks for it in every frame, and the model is nearly always in view
    const everything = new Sphere(new Vector3(), Infinity);
    this.surface.boundingSphere = everything;
    this.outlines.boundingSphere = everything;
  }

  /** The faces of a brush. */
  facesOf(brush: number): Iterable<number> {
    return this.byBrush.get(brush) ?? [];
  }

  setMaterials(materials: MaterialEntry[]) {
    this.colors = materials.map(({ color }) => new Color().setRGB(...color));
  }

  /** Takes faces out, then puts others in. */
  change(removed: Uint32Array | number[], added: FaceArrays) {
    for (const id of removed) {
      this.remove(id);
    }
    let [vertex, triangle, segment] = [0, 0, 0];
    for (let k = 0; k < added.ids.length; k++) {
      const [vertices, triangles, segments] = [added.counts[3 * k]!, added.counts[3 * k + 1]!, added.counts[3 * k + 2]!];
      this.add(added, k, [vertices, triangles, segments], [vertex, triangle, segment]);
      vertex += vertices;
      triangle += triangles;
      segment += segments;
    }
    this.surface.setDrawRange(0, this.triangles.slots.used);
    this.outlines.setDrawRange(0, this.segments.slots.used);
    this.boundsAreExact = false;
  }

  /** The box around all vertices, relative to the center. */
  box(): Box3 {
    if (!this.boundsAreExact) {
      this.bounds.makeEmpty();
      const position = this.surface.getAttribute("position");
      const point = new Vector3();
      for (const { vertices } of this.faces.values()) {
        for (let k = vertices.start; k < vertices.start + vertices.count; k++) {
          this.bounds.expandByPoint(point.fromBufferAttribute(position, k));
        }
      }
      this.boundsAreExact = true;
    }
    return this.bounds;
  }

  /** The places of the corners of a face's triangles, three numbers each. */
  trianglesOf(id: number): Float32Array {
    const face = this.faces.get(id);
    return face ? this.gather(this.surface, face.triangles) : new Float32Array();
  }

  /** The places of the ends of a face's outline, three numbers each. */
  outlineOf(id: number): Float32Array {
    const face = this.faces.get(id);
    return face ? this.gather(this.outlines, face.outline) : new Float32Array();
  }

  dispose() {
    this.surface.dispose();
    this.outlines.dispose();
  }

  private gather(geometry: BufferGeometry, { start, count }: Slot): Float32Array {
    const index = geometry.getIndex()!.array;
    const position = this.surface.getAttribute("position").array;
    const places = new Float32Array(3 * count);
    for (let k = 0; k < count; k++) {
      const from = 3 * index[start + k]!;
      places.set(position.subarray(from, from + 3), 3 * k);
    }
    return places;
  }

  private setAttribute(name: string, attribute: BufferAttribute) {
    this.surface.setAttribute(name, attribute);
    this.outlines.setAttribute(name, attribute);
  }

  private growVertices(count: number) {
    const old = (name: string) => this.surface.getAttribute(name) as BufferAttribute;
    const position = grown(old("position"), new Float32Array(3 * count));
    const normal = grown(old("normal"), new Float32Array(3 * count));
    const color = grown(old("color"), new Uint8Array(4 * count), true);
    // what the old ones hold on the graphics card goes with them
    this.surface.dispose();
    this.outlines.dispose();
    this.setAttribute("position", position);
    this.setAttribute("normal", normal);
    this.surface.setAttribute("color", color);
  }

  private growIndex(geometry: BufferGeometry, count: number) {
    const index = grown(geometry.getIndex()!, new Uint32Array(count));
    geometry.dispose();
    geometry.setIndex(index);
  }

  private remove(id: number) {
    const face = this.faces.get(id);
    if (!face) {
      return;
    }
    this.faces.delete(id);
    this.byBrush.get(face.brush)?.delete(id);
    this.vertices.slots.give(face.vertices);
    this.triangles.slots.give(face.triangles);
    this.segments.slots.give(face.outline);
    clear(this.surface, face.triangles);
    clear(this.outlines, face.outline);
  }

  private add(
    added: FaceArrays,
    k: number,
    [vertices, triangles, segments]: [number, number, number],
    [vertex, triangle, segment]: [number, number, number],
  ) {
    const normal: [number, number, number] = [added.normals[3 * k]!, added.normals[3 * k + 1]!, added.normals[3 * k + 2]!];
    const face: Face = {
      id: added.ids[k]!,
      material: added.materials[k]!,
      brush: added.sources[2 * k]!,
      plane: added.sources[2 * k + 1]!,
      normal,
      vertices: this.vertices.take(vertices),
      triangles: this.triangles.take(3 * triangles),
      outline: this.segments.take(2 * segments),
    };
    this.faces.set(face.id, face);
    let ofBrush = this.byBrush.get(face.brush);
    if (!ofBrush) {
      ofBrush = new Set();
      this.byBrush.set(face.brush, ofBrush);
    }
    ofBrush.add(face.id);
    const { start } = face.vertices;
    const position = this.surface.getAttribute("position") as BufferAttribute;
    (position.array as Float32Array).set(added.positions.subarray(3 * vertex, 3 * (vertex + vertices)), 3 * start);
    const normals = this.surface.getAttribute("normal") as BufferAttribute;
    const colors = this.surface.getAttribute("color") as BufferAttribute;
    const { r, g, b } = this.colors[face.material] ?? new Color(0.6, 0.6, 0.6);
    const color = [r, g, b, 1].map((channel) => Math.round(255 * channel));
    for (let corner = start; corner < start + vertices; corner++) {
      (normals.array as Float32Array).set(normal, 3 * corner);
      (colors.array as Uint8Array).set(color, 4 * corner);
    }
    for (const attribute of [position, normals, colors]) {
      update(attribute, start, vertices);
    }
    fill(this.surface, face.triangles, added.triangles.subarray(3 * triangle), start);
    fill(this.outlines, face.outline, added.outlines.subarray(2 * segment), start);
  }
}

/** Notes that a range of items is to be uploaded. */
function update(attribute: BufferAttribute, start: number, count: number) {
  attribute.addUpdateRange(start * attribute.itemSize, count * attribute.itemSize);
  attribute.needsUpdate = true;
}

function fill(geometry: BufferGeometry, { start, count }: Slot, from: Uint32Array, base: number) {
  const index = geometry.getIndex()!;
  for (let k = 0; k < count; k++) {
    (index.array as Uint32Array)[start + k] = from[k]! + base;
  }
  update(index, start, count);
}

/** Triangles and segments of one vertex are not seen. */
function clear(geometry: BufferGeometry, { start, count }: Slot) {
  const index = geometry.getIndex()!;
  (index.array as Uint32Array).fill(0, start, start + count);
  update(index, start, count);
}
