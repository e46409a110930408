/** Meshes. */

import { Mesh as Raw } from "../wasm/planecut_web.js";

import { counts, flat, type Matrix, type Points } from "./arrays.js";
import { encodeText, type EncodeOptions, type MeshFormat } from "./encoding.js";
import { guarded } from "./kernel.js";

/** What the triangles of a mesh are made of. */
export interface MeshMaterials {
  /** The name of the material of all triangles. */
  material?: string;
  /** Names of several materials, instead of `material`. */
  materials?: readonly string[];
  /** The number of each triangle's material among `materials`. */
  materialIds?: ArrayLike<number>;
}

/** In the place of triangles: a mesh that the kernel has made. */
const OF_KERNEL = Symbol("of the kernel");

/** A mesh: that of a solid, or of your own triangles, whether they bound a solid or not. */
export class Mesh {
  /** @internal */
  readonly raw: Raw;
  readonly #known = new Map<string, unknown>();

  /**
   * A mesh of triangles. The arrays are copied.
   *
   * @param positions - x, y and z of each vertex, finite numbers.
   * @param triangles - Three numbers of vertices each, from 0, counter-clockwise seen from outside.
   * @param options - Materials.
   */
  constructor(positions: Points, triangles: ArrayLike<number> | ArrayLike<ArrayLike<number>>, options: MeshMaterials = {}) {
    if ((triangles as unknown) === OF_KERNEL) {
      this.raw = positions as unknown as Raw;
      return;
    }
    const { material, materials = [material ?? "default"], materialIds = [] } = options;
    const corners = counts(triangles, 3, "triangles");
    this.raw = guarded(() => new Raw(flat(positions, 3, "positions"), corners, [...materials], counts(materialIds, 1, "materialIds")));
  }

  /** @internal */
  static of(raw: Raw): Mesh {
    return new Mesh(raw as never, OF_KERNEL as never);
  }

  /** x, y and z of each vertex. All arrays of a mesh are copied out of the kernel once, when they are first asked for. */
  get positions(): Float64Array {
    return this.once("positions", () => this.raw.positions());
  }

  /** Three numbers of vertices of each triangle, counter-clockwise seen from outside. */
  get triangles(): Uint32Array {
    return this.once("triangles", () => this.raw.triangles());
  }

  /** The number of the face that each triangle belongs to: faces are planar, connected and of one material. */
  get faceIds(): Uint32Array {
    return this.once("faceIds", () => this.raw.faceIds());
  }

  /** The unit outward normal of each face: three numbers. */
  get faceNormals(): Float64Array {
    return this.once("faceNormals", () => this.raw.faceNormals());
  }

  /** The names of the materials. */
  get materials(): readonly string[] {
    return this.once("materials", () => this.raw.materials());
  }

  /** The number of each triangle's material among `materials`. */
  get materialIds(): Uint32Array {
    return this.once("materialIds", () => this.raw.materialIds());
  }

  /** The colours of the materials: linear red, green and blue from 0 to 1, NaN for those that have none of their own. */
  get materialColors(): Float64Array {
    return this.once("materialColors", () => this.raw.materialColors());
  }

  /** Whether every edge is used once in each direction, and the triangles around each vertex form one fan: a closed, oriented 2-manifold. */
  get isWatertight(): boolean {
    return this.once("isWatertight", () => this.raw.isWatertight());
  }

  /** The signed volume by the divergence theorem: that of the solid, where the mesh bounds one. */
  get volume(): number {
    return this.once("volume", () => this.raw.volume());
  }

  /** The area of all triangles. */
  get area(): number {
    return this.once("area", () => this.raw.area());
  }

  /** The least x, y and z of the vertices, and then the greatest; NaN where there are none. */
  get bounds(): Float64Array {
    return this.once("bounds", () => this.raw.bounds());
  }

  /**
   * What is wrong with the mesh: open edges, edges and vertices that are no manifold, triangles that cross others.
   *
   * @param tolerance - Depth up to which crossings count as touching, relative to the size of the mesh.
   * @returns Of each kind of problem the first; nothing if the mesh is sound.
   */
  check(tolerance = 1e-9): string[] {
    return guarded(() => this.raw.check(tolerance));
  }

  /** The mesh moved by an affine map; triangles are turned round where it mirrors. Vertices are rounded to doubles. */
  transform(matrix: Matrix): Mesh {
    return guarded(() => Mesh.of(this.raw.transform(flat(matrix, 4, "matrix"))));
  }

  /** The mesh as a file of a format. */
  encode(format: MeshFormat, options: EncodeOptions = {}): Uint8Array {
    return guarded(() => this.raw.encode(format, encodeText(options)));
  }

  /** Gives the memory back at once, instead of when the garbage collector comes by. Arrays that were asked for stay. */
  free(): void {
    this.raw.free();
  }

  /** As {@link free}, for `using`. */
  [Symbol.dispose](): void {
    this.free();
  }

  private once<T>(name: string, work: () => T): T {
    if (!this.#known.has(name)) {
      this.#known.set(name, guarded(work));
    }
    return this.#known.get(name) as T;
  }
}
