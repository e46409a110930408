// In the browser: `show` loads an asset, draws it as planecut's previews see it, and tells what three.js made of it.

import * as THREE from "three";
import { GLTFLoader } from "three/addons/loaders/GLTFLoader.js";
import { MeshoptDecoder } from "three/addons/libs/meshopt_decoder.module.js";
import { bounds, framing } from "./camera.js";

const loader = new GLTFLoader().setMeshoptDecoder(MeshoptDecoder);
const renderer = new THREE.WebGLRenderer({ alpha: true, antialias: false, preserveDrawingBuffer: true });
renderer.setClearColor(0x000000, 0);
document.body.append(renderer.domElement);

globalThis.show = async (options) => {
  const { scene } = await loader.loadAsync(options.url);
  scene.updateMatrixWorld(true);
  const meshes = [];
  scene.traverse((object) => object.isMesh && meshes.push(object));
  const points = worldPoints(meshes);
  draw(scene, usedPoints(meshes, points), options);
  const facts = { meshes: meshes.length, ...surfaceFacts(meshes, points, options.sliver), ...contents(meshes) };
  meshes.forEach((mesh) => mesh.geometry.dispose());
  return facts;
};

/** All vertices of each mesh where they are in the world, Z-up, in double precision. */
function worldPoints(meshes) {
  return meshes.map(({ geometry, matrixWorld }) => {
    const position = geometry.getAttribute("position");
    const points = new Float64Array(3 * position.count);
    const point = new THREE.Vector3();
    for (let i = 0; i < position.count; i++) {
      point.fromBufferAttribute(position, i).applyMatrix4(matrixWorld);
      points.set([point.x, -point.z, point.y], 3 * i);
    }
    return points;
  });
}

function cornersOf({ geometry }) {
  return geometry.index ? geometry.index.array : Uint32Array.from({ length: geometry.attributes.position.count }, (_, i) => i);
}

/** All points that triangles use: those of a mesh's other primitives may share its vertices. */
function usedPoints(meshes, points) {
  const used = meshes.map((mesh, number) => {
    const corners = [...new Set(cornersOf(mesh))];
    return Float64Array.from(corners.flatMap((corner) => [...points[number].subarray(3 * corner, 3 * corner + 3)]));
  });
  const all = new Float64Array(used.reduce((sum, part) => sum + part.length, 0));
  used.reduce((start, part) => (all.set(part, start), start + part.length), 0);
  return all;
}

function draw(scene, points, options) {
  renderer.setSize(options.width, options.height);
  if (points.length === 0) return renderer.clear();
  const { eye, axes, tangents, depths } = framing(points, options);
  const near = depths[0] * 0.99;
  const [right, top] = tangents.map((tangent) => tangent * near);
  const camera = new THREE.PerspectiveCamera();
  camera.projectionMatrix.makePerspective(-right, right, top, -top, near, depths[1] * 1.01);
  camera.projectionMatrixInverse.copy(camera.projectionMatrix).invert();
  const yUp = ([x, y, z]) => new THREE.Vector3(x, z, -y);
  const [x, y, away] = axes.map(yUp);
  camera.matrixAutoUpdate = false;
  camera.matrix.makeBasis(x, y, away.negate()).setPosition(yUp(eye));
  const light = new THREE.DirectionalLight(0xffffff, 2);
  light.position.copy(new THREE.Vector3().addScaledVector(x, -0.6).addScaledVector(y, 1).add(away));
  scene.add(light, new THREE.HemisphereLight(0xffffff, 0x777777, 1.5));
  scene.updateMatrixWorld(true);
  camera.updateMatrixWorld(true);
  renderer.render(scene, camera);
}

/**
 * Triangles, enclosed volume, bounds, and the part of the area whose corners' normals look away from the side that the
 * triangle's winding says is outside; triangles of no more than the height of a sliver may face either way.
 */
function surfaceFacts(meshes, points, sliver) {
  let [triangles, volume, area, against] = [0, 0, 0, 0];
  const box = bounds(usedPoints(meshes, points));
  const middle = box[0].map((low, axis) => (low + box[1][axis]) / 2);
  const at = [0, 1, 2].map(() => new THREE.Vector3());
  const [edge, cross, normal] = [0, 1, 2].map(() => new THREE.Vector3());
  meshes.forEach((mesh, number) => {
    const [corners, normals] = [cornersOf(mesh), mesh.geometry.getAttribute("normal")];
    const toWorld = new THREE.Matrix3().getNormalMatrix(mesh.matrixWorld);
    for (let i = 0; i < corners.length; i += 3) {
      at.forEach((point, k) => point.fromArray(points[number], 3 * corners[i + k]).sub(new THREE.Vector3(...middle)));
      triangles += 1;
      volume += at[0].dot(cross.crossVectors(at[1], at[2])) / 6;
      cross.subVectors(at[1], at[0]).cross(edge.subVectors(at[2], at[0]));
      const size = cross.length() / 2;
      area += size;
      const looksAway = (k) => {
        normal.fromBufferAttribute(normals, corners[i + k]).applyMatrix3(toWorld);
        return normal.x * cross.x - normal.z * cross.y + normal.y * cross.z <= 0;
      };
      const longest = Math.max(...[0, 1, 2].map((k) => at[k].distanceTo(at[(k + 1) % 3])));
      if (normals && 2 * size > sliver * longest && [0, 1, 2].some(looksAway)) against += size;
    }
  });
  return { triangles, volume, area, box: triangles ? box : null, normals_against: area ? against / area : 0 };
}

/** Attributes that all meshes have, with the type of their numbers, and materials by name. */
function contents(meshes) {
  const attributes = {};
  for (const { geometry } of meshes) {
    for (const [name, attribute] of Object.entries(geometry.attributes)) {
      const numbers = attribute.isInterleavedBufferAttribute ? attribute.data.array : attribute.array;
      const type = `${numbers.constructor.name.replace("Array", "")}×${attribute.itemSize}`;
      (attributes[name] ??= { type, meshes: 0 }).meshes += 1;
    }
  }
  const everywhere = Object.entries(attributes).filter(([, { meshes: count }]) => count === meshes.length);
  const materials = [...new Set(meshes.map(({ material }) => material.name))];
  return {
    attributes: Object.fromEntries(everywhere.map(([name, { type }]) => [name, type])),
    materials,
    textures: meshes.filter(({ material }) => material.map).length,
  };
}
