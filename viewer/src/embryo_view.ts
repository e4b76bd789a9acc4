// The pictures of all runs: a canvas each, cameras locked together, and how they are turned and picked.
import * as three from "three";
import { TrackballControls } from "three/examples/jsm/controls/TrackballControls.js";
import { annotate, drawLegend, legendHeight } from "./annotations";
import { element, styleColour } from "./dom";
import { EmbryoScene } from "./embryo_scene";
import type { PageData } from "./page_data";
import type { Run } from "./run";
import type { State } from "./state";
import { time as timeText } from "./text";

const clickTolerance = 4; // pixels between press and release
const turnStep = 0.12; // rad a key press
const settleTime = 200; // ms without a change after which a picture is drawn finely

// Without a graphics card the processor draws. Smoothing edges then costs it half of its time: it is left out while the
// picture moves, and a picture that stands still is drawn with four times the pixels instead.
function drawsInSoftware(): boolean {
  const context = document.createElement("canvas").getContext("webgl2");
  const names = context?.getExtension("WEBGL_debug_renderer_info");
  const renderer = names ? String(context!.getParameter(names.UNMASKED_RENDERER_WEBGL)) : "";
  context?.getExtension("WEBGL_lose_context")?.loseContext();
  return /swiftshader|llvmpipe|software|basic render/i.test(renderer);
}

const margins = { side: 30, top: 66 }; // pixels: for marks; for marks below time and title
const overlayRatio = Math.min(devicePixelRatio, 2);

class RunView {
  readonly box = element("div", { class: "view" });
  readonly canvas: HTMLCanvasElement;
  readonly camera = new three.OrthographicCamera(-1, 1, 1, -1, 1, 10);
  readonly controls: TrackballControls;
  private readonly overlay = element("canvas", { class: "overlay", "aria-hidden": "true" });
  private readonly renderer: three.WebGLRenderer;
  private readonly scene: EmbryoScene;

  constructor(readonly run: Run, page: PageData, private readonly state: State, private readonly inSoftware: boolean) {
    this.canvas = element("canvas", {
      class: "picture", tabindex: "0", role: "img", "aria-label": `The embryo of ${run.title.slice(0, 200)}`,
    });
    this.renderer = new three.WebGLRenderer({ canvas: this.canvas, antialias: !inSoftware, alpha: true });
    this.renderer.setClearColor(0, 0);
    this.renderer.localClippingEnabled = true;
    this.setFine(false);
    this.scene = new EmbryoScene(run, page);
    this.box.append(this.canvas, this.overlay);
    this.controls = new TrackballControls(this.camera, this.canvas);
    this.controls.staticMoving = true;
    this.controls.rotateSpeed = 3;
    this.controls.keys = ["", "", ""];
  }

  get size(): { width: number; height: number } {
    return { width: this.box.clientWidth, height: this.box.clientHeight };
  }

  /** Whether the picture is drawn as it is to stand, or as it has to move. */
  setFine(fine: boolean): void {
    this.renderer.setPixelRatio(!this.inSoftware ? overlayRatio : fine ? 2 : 1);
  }

  /** `half`: of the picture's height at zoom 1, um. */
  resize(half: number): void {
    const { width, height } = this.size;
    if (width === 0 || height === 0) return;
    this.renderer.setSize(width, height, false);
    this.camera.top = half;
    this.camera.bottom = -half;
    this.camera.right = (half * width) / height;
    this.camera.left = -this.camera.right;
    this.camera.updateProjectionMatrix();
    this.controls.handleResize();
    this.overlay.width = width * overlayRatio;
    this.overlay.height = height * overlayRatio;
  }

  update(): void {
    const { time, field, cut, edges, shell, picked } = this.state.now;
    const place = this.run.placeAt(time);
    const cell = picked?.run === this.run.number ? this.run.ancestorAt(picked.id, place.topology) : -1;
    this.scene.show(place, field, cut, { edges, shell }, cell);
    this.canvas.dataset.cells = String(place.topology.cells);
  }

  render(showTitle: boolean): void {
    this.drawEmbryo();
    const context = this.overlay.getContext("2d")!;
    context.setTransform(overlayRatio, 0, 0, overlayRatio, 0, 0);
    context.clearRect(0, 0, this.overlay.width, this.overlay.height);
    this.annotate(context, showTitle);
  }

  private drawEmbryo(): void {
    this.scene.lightFrom(this.camera);
    this.renderer.render(this.scene.scene, this.camera);
  }

  private annotate(context: CanvasRenderingContext2D, showTitle: boolean): void {
    const shown = Math.min(this.state.now.time, this.run.endTime);
    annotate(context, {
      ...this.size, camera: this.camera, centre: this.run.centre,
      reach: (right, up, along) => this.scene.reach(right, up, along),
      title: showTitle ? this.run.title : "", time: timeText(shown), showMarks: this.state.now.marks,
    });
  }

