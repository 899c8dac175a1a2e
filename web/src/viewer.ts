// SPDX-License-Identifier: Apache-2.0
// The canvas in space: camera, light, picking, the ring that marks a place, clipping, pictures. Knows nothing of flows.
import {
  AmbientLight, Box3, DirectionalLight, type Mesh, MeshBasicMaterial, Mesh as ThreeMesh, type Object3D, PerspectiveCamera, Plane,
  Quaternion, Raycaster, Scene, TorusGeometry, Vector2, Vector3, WebGLRenderer,
} from "three";
import { TrackballControls } from "three/examples/jsm/controls/TrackballControls.js";
import { make } from "./dom";
import type { Vec } from "./model";
import type { Look } from "./views";

export interface Hit {
  place: Vec;
  mesh: Mesh;
  vertex: number; // the nearest corner of the triangle
}

const besideBar = 90; // pixels on the right that the colour bar takes
const fieldOfView = 22; // degrees: little perspective, as in an angiogram

export class Viewer {
  readonly root = make("div", { className: "canvas-host" });
  readonly plane = new Plane(new Vector3(0, 0, -1), 0);
  private readonly renderer: WebGLRenderer;
  private readonly scene = new Scene();
  private readonly camera = new PerspectiveCamera(fieldOfView, 1, 0.1, 5000);
  private readonly controls: TrackballControls;
  private readonly ring: Mesh;
  private readonly caster = new Raycaster();
  private content: Object3D[] = [];
  private targets: Mesh[] = [];
  private box = new Box3(new Vector3(-10, -10, -10), new Vector3(10, 10, 10));
  private isClipped = false;
  private isDue = false;

  /** Throws where there is no WebGL. */
  constructor(private readonly onHover: (hit: Hit | undefined) => void) {
    this.renderer = new WebGLRenderer({ antialias: true, alpha: true, preserveDrawingBuffer: true });
    this.renderer.setPixelRatio(Math.min(2, window.devicePixelRatio));
    this.renderer.localClippingEnabled = true;
    this.root.append(this.renderer.domElement);
    const lamp = new DirectionalLight(0xffffff, 0.5 * Math.PI);
    lamp.position.set(0.25, 0.35, 1);
    this.camera.add(lamp);
    this.scene.add(this.camera, new AmbientLight(0xffffff, 0.6 * Math.PI));
    this.ring = new ThreeMesh(new TorusGeometry(1, 0.07, 10, 48), new MeshBasicMaterial({ color: 0xd6336c, depthTest: false, transparent: true, opacity: 0.95 }));
    this.ring.renderOrder = 10;
    this.ring.visible = false;
    this.scene.add(this.ring);
    this.controls = new TrackballControls(this.camera, this.renderer.domElement);
    Object.assign(this.controls, { staticMoving: true, rotateSpeed: 3, zoomSpeed: 1.2, panSpeed: 0.6 });
    this.controls.addEventListener("change", () => this.draw());
    const follow = (): void => {
      this.controls.update(); // draws only what has changed
      requestAnimationFrame(follow);
    };
    requestAnimationFrame(follow);
    new ResizeObserver(() => this.fitCanvas()).observe(this.root);
    this.watchPointer();
  }

  /** What is seen, and which of it answers the pointer, the first first. */
  show(content: Object3D[], targets: Mesh[]): void {
    this.scene.remove(...this.content);
    this.content = content;
    this.targets = targets;
    if (content.length) this.scene.add(...content);
    const box = new Box3();
    for (const object of content) box.expandByObject(object);
    if (!box.isEmpty()) this.box = box;
    this.draw();
  }

  /** As it is turned, the whole in sight. */
  frame(): void {
    const toward = this.camera.position.clone().sub(this.controls.target).normalize();
    const up = this.camera.up.clone().addScaledVector(toward, -toward.dot(this.camera.up)).normalize();
    this.look({ toward: toward.toArray(), up: up.toArray() });
  }

  /** From a direction, the whole in sight. */
  look(look: Pick<Look, "toward" | "up">): void {
    const [toward, up] = [new Vector3(...look.toward), new Vector3(...look.up)];
    const right = up.clone().cross(toward);
    const [x, y, z] = [this.spread(right), this.spread(up), this.spread(toward)];
    this.controls.target.set(0, 0, 0).addScaledVector(right, x.middle).addScaledVector(up, y.middle).addScaledVector(toward, z.middle);
    const margin = 1.12;
    const { clientWidth: width, clientHeight: height } = this.root;
    const half = margin * Math.max(y.half, (x.half * height) / Math.max(width - besideBar, 1));
    this.controls.target.addScaledVector(right, (besideBar * half) / Math.max(height, 1));
    this.place(toward, up, half, z.half);
  }

