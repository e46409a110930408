/**
 * How flat faces and their edges are drawn: all corners of a face have its normal, so light and colour are worked out for each corner, and a pixel costs nothing but a store. Without a graphics card
 * that is half of a frame.
 */

import { Color, DoubleSide, FrontSide, ShaderMaterial, Vector3 } from "three";

/** A light from far away: where it is seen from the camera, and how bright. */
interface Light {
  direction: Vector3;
  intensity: number;
}

/** Lights move with the camera, so that no face that is seen is dark. */
const LIGHTS: Light[] = [
  { direction: new Vector3(0.6, 1, 1.2).normalize(), intensity: 0.54 },
  { direction: new Vector3(-1, -0.4, 0.2).normalize(), intensity: 0.16 },
];
/** What comes from all sides, from above and from below. */
const [AMBIENT, ABOVE, BELOW] = [0.11, new Color(0.35, 0.35, 0.35), new Color(0.047, 0.064, 0.086)];

/** As screens take colours: sRGB. */
const SHOWN = /* glsl */ `
vec3 shown(vec3 color) {
  vec3 bright = 1.055 * pow(color, vec3(0.41666)) - 0.055;
  return mix(bright, 12.92 * color, vec3(lessThanEqual(color, vec3(0.0031308))));
}
`;

/** Faces with a colour at each corner. What is clear lies over the solid, and is seen from both sides. */
export function faceMaterial(opacity = 1): ShaderMaterial {
  const isClear = opacity < 1;
  const uniforms = {
    opacity: { value: opacity },
    directions: { value: LIGHTS.map(({ direction }) => direction) },
    intensities: { value: LIGHTS.map(({ intensity }) => intensity) },
    above: { value: ABOVE },
    below: { value: BELOW },
  };
  return new ShaderMaterial({
    name: "faces",
    uniforms,
    vertexColors: true,
    clipping: true,
    side: isClear ? DoubleSide : FrontSide,
    transparent: isClear,
    depthWrite: !isClear,
    polygonOffset: true,
    polygonOffsetFactor: isClear ? -1 : 1,
    polygonOffsetUnits: isClear ? -1 : 1,
    vertexShader: /* glsl */ `
#include <clipping_planes_pars_vertex>
uniform vec3 directions[${LIGHTS.length}];
uniform float intensities[${LIGHTS.length}];
uniform vec3 above;
uniform vec3 below;
flat varying vec3 front;
flat varying vec3 back;
${SHOWN}
vec3 light(vec3 seen, float height) {
  vec3 sum = mix(below, above, 0.5 * height + 0.5) + ${AMBIENT};
  for (int k = 0; k < ${LIGHTS.length}; k++) {
    sum += max(0.0, dot(seen, directions[k])) * intensities[k];
  }
  return sum;
}

void main() {
  vec3 seen = normalize(normalMatrix * normal);
  front = shown(color.rgb * light(seen, normal.z));
  back = shown(color.rgb * light(-seen, -normal.z));
  #include <begin_vertex>
  #include <project_vertex>
  #include <clipping_planes_vertex>
}
`,
    fragmentShader: /* glsl */ `
#include <clipping_planes_pars_fragment>
uniform float opacity;
flat varying vec3 front;
flat varying vec3 back;

void main() {
  #include <clipping_planes_fragment>
  gl_FragColor = vec4(gl_FrontFacing ? front : back, opacity);
}
`,
  });
}

/** Lines of one colour, each with the normal of its face: where a face is seen from behind, its neighbour in front has the same line. */
export function edgeMaterial(opacity: number): ShaderMaterial {
  return new ShaderMaterial({
    name: "edges",
    uniforms: { line: { value: new Color() }, opacity: { value: opacity }, hasBack: { value: false } },
    clipping: true,
    transparent: true,
    vertexShader: /* glsl */ `
#include <clipping_planes_pars_vertex>
uniform bool hasBack;
void main() {
  #include <begin_vertex>
  #include <project_vertex>
  #include <clipping_planes_vertex>
  if (!hasBack && dot(normalMatrix * normal, mvPosition.xyz) > 0.0) {
    gl_Position = vec4(0.0, 0.0, 2.0, 1.0);
  }
}
`,
    fragmentShader: /* glsl */ `
#include <clipping_planes_pars_fragment>
uniform vec3 line;
uniform float opacity;

void main() {
  #include <clipping_planes_fragment>
  gl_FragColor = vec4(line, opacity);
}
`,
  });
}
