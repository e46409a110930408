/** Brushes to begin with, as half-spaces. */

import type { HalfSpace } from "../kernel/protocol";

type Place = [number, number, number];

export const SHAPES = ["box", "cylinder", "wedge", "pyramid", "ball"] as const;

export type Shape = (typeof SHAPES)[number];

/** Number of sides of what is round. */
const SIDES = 24;

/** The half-spaces of a shape that fills a cube around a place. */
export function shapePlanes(shape: Shape, at: Place, size: number): HalfSpace[] {
  const half = size / 2;
  const through = ([x, y, z]: Place, offset: number): HalfSpace => [x, y, z, offset + x * at[0] + y * at[1] + z * at[2]];
  const around = (count: number, slope: number, offset: number) =>
    Array.from({ length: count }, (_, k) => {
      const angle = (2 * Math.PI * (k + 0.5)) / count;
      return through([Math.cos(angle), Math.sin(angle), slope], offset);
    });
  const [top, bottom] = [through([0, 0, 1], half), through([0, 0, -1], half)];
  const sides: HalfSpace[] = [through([1, 0, 0], half), through([-1, 0, 0], half), through([0, 1, 0], half), through([0, -1, 0], half)];
  switch (shape) {
    case "box":
      return [...sides, top, bottom];
    case "cylinder":
      return [...around(SIDES, 0, half), top, bottom];
    case "wedge":
      return [through([-1, 0, 0], half), through([0, 1, 0], half), through([0, -1, 0], half), bottom, through([1, 0, 1], 0)];
    case "pyramid":
      return [...[0, 1, 2, 3].map((k) => through([[1, 0, -1, 0][k]!, [0, 1, 0, -1][k]!, 0.5], half / 2)), bottom];
    case "ball":
      return ball(through, half);
  }
}

/** Planes that touch a sphere, in rings. */
function ball(through: (normal: Place, offset: number) => HalfSpace, radius: number): HalfSpace[] {
  const planes = [through([0, 0, 1], radius), through([0, 0, -1], radius)];
  const rings = 7;
  for (let ring = 1; ring < rings; ring++) {
    const polar = (Math.PI * ring) / rings;
    for (let k = 0; k < 12; k++) {
      const angle = (2 * Math.PI * k) / 12;
      planes.push(through([Math.sin(polar) * Math.cos(angle), Math.sin(polar) * Math.sin(angle), Math.cos(polar)], radius));
    }
  }
  return planes;
}