  /** Comes near to a place without turning. */
  approach(place: Vec, radius: number): void {
    const toward = this.camera.position.clone().sub(this.controls.target).normalize();
    this.controls.target.set(...place);
    this.place(toward, this.camera.up.clone(), radius / Math.min(1, this.camera.aspect), 0);
  }

  mark(place: Vec | undefined, direction: Vec = [0, 0, 1], radius = 1): void {
    this.ring.visible = place !== undefined;
    if (place) {
      this.ring.position.set(...place);
      this.ring.quaternion.copy(new Quaternion().setFromUnitVectors(new Vector3(0, 0, 1), new Vector3(...direction)));
      this.ring.scale.setScalar(1.25 * radius);
    }
    this.root.dataset["mark"] = place ? place.map((x) => x.toFixed(3)).join(" ") : "";
    this.draw();
  }

  /** Cuts away what lies nearer to the eye than a share (0 to 1) of the vessel's depth, as seen when cutting began. */
  clip(isOn: boolean, share: number): void {
    if (isOn && !this.isClipped) this.plane.normal.copy(this.controls.target).sub(this.camera.position).normalize();
    this.isClipped = isOn;
    const { middle, half } = this.spread(this.plane.normal);
    this.plane.constant = isOn ? -middle + half * (1 - 2 * share) : Infinity;
    this.draw();
  }
  clippingPlanes(): Plane[] {
    return [this.plane];
  }

  /** The canvas as it is, on a background, for a file. */
  picture(background: string): HTMLCanvasElement {
    this.renderer.render(this.scene, this.camera);
    const canvas = make("canvas", { width: this.renderer.domElement.width, height: this.renderer.domElement.height });
    const context = canvas.getContext("2d")!;
    context.fillStyle = background;
    context.fillRect(0, 0, canvas.width, canvas.height);
    context.drawImage(this.renderer.domElement, 0, 0);
    return canvas;
  }

  draw(): void {
    if (this.isDue) return;
    this.isDue = true;
    requestAnimationFrame(() => {
      this.isDue = false;
      this.renderer.render(this.scene, this.camera);
    });
  }

  /** How far what is seen reaches along a direction. */
  private spread(axis: Vector3): { middle: number; half: number } {
    const places = this.sample().map((x) => x.dot(axis));
    const [low, high] = [Math.min(...places), Math.max(...places)];
    return { middle: (low + high) / 2, half: (high - low) / 2 };
  }

  /** Points of what is seen, enough to know how far it reaches. */
  private sample(): Vector3[] {
    const places: Vector3[] = [];
    for (const { geometry } of this.targets) {
      const positions = geometry.getAttribute("position");
      const every = Math.max(1, Math.floor(positions.count / 2000));
      for (let k = 0; k < positions.count; k += every) places.push(new Vector3().fromBufferAttribute(positions, k));
    }
    if (places.length === 0) places.push(this.box.min, this.box.max);
    return places;
  }

  /** `half`: the height in sight, halved; `depth`: how far what is seen reaches toward the eye [mm]. */
  private place(toward: Vector3, up: Vector3, half: number, depth: number): void {
    this.camera.up.copy(up);
    this.camera.position.copy(this.controls.target).addScaledVector(toward, depth + half / Math.tan((fieldOfView * Math.PI) / 360));
    this.camera.lookAt(this.controls.target);
    this.draw();
  }

  private fitCanvas(): void {
    const { clientWidth: width, clientHeight: height } = this.root;
    if (!width || !height) return;
    this.renderer.setSize(width, height);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    this.controls.handleResize();
    this.draw();
  }

  private watchPointer(): void {
    const canvas = this.renderer.domElement;
    let next: PointerEvent | undefined;
    canvas.addEventListener("pointermove", (event) => {
      if (!next) requestAnimationFrame(() => {
        this.onHover(next && next.buttons === 0 ? this.pick(next) : undefined);
        next = undefined;
      });
      next = event;
    });
    canvas.addEventListener("pointerleave", () => this.onHover(undefined));
  }

  private pick(event: PointerEvent): Hit | undefined {
    const box = this.renderer.domElement.getBoundingClientRect();
    const at = new Vector2(((event.clientX - box.left) / box.width) * 2 - 1, 1 - ((event.clientY - box.top) / box.height) * 2);
    this.caster.setFromCamera(at, this.camera);
    for (const mesh of this.targets)
      for (const { point, face } of this.caster.intersectObject(mesh, false)) {
        if (!face || (this.isClipped && this.plane.distanceToPoint(point) < 0)) continue;
        const positions = mesh.geometry.getAttribute("position");
        const apart = (corner: number): number => point.distanceTo(new Vector3().fromBufferAttribute(positions, corner));
        const vertex = [face.a, face.b, face.c].reduce((best, corner) => (apart(corner) < apart(best) ? corner : best));
        return { place: [point.x, point.y, point.z], mesh, vertex };
      }
    return undefined;
  }
}

