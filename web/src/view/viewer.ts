/** The picture: camera, the solid and what lies over it. It is drawn when something has changed, once a frame. */

import {
  Box3,
  Color,
  DoubleSide,
  FrontSide,
  Group,
  LinearSRGBColorSpace,
  LineSegments,
  Mesh,
  PerspectiveCamera,
  Plane,
  Ray,
  Raycaster,
  Scene,
  Vector2,
  Vector3,
  WebGLRenderer,
} from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";

import type { FaceStore } from "./faces";
import { edgeMaterial, faceMaterial } from "./materials";
import { Section } from "./section";

/** How the solid is drawn. */
export interface Look {
  edges: boolean;
  xray: boolean;
  solid: boolean;
}

const DARK_BACKGROUND = 0x16181d;
const LIGHT_BACKGROUND = 0xeef1f5;

/** Whether the browser draws without a graphics card: smooth edges take more than half of each frame then. */
function drawsInSoftware(): boolean {
  const context = document.createElement("canvas").getContext("webgl2");
  const names = context?.getExtension("WEBGL_debug_renderer_info");
  const name = context && names ? String(context.getParameter(names.UNMASKED_RENDERER_WEBGL)) : "";
  context?.getExtension("WEBGL_lose_context")?.loseContext();
  return /swiftshader|llvmpipe|software/i.test(name);
}

/** A view of a solid. */
export class Viewer {
  readonly renderer: WebGLRenderer;
  readonly scene = new Scene();
  readonly camera = new PerspectiveCamera(40, 1, 0.01, 1000);
  readonly controls: OrbitControls;
  /** What lies over the solid: selections, previews, measures. */
  readonly overlay = new Group();
  readonly section = new Section();
  /** Milliseconds that drawing took, of the last frames; the newest last. */
  readonly drawTimes: number[] = [];
  /** Is called before each frame that is drawn. */
  onFrame: () => void = () => {};
  /** Is called when the user has moved the camera. */
  onCamera: () => void = () => {};

  private surface: Mesh | null = null;
  private edges: LineSegments | null = null;
  private readonly material = faceMaterial();
  private readonly edgeMaterial = edgeMaterial(0.55);
  private readonly raycaster = new Raycaster();
  private look: Look = { edges: true, xray: false, solid: true };
  private isAsked = false;
  /** The box that all of the picture was fitted to, until somebody moves the camera. */
  private fitted: Box3 | null = null;
  private readonly isSoftware = drawsInSoftware();

  constructor(readonly canvas: HTMLCanvasElement) {
    this.renderer = new WebGLRenderer({ canvas, antialias: !this.isSoftware, stencil: true });
    this.renderer.localClippingEnabled = true;
    this.camera.up.set(0, 0, 1);
    this.camera.position.set(3, -4, 2.5);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.addEventListener("change", () => this.draw());
    this.controls.addEventListener("start", () => this.release());
    this.controls.addEventListener("end", () => this.onCamera());
    this.scene.add(this.camera, this.overlay, this.section.group);
    new ResizeObserver(() => this.resize()).observe(canvas.parentElement ?? canvas);
    this.setTheme(false);
    this.resize();
  }

  setTheme(isDark: boolean) {
    this.scene.background = new Color(isDark ? DARK_BACKGROUND : LIGHT_BACKGROUND);
    // as it is shown: the shader takes it as it is
    this.edgeMaterial.uniforms.line!.value.setHex(isDark ? 0x0b0c0f : 0x20242c, LinearSRGBColorSpace);
    this.draw();
  }

  /** Shows the faces of another model. */
  show(faces: FaceStore) {
    for (const old of [this.surface, this.edges]) {
      old?.removeFromParent();
    }
    this.surface = new Mesh(faces.surface, this.material);
    this.edges = new LineSegments(faces.outlines, this.edgeMaterial);
    this.surface.frustumCulled = false;
    this.edges.frustumCulled = false;
    this.scene.add(this.surface, this.edges);
    this.section.show(faces.surface);
    this.setLook(this.look);
  }

  setLook(look: Look) {
    this.look = look;
    if (this.surface && this.edges) {
      this.surface.visible = look.solid;
      this.edges.visible = look.edges && look.solid;
    }
    this.material.transparent = look.xray;
    this.material.uniforms.opacity!.value = look.xray ? 0.28 : 1;
    this.material.depthWrite = !look.xray;
    this.setSides();
    this.draw();
  }

  /** Cuts the picture open by a plane; `null` shows all of it. */
  setSection(plane: Plane | null) {
    this.section.set(plane);
    const planes = plane ? [plane] : [];
    this.material.clippingPlanes = planes;
    this.edgeMaterial.clippingPlanes = planes;
    this.edgeMaterial.needsUpdate = true;
    this.setSides();
    this.draw();
  }

