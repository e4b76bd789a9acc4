// Picture of one run: camera, scene (created when visible), and rotation by the user. One WebGL context draws all runs,
// since browsers allow few (16) and drop the oldest; each picture is copied to its own canvas.
import * as three from "three";
import { TrackballControls } from "three/examples/jsm/controls/TrackballControls.js";
import { annotate } from "./annotations";
import { element } from "./dom";
import { EmbryoScene } from "./embryo_scene";
import type { PageData } from "./page_data";
import type { Run } from "./run";
import { type RunLooks, sampleOf } from "./run_looks";
import type { State } from "./state";
import { time as timeText } from "./text";

// Without a graphics card the processor draws, and antialiasing takes half of the time: it is off while the picture moves;
// a still picture is drawn with four times the pixels instead.
function drawsInSoftware(): boolean {
  const context = document.createElement("canvas").getContext("webgl2");
  const names = context?.getExtension("WEBGL_debug_renderer_info");
  const renderer = names ? String(context!.getParameter(names.UNMASKED_RENDERER_WEBGL)) : "";
  context?.getExtension("WEBGL_lose_context")?.loseContext();
  return /swiftshader|llvmpipe|software|basic render/i.test(renderer);
}

/** Renderer of the pictures of all runs. Throws without WebGL. */
export class Painter {
  readonly inSoftware = drawsInSoftware();
  readonly canvas = element("canvas");
  private readonly renderer: three.WebGLRenderer;
  private readonly size = new three.Vector2();

  constructor(redraw: () => void) {
    this.renderer = new three.WebGLRenderer({ canvas: this.canvas, antialias: !this.inSoftware, alpha: true });
    this.renderer.setClearColor(0, 0);
    this.renderer.localClippingEnabled = true;
    this.canvas.addEventListener("webglcontextrestored", redraw);
  }

  /** Draw to `canvas`, which keeps it until the next call. */
  draw(scene: three.Scene, camera: three.Camera, width: number, height: number, ratio: number): void {
    this.renderer.getSize(this.size);
    if (this.renderer.getPixelRatio() !== ratio) this.renderer.setPixelRatio(ratio);
    if (this.size.x !== width || this.size.y !== height) this.renderer.setSize(width, height, false);
    this.renderer.render(scene, camera);
  }
}

export const screenRatio = Math.min(devicePixelRatio, 2);
const usualMargins = { side: 30, top: 66 }; // pixels: for marks; for marks below time and title
const smallMargins = { side: 16, top: 24 };

export class RunView {
  readonly box = element("div", { class: "view" });
  readonly caption = element("button", { type: "button", class: "caption", title: "larger or smaller" });
  readonly canvas: HTMLCanvasElement;
  readonly camera = new three.OrthographicCamera(-1, 1, 1, -1, 1, 10);
  readonly controls: TrackballControls;
  near = false; // in or near the visible part of the page
  stale = true; // the scene is out of date
  moved = true; // the camera has moved
  private scene: EmbryoScene | null = null;

  constructor(
    readonly run: Run, private readonly page: PageData, private readonly state: State, private readonly painter: Painter,
  ) {
    this.canvas = element("canvas", {
      class: "picture", tabindex: "0", role: "img", "aria-label": `The tissue of ${run.name}: ${run.title.slice(0, 200)}`,
    });
    this.box.dataset.run = run.name;
    this.box.append(this.caption, this.canvas);
    this.controls = new TrackballControls(this.camera, this.canvas);
    this.controls.staticMoving = true;
    this.controls.rotateSpeed = 3;
    this.controls.keys = ["", "", ""];
  }

  get isShown(): boolean {
    return !this.box.hidden;
  }

  get isDrawable(): boolean {
    return this.isShown && this.near && this.run.loaded;
  }

  /** Whether its name is shown above: with many runs, small or large. */
  get hasCaption(): boolean {
    return this.isSmall || this.box.classList.contains("large");
  }

  /** Position among the others. */
  set order(place: number) {
    this.box.style.order = String(place);
  }

  get isSmall(): boolean {
    return this.box.classList.contains("small");
  }

  /** Small pictures let wheel and vertical touches scroll the page, and have their name above. */
  setSmall(small: boolean, looks: RunLooks): void {
    this.box.classList.toggle("small", small);
    this.controls.noZoom = this.controls.noPan = small;
    this.showCaption(looks);
  }

  showCaption(looks: RunLooks): void {
    this.caption.replaceChildren(sampleOf(looks.lookOf(this.run)), element("span", {}, this.run.name));
  }

