/** Formats of files, and how they are written. */

/** The ending of the names of files of a mesh. */
export type MeshFormat = "glb" | "gltf" | "obj" | "stl" | "3mf" | "ply";

/** The ending of the names of files of a format: of meshes, of convex bodies (`map`, `csg`), or of all that a solid is made of (`json`, a model file). */
export type Format = MeshFormat | "map" | "csg" | "json";

/** How a file is written; each format takes what it has a place for. */
export interface EncodeOptions {
  /** Factor from the units of the model to those of the file. */
  scale?: number;
  /** What the lengths of the file are in: glTF and 3MF. */
  unit?: "micron" | "millimeter" | "centimeter" | "inch" | "foot" | "meter";
  /** Text instead of numbers as they are in memory: STL and PLY. */
  text?: boolean;
  /** Normals of vertices: one for each face, or those of faces that meet at no more than a crease angle, in degrees, joined: glTF, OBJ and PLY. */
  shading?: "flat" | { smooth: { crease: number } };
  /** Texture coordinates: how they follow from positions, and the length that a texture covers once: glTF, OBJ and PLY. */
  texture?: { projection: "source" | "box" | "planar"; size: number };
  /** Tangents, which need texture coordinates: glTF. */
  tangents?: boolean;
  /** Colours of vertices instead of materials: glTF. */
  vertexColors?: boolean;
  /** Positions in 16 bits, normals, tangents and colours in 8: glTF. */
  quantize?: boolean;
}

/**
 * Options as the kernel reads them, with its names.
 *
 * @internal
 */
export function encodeText(options: EncodeOptions): string {
  const named = Object.entries(options).map(([name, value]) => [name.replace(/[A-Z]/g, (letter) => `_${letter.toLowerCase()}`), value] as const);
  return JSON.stringify(Object.fromEntries(named));
}
