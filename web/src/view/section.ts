/** The cut face of a section: where the plane runs through the solid is told by counting what is in front and behind it in the stencil buffer. */

import {
  AlwaysStencilFunc,
  BackSide,
  BufferGeometry,
  DecrementWrapStencilOp,
  FrontSide,
  Group,
  IncrementWrapStencilOp,
  Mesh,
  MeshBasicMaterial,
  NotEqualStencilFunc,
  Plane,
  PlaneGeometry,
  ReplaceStencilOp,
  Vector3,
  type Side,
  type StencilOp,
} from "three";

const CAP_COLOR = 0xd98f4e;

/** The faces that a section plane cuts open. */
export class Section {
  readonly group = new Group();
  plane: Plane | null = null;
  private readonly cap: Mesh<PlaneGeometry, MeshBasicMaterial>;
  private readonly counters: Mesh<BufferGeometry, MeshBasicMaterial>[];

  constructor() {
    const counter = (side: Side, operation: StencilOp) => {
      const material = new MeshBasicMaterial({ side, depthWrite: false, depthTest: false, colorWrite: false });
      material.stencilWrite = true;
      material.stencilFunc = AlwaysStencilFunc;
      material.stencilFail = operation;
      material.stencilZFail = operation;
      material.stencilZPass = operation;
      const mesh = new Mesh(new BufferGeometry(), material);
      mesh.renderOrder = 1;
      mesh.frustumCulled = false;
      return mesh;
    };
    this.counters = [counter(BackSide, IncrementWrapStencilOp), counter(FrontSide, DecrementWrapStencilOp)];
    const material = new MeshBasicMaterial({ color: CAP_COLOR, side: 2, polygonOffset: true, polygonOffsetFactor: -1, polygonOffsetUnits: -1 });
    material.stencilWrite = true;
    material.stencilRef = 0;
    material.stencilFunc = NotEqualStencilFunc;
    material.stencilFail = ReplaceStencilOp;
    material.stencilZFail = ReplaceStencilOp;
    material.stencilZPass = ReplaceStencilOp;
    this.cap = new Mesh(new PlaneGeometry(1, 1), material);
    this.cap.renderOrder = 1.1;
    this.cap.onAfterRender = (renderer) => renderer.clearStencil();
    this.group.add(...this.counters, this.cap);
    this.group.visible = false;
  }

  /** Cuts another solid. */
  show(surface: BufferGeometry) {
    for (const counter of this.counters) {
      counter.geometry = surface;
    }
  }

  /** Cuts where a plane is; `null` for nowhere. */
  set(plane: Plane | null) {
    this.plane = plane;
    this.group.visible = plane !== null;
    for (const counter of this.counters) {
      counter.material.clippingPlanes = plane ? [plane] : [];
    }
  }

  /** Places the cut face so that it covers all within a distance of a place. */
  place(center: Vector3, radius: number) {
    if (!this.plane) {
      return;
    }
    this.plane.projectPoint(center, this.cap.position);
    this.cap.lookAt(this.cap.position.clone().add(this.plane.normal));
    this.cap.scale.setScalar(4 * radius);
  }
}
