// The camera of planecut's previews, after the description in its sources (`export/src/preview/camera.rs`): looks from a
// given side, frames all vertices tightly with a margin. Coordinates are Z-up here.

const HALF_VIEW_TANGENT = 0.25;
const MAX_HALF_VIEW_TANGENT = 0.7;
const FILL = 0.88;
const MIN_DISTANCE = 0.1;
const CENTERING_STEPS = 2;

const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];

/**
 * Frames `points`, an array of x, y, z after one another. Gives the eye, where right and up are, half the view's tangents
 * each way, and the depths of the nearest and the farthest point.
 */
export function framing(points, { width, height, azimuth, elevation }) {
  const [min, max] = bounds(points);
  const center = min.map((low, axis) => (low + max[axis]) / 2);
  const radius = Math.hypot(...max.map((high, axis) => (high - min[axis]) / 2));
  const axes = viewAxes((azimuth * Math.PI) / 180, (elevation * Math.PI) / 180);
  const seen = inView(points, center, radius, axes);
  const pixel = Math.min(
    HALF_VIEW_TANGENT / (Math.min(width, height) / 2),
    MAX_HALF_VIEW_TANGENT / (Math.max(width, height) / 2),
  );
  const tangents = [(width / 2) * pixel, (height / 2) * pixel];
  const eye = framingEye(seen, tangents.map((tangent) => tangent * FILL));
  for (let step = 0; step < CENTERING_STEPS; step++) centerOn(seen, eye);
  const depths = [Infinity, -Infinity];
  for (let i = 2; i < seen.length; i += 3) {
    depths[0] = Math.min(depths[0], seen[i] - eye[2]);
    depths[1] = Math.max(depths[1], seen[i] - eye[2]);
  }
  return {
    eye: center.map((middle, i) => middle + radius * (axes[0][i] * eye[0] + axes[1][i] * eye[1] + axes[2][i] * eye[2])),
    axes,
    tangents,
    depths: depths.map((depth) => depth * radius),
  };
}

export function bounds(points) {
  const [min, max] = [Array(3).fill(Infinity), Array(3).fill(-Infinity)];
  for (let i = 0; i < points.length; i++) {
    min[i % 3] = Math.min(min[i % 3], points[i]);
    max[i % 3] = Math.max(max[i % 3], points[i]);
  }
  return [min, max];
}

/** Right, up and away from the eye. */
function viewAxes(azimuth, elevation) {
  const [ce, se, ca, sa] = [Math.cos(elevation), Math.sin(elevation), Math.cos(azimuth), Math.sin(azimuth)];
  return [[-sa, ca, 0], [-se * ca, -se * sa, ce], [-ce * ca, -ce * sa, -se]];
}

function inView(points, center, radius, axes) {
  const seen = new Float64Array(points.length);
  for (let i = 0; i < points.length; i += 3) {
    const from = [0, 1, 2].map((axis) => (points[i + axis] - center[axis]) / radius);
    for (let axis = 0; axis < 3; axis++) seen[i + axis] = dot(axes[axis], from);
  }
  return seen;
}

/** The eye that sees all points between four planes through it, tight for at least one of the two pairs. */
function framingEye(seen, tangents) {
  const support = [[-Infinity, -Infinity], [-Infinity, -Infinity]];
  let nearest = Infinity;
  for (let i = 0; i < seen.length; i += 3) {
    for (let axis = 0; axis < 2; axis++) {
      const shear = tangents[axis] * seen[i + 2];
      support[axis][0] = Math.max(support[axis][0], seen[i + axis] - shear);
      support[axis][1] = Math.max(support[axis][1], -seen[i + axis] - shear);
    }
    nearest = Math.min(nearest, seen[i + 2]);
  }
  const depths = support.map(([high, low], axis) => -(high + low) / (2 * tangents[axis]));
  const middles = support.map(([high, low]) => (high - low) / 2);
  return [...middles, Math.min(...depths, nearest - MIN_DISTANCE)];
}

/** Moves the eye sideways so that the outermost points each way are equally far from the middle. */
function centerOn(seen, eye) {
  const ends = [0, 1].map((axis) => {
    const [low, high] = [{ slope: Infinity }, { slope: -Infinity }];
    for (let i = 0; i < seen.length; i += 3) {
      const [across, depth] = [seen[i + axis] - eye[axis], seen[i + 2] - eye[2]];
      const slope = across / depth;
      if (slope < low.slope) Object.assign(low, { slope, across, depth });
      if (slope > high.slope) Object.assign(high, { slope, across, depth });
    }
    return [low, high];
  });
  ends.forEach(([low, high], axis) => {
    eye[axis] += (low.across * high.depth + high.across * low.depth) / (low.depth + high.depth);
  });
}
