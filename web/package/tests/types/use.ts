/** What a program in TypeScript says; it is compiled and not run. */

import { box, coarsen, init, Live, load, Mesh, Node, PlanecutError, type Preview, type Solid } from "planecut";
import { Editor } from "planecut/editor";

await init();
const solid: Solid = box([0, 0, 0], new Float32Array([1, 1, 1]), { material: "oak" });
using live = new Live(solid);
const plane: number = live.edit((edit) => edit.addPlane(0, [1, 1, 1, 2]));
const preview: Preview = live.preview.movePlane(0, plane, 1.5);
const positions: Float64Array = solid.mesh().positions;
const node: Node = live.edit((edit) => edit.wrap([0], "union"));
const { line, jsonPath } = new PlanecutError("found nothing, expected something");
const place: [number | null, string | null] = [line, jsonPath];
const excess: number = coarsen(new Mesh([[0, 0, 0]], []), { maxCells: 3, engine: "jolt" }).excess;
export const all = [preview.volumeChange, positions, node, place, excess, load("", "a.map").warnings, Editor];

// @ts-expect-error -- there is no such format
solid.encode("doc");