  /** Paints picture and annotations into another canvas, where a CSS pixel is `ratio` pixels. The own one is lost. */
  paint(context: CanvasRenderingContext2D, ratio: number, showTitle: boolean): void {
    const { width, height } = this.size;
    const own = this.renderer.getPixelRatio();
    this.renderer.setPixelRatio(ratio);
    this.drawEmbryo();
    context.drawImage(this.canvas, 0, 0, width, height);
    this.renderer.setPixelRatio(own);
    this.annotate(context, showTitle);
  }

  /** The zoom at which the embryo, as it is and seen as now, fills the picture but for a margin for marks and bar. */
  fittingZoom(): number {
    const right = new three.Vector3().setFromMatrixColumn(this.camera.matrixWorld, 0);
    const up = new three.Vector3().setFromMatrixColumn(this.camera.matrixWorld, 1);
    const reach = (x: number, y: number) => this.scene.reach(right, up, new three.Vector2(x, y));
    const wide = Math.max(reach(1, 0), reach(-1, 0));
    const high = Math.max(reach(0, 1), reach(0, -1));
    const { width, height } = this.size;
    const part = (margin: number, side: number) => Math.max(1 - (2 * margin) / side, 0.3);
    return Math.min((part(margins.side, width) * this.camera.right) / wide, (part(margins.top, height) * this.camera.top) / high);
  }

  cellAt(clientX: number, clientY: number): number {
    const box = this.canvas.getBoundingClientRect();
    const ray = new three.Raycaster();
    const x = (2 * (clientX - box.left)) / box.width - 1;
    const y = 1 - (2 * (clientY - box.top)) / box.height;
    ray.setFromCamera(new three.Vector2(x, y), this.camera);
    return this.scene.cellOn(ray, this.state.now.cut);
  }
}

/** Throws where the browser offers no WebGL. */
export class EmbryoViews {
  private readonly inSoftware: boolean;
  private readonly views: RunView[];
  private readonly radius: number; // um, of a ball around every run
  private stale = true; // the scenes no longer show the state
  private moved = true; // the cameras have moved
  private isFine = false;
  private changedAt = 0; // ms
  private width = 0; // of each picture
  private height = 0;
  private leader: RunView | null = null; // whose camera the hand moves; the others report changes, too

  constructor(
    runs: Run[], private readonly page: PageData, private readonly state: State,
    holder: HTMLElement, private readonly legend: HTMLCanvasElement,
  ) {
    this.inSoftware = drawsInSoftware();
    this.views = runs.filter((run) => run.hasFrames).map((run) => new RunView(run, page, state, this.inSoftware));
    this.radius = Math.max(...this.views.map(({ run }) => Math.hypot(...run.halfSize)));
    holder.append(...this.views.map((view) => view.box));
    holder.dataset.count = String(this.views.length);
    for (const view of this.views) this.listen(view);
    state.on(["view"], () => this.lookFrom());
    state.on(["time", "field", "cut", "edges", "shell", "marks", "picked"], () => (this.stale = true));
    state.on(["field"], () => this.showLegend());
    new ResizeObserver(() => this.resize()).observe(holder);
    this.resize();
  }

  /** Draws what has changed; called before each picture of the screen. */
  draw(): void {
    for (const view of this.views) view.controls.update();
    const now = performance.now();
    if (this.stale || this.moved) this.changedAt = now;
    const settled = this.inSoftware && !this.isFine && now - this.changedAt > settleTime && !this.state.now.playing;
    if (!this.stale && !this.moved && !settled) return;
    this.setFine(settled);
    if (this.stale) for (const view of this.views) view.update();
    for (const view of this.views) view.render(this.views.length > 1);
    this.stale = this.moved = false;
  }

  /** Style or size has changed. */
  refresh(): void {
    this.stale = true;
    this.showLegend();
  }

  /** The eye's direction, from the eye into the picture. */
  sight(): number[] {
    return this.views[0].camera.getWorldDirection(new three.Vector3()).toArray();
  }

  /** All pictures beside each other above the legend, twice as fine as the screen. */
  async picture(): Promise<Blob> {
    const finer = 2;
    const width = this.views.reduce((sum, view) => sum + view.size.width, 0);
    const height = Math.max(...this.views.map((view) => view.size.height));
    const canvas = element("canvas");
    canvas.width = finer * width;
    canvas.height = finer * (height + legendHeight);
    const context = canvas.getContext("2d")!;
    context.scale(finer, finer);
    context.fillStyle = styleColour("paper");
    context.fillRect(0, 0, width, height + legendHeight);
    context.save();
    for (const view of this.views) {
      view.paint(context, finer, this.views.length > 1);
      context.translate(view.size.width, 0);
    }
    context.restore();
    this.moved = true;
    context.translate(0, height);
    drawLegend(context, width, this.state.now.field, this.page);
    return new Promise((resolve) => canvas.toBlob((blob) => resolve(blob!), "image/png"));
  }