  // Small pictures show the time only if the run ended before the time of the page.
  private get timeShown(): string {
    const { endTime, failed, data } = this.run;
    const { time } = this.state.now;
    if (!this.isSmall) return timeText(Math.min(time, endTime));
    const how = failed ? "failed" : data.summary ? "ended" : "still";
    return time > endTime ? `${how} at ${timeText(endTime)}` : "";
  }

  get size(): { width: number; height: number } {
    return { width: this.canvas.clientWidth, height: this.canvas.clientHeight };
  }

  /** `half`: half of the picture height at zoom 1, um. */
  resize(half: number): void {
    const { width, height } = this.size;
    if (width === 0 || height === 0) return;
    this.camera.top = half;
    this.camera.bottom = -half;
    this.camera.right = (half * width) / height;
    this.camera.left = -this.camera.right;
    this.camera.updateProjectionMatrix();
    this.controls.handleResize();
    this.stale = true;
  }

  update(): void {
    if (!this.run.loaded) return;
    const { time, field, cut, edges, shell, picked } = this.state.now;
    const place = this.run.placeAt(time);
    const cell = picked?.run === this.run.number ? this.run.ancestorAt(picked.id, place.topology) : -1;
    this.scene ??= new EmbryoScene(this.run, this.page);
    this.scene.show(place, field, cut, { edges, shell }, cell < 0 ? this.run.marked : [...this.run.marked, cell]);
    this.canvas.dataset.cells = String(place.topology.cells);
    this.stale = false;
    this.moved = true;
  }

  /** Draw the picture as `paint` does. */
  render(ratio: number, title: string): void {
    const { width, height } = this.size;
    [this.canvas.width, this.canvas.height] = [width * screenRatio, height * screenRatio];
    const context = this.canvas.getContext("2d")!;
    context.scale(screenRatio, screenRatio);
    this.paint(context, ratio, title);
    this.canvas.dataset.fineness = String(ratio);
    this.moved = false;
  }

  /** Paints picture and annotations at the canvas's origin. WebGL draws a CSS pixel as `ratio` pixels: where that is more
   * than the canvas has, edges are smoothed. */
  paint(context: CanvasRenderingContext2D, ratio: number, title: string): void {
    if (!this.scene) return;
    const { width, height } = this.size;
    this.scene.lightFrom(this.camera);
    this.painter.draw(this.scene.scene, this.camera, width, height, ratio);
    context.imageSmoothingQuality = "high";
    context.drawImage(this.painter.canvas, 0, 0, width, height);
    const scene = this.scene;
    annotate(context, {
      width, height, camera: this.camera, centre: this.run.centre,
      reach: (right, up, along) => scene.reach(right, up, along),
      title: this.hasCaption ? "" : title, time: this.timeShown, letters: this.state.now.marks ? this.run.data.letters : null,
      isSmall: this.isSmall,
    });
  }

  /** Zoom at which the embryo, in its present state and view, fills the picture except for margins; null before loading. */
  fittingZoom(): number | null {
    const scene = this.scene;
    if (!scene) return null;
    const right = new three.Vector3().setFromMatrixColumn(this.camera.matrixWorld, 0);
    const up = new three.Vector3().setFromMatrixColumn(this.camera.matrixWorld, 1);
    const reach = (x: number, y: number) => scene.reach(right, up, new three.Vector2(x, y));
    const wide = Math.max(reach(1, 0), reach(-1, 0));
    const high = Math.max(reach(0, 1), reach(0, -1));
    const { width, height } = this.size;
    const margins = this.isSmall ? smallMargins : usualMargins;
    const part = (margin: number, side: number) => Math.max(1 - (2 * margin) / side, 0.3);
    return Math.min((part(margins.side, width) * this.camera.right) / wide, (part(margins.top, height) * this.camera.top) / high);
  }

  /** Scene in the present shape; null before it is drawn. */
  get drawn(): EmbryoScene | null {
    return this.scene;
  }

  cellAt(clientX: number, clientY: number): number {
    const box = this.canvas.getBoundingClientRect();
    const ray = new three.Raycaster();
    const x = (2 * (clientX - box.left)) / box.width - 1;
    const y = 1 - (2 * (clientY - box.top)) / box.height;
    ray.setFromCamera(new three.Vector2(x, y), this.camera);
    return this.scene?.cellOn(ray, this.state.now.cut) ?? -1;
  }
}