  /** Faces are seen from behind, and their edges, where the solid is clear or cut open. */
  private setSides() {
    const hasBack = this.look.xray || this.section.plane !== null;
    this.material.side = hasBack ? DoubleSide : FrontSide;
    this.material.needsUpdate = true;
    this.edgeMaterial.uniforms.hasBack!.value = hasBack;
  }

  /** The plane that the picture is cut open by. */
  get sectionPlane(): Plane | null {
    return this.section.plane;
  }

  /** Moves the camera so that a box is in view, from where it looks now. */
  fit(box: Box3) {
    const [center, size] = [new Vector3(), new Vector3()];
    if (box.isEmpty()) {
      return;
    }
    this.fitted = box.clone();
    box.getCenter(center);
    const radius = Math.max(box.getSize(size).length() / 2, 1e-6);
    const direction = this.camera.position.clone().sub(this.controls.target).normalize();
    this.setReach(radius);
    this.controls.target.copy(center);
    this.camera.position.copy(center).add(direction);
    this.camera.lookAt(center);
    const [right, up] = [0, 1].map((axis) => new Vector3().setFromMatrixColumn(this.camera.matrix, axis));
    // as near as all corners allow
    const tangent = Math.tan((this.camera.fov * Math.PI) / 360);
    let distance = 0;
    for (let k = 0; k < 8; k++) {
      const corner = new Vector3(k & 1 ? box.max.x : box.min.x, k & 2 ? box.max.y : box.min.y, k & 4 ? box.max.z : box.min.z).sub(center);
      const across = Math.max(Math.abs(corner.dot(right!)) / this.camera.aspect, Math.abs(corner.dot(up!)));
      distance = Math.max(distance, across / tangent + corner.dot(direction));
    }
    this.camera.position.copy(center).addScaledVector(direction, 1.06 * distance);
    this.controls.update();
    this.draw();
  }

  /** From now on the camera stays where it is, whatever the size of the picture. */
  release() {
    this.fitted = null;
  }

  /** Looks from a direction at what is in view. */
  lookFrom(direction: Vector3) {
    this.release();
    const distance = this.camera.position.distanceTo(this.controls.target);
    this.camera.position.copy(this.controls.target).addScaledVector(direction.clone().normalize(), distance);
    this.controls.update();
    this.draw();
    this.onCamera();
  }

  /** The depth range for a model of a radius. */
  setReach(radius: number) {
    this.camera.near = radius / 500;
    this.camera.far = radius * 60;
    this.camera.updateProjectionMatrix();
  }

  /** The ray from the camera through a place of the canvas, in pixels. */
  rayAt(x: number, y: number): Ray {
    const { left, top, width, height } = this.canvas.getBoundingClientRect();
    const place = new Vector2((2 * (x - left)) / width - 1, 1 - (2 * (y - top)) / height);
    this.raycaster.setFromCamera(place, this.camera);
    return this.raycaster.ray.clone();
  }

  /** Where a place is on the page, in pixels. */
  onPage(place: Vector3): { x: number; y: number } {
    const { left, top, width, height } = this.canvas.getBoundingClientRect();
    const projected = place.clone().project(this.camera);
    return { x: left + ((projected.x + 1) / 2) * width, y: top + ((1 - projected.y) / 2) * height };
  }

  /** How long a pixel is at a place. */
  pixelAt(place: Vector3): number {
    const distance = this.camera.position.distanceTo(place);
    return (2 * distance * Math.tan((this.camera.fov * Math.PI) / 360)) / Math.max(1, this.canvas.clientHeight);
  }

  /** Asks for a frame. */
  draw() {
    if (!this.isAsked) {
      this.isAsked = true;
      requestAnimationFrame(() => this.frame());
    }
  }

  /** Draws now. */
  frame() {
    this.isAsked = false;
    this.onFrame();
    const begin = performance.now();
    this.renderer.render(this.scene, this.camera);
    this.drawTimes.push(performance.now() - begin);
    if (this.drawTimes.length > 600) {
      this.drawTimes.shift();
    }
  }

  private resize() {
    const { clientWidth: width, clientHeight: height } = this.canvas.parentElement ?? this.canvas;
    if (width === 0 || height === 0) {
      return;
    }
    this.renderer.setPixelRatio(this.isSoftware ? 1 : Math.min(2, devicePixelRatio));
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    if (this.fitted) {
      this.fit(this.fitted);
    }
    this.frame();
  }
}