  private setFine(fine: boolean): void {
    if (fine === this.isFine) return;
    this.isFine = fine;
    for (const view of this.views) view.setFine(fine);
  }

  private resize(): void {
    const { width, height } = this.views[0].size;
    if (width * height === 0 || (width === this.width && height === this.height)) return;
    [this.width, this.height] = [width, height];
    for (const view of this.views) view.resize(this.radius);
    this.lookFrom();
    this.stale = true;
    this.showLegend();
    this.draw();
  }

  private showLegend(): void {
    const ratio = Math.min(devicePixelRatio, 2);
    const width = this.legend.clientWidth;
    this.legend.width = width * ratio;
    this.legend.height = legendHeight * ratio;
    const context = this.legend.getContext("2d")!;
    context.scale(ratio, ratio);
    if (width > 0) drawLegend(context, width, this.state.now.field, this.page);
  }

  private lookFrom(): void {
    const { sight, up } = this.state.now.view;
    for (const view of this.views) {
      const { camera, controls, run } = view;
      view.update();
      const centre = new three.Vector3(...run.centre);
      camera.near = 0.1 * this.radius;
      camera.far = 10 * this.radius;
      camera.up.set(...up).normalize();
      camera.position.copy(centre).addScaledVector(new three.Vector3(...sight).normalize(), -4 * this.radius);
      controls.target.copy(centre);
      camera.lookAt(centre);
      camera.updateMatrixWorld();
    }
    // One scale for all, at which the largest just fits.
    const zoom = Math.min(...this.views.map((view) => view.fittingZoom()));
    for (const { camera } of this.views) {
      camera.zoom = zoom;
      camera.updateProjectionMatrix();
    }
    this.moved = true;
  }

  // What one camera does, the others do: relative to the middle of their own run.
  private follow(leader: RunView): void {
    for (const view of this.views) {
      if (view === leader) continue;
      const shift = leader.controls.target.clone().sub(new three.Vector3(...leader.run.centre));
      view.controls.target.set(...view.run.centre).add(shift);
      view.camera.position.copy(leader.camera.position).sub(leader.controls.target).add(view.controls.target);
      view.camera.up.copy(leader.camera.up);
      view.camera.zoom = leader.camera.zoom;
      view.camera.lookAt(view.controls.target);
      view.camera.updateProjectionMatrix();
    }
    this.moved = true;
  }

  private listen(view: RunView): void {
    const lead = () => (this.leader = view);
    view.canvas.addEventListener("pointerdown", lead, { capture: true });
    view.canvas.addEventListener("wheel", lead, { capture: true, passive: true });
    view.controls.addEventListener("change", () => {
      if (this.leader === view) this.follow(view);
      this.moved = true;
    });
    let pressed = { x: 0, y: 0 };
    view.canvas.addEventListener("pointerdown", (event) => (pressed = { x: event.clientX, y: event.clientY }));
    view.canvas.addEventListener("pointerup", (event) => {
      if (Math.hypot(event.clientX - pressed.x, event.clientY - pressed.y) > clickTolerance || event.button !== 0) return;
      this.pick(view, event.clientX, event.clientY);
    });
    view.canvas.addEventListener("keydown", (event) => {
      if (this.turnByKey(view, event.key)) event.preventDefault();
    });
  }

  private pick(view: RunView, x: number, y: number): void {
    const cell = view.cellAt(x, y);
    const { topology } = view.run.placeAt(this.state.now.time);
    this.state.set({ picked: cell < 0 ? null : { run: view.run.number, id: topology.cellIds[cell] } });
  }

  private turnByKey(view: RunView, key: string): boolean {
    const { camera, controls } = view;
    // The axis of the picture that is turned about (0 to the right, 1 upwards), and which way.
    const turns: Record<string, [number, number]> = {
      ArrowLeft: [1, 1], ArrowRight: [1, -1], ArrowUp: [0, 1], ArrowDown: [0, -1],
    };
    if (key in turns) {
      const axis = new three.Vector3().setFromMatrixColumn(camera.matrix, turns[key][0]);
      const turn = new three.Quaternion().setFromAxisAngle(axis, turns[key][1] * turnStep);
      camera.position.sub(controls.target).applyQuaternion(turn).add(controls.target);
      camera.up.applyQuaternion(turn);
      camera.lookAt(controls.target);
      camera.updateMatrix();
    } else if (key === "+" || key === "=" || key === "-") {
      camera.zoom = Math.min(Math.max(camera.zoom * (key === "-" ? 1 / 1.15 : 1.15), 0.2), 30);
      camera.updateProjectionMatrix();
    } else return false;
    this.follow(view);
    return true;
  }
}
