// Pictures of all visible runs: linked cameras, rotation and picking.
import * as three from "three";
import { drawLegend, legendHeight } from "./annotations";
import { element, styleColour } from "./dom";
import { fewRuns, type PageData } from "./page_data";
import type { Run } from "./run";
import type { RunLooks } from "./run_looks";
import { Painter, RunView, screenRatio } from "./run_view";
import { pointWith, type State } from "./state";

const clickTolerance = 4; // pixels between press and release
const turnStep = 0.12; // rad a key press
const closeUpSize = 2.5; // half of a close-up's height / radius of its cell
const settleTime = 200; // ms without a change after which a picture is drawn finely
const settlePictures = 4; // times that a picture takes, after which it is, where drawing is slow

/** View of all runs. Throws without WebGL. */
export class EmbryoViews {
  private readonly painter: Painter;
  private readonly views: RunView[];
  private radius: number; // um, of a ball around every run
  private large: RunView | null = null; // enlarged one of many
  private focus: RunView | null = null; // looks at the picked cell until a view is chosen
  private isFine = false;
  private changedAt = 0; // ms
  private isDrawn = false; // at the last refresh
  private drawingTime = 0; // ms from one picture to where the browser asks for the next
  private shape = ""; // layout of the page that determines picture sizes
  private leader: RunView | null = null; // camera moved by the user; the others report changes, too

  constructor(
    runs: Run[], private readonly page: PageData, private readonly state: State, private readonly looks: RunLooks,
    private readonly holder: HTMLElement, private readonly legend: HTMLCanvasElement,
  ) {
    this.painter = new Painter(() => this.refresh());
    this.views = runs.filter((run) => run.hasFrames).map((run) => new RunView(run, page, state, this.painter));
    this.radius = Math.max(...this.views.map(({ run }) => Math.hypot(...run.halfSize)));
    holder.append(...this.views.map((view) => view.box));
    for (const view of this.views) this.listen(view);
    state.on(["view"], () => {
      this.focus = null;
      this.lookFrom();
    });
    state.on(["time", "field", "cut", "edges", "shell", "marks", "picked"], () => this.makeStale());
    state.on(["field"], () => this.showLegend());
    state.on(["shown"], () => this.arrange());
    state.on(["order"], () => this.sort());
    state.on(["colourBy"], () => this.views.forEach((view) => view.showCaption(looks)));
    state.on(["pointed"], () => this.views.forEach((view) =>
      view.box.classList.toggle("pointed", view.run.number === state.now.pointed)));
    this.sort();
    this.arrange();
    new ResizeObserver(() => this.resize()).observe(holder);
    this.watch();
  }

  /** Draw changes; called before each screen refresh. */
  draw(): void {
    const drawable = this.views.filter((view) => view.isDrawable);
    for (const view of drawable) view.controls.update();
    const now = performance.now();
    if (this.isDrawn) this.drawingTime = now - this.changedAt;
    const changed = drawable.filter((view) => view.stale || view.moved);
    this.isDrawn = changed.length > 0;
    if (this.isDrawn) this.changedAt = now;
    const settled = this.painter.inSoftware && !this.isFine && !this.state.now.playing &&
      now - this.changedAt > Math.max(settleTime, settlePictures * this.drawingTime);
    if (!this.isDrawn && !settled) return;
    this.isFine = settled;
    const ratio = !this.painter.inSoftware ? screenRatio : settled ? 2 : 1;
    for (const view of settled ? drawable : changed) {
      if (view.stale) view.update();
      view.render(ratio, this.titleOf(view));
    }
  }

  /** Update after a change of style or size. */
  refresh(): void {
    this.makeStale();
    this.views.forEach((view) => view.showCaption(this.looks));
    this.showLegend();
  }

  viewOf(run: Run): RunView {
    return this.views.find((view) => view.run === run)!;
  }

  /** Adapt to runs that have become larger or smaller, or are loaded now, and look at them again. */
  remeasure(): void {
    this.radius = Math.max(...this.views.map(({ run }) => Math.hypot(...run.halfSize)));
    for (const view of this.views) view.resize(this.radius);
    this.makeStale();
    this.lookFrom();
  }

  /** Viewing direction, into the picture. */
  sight(): number[] {
    return this.views[0].camera.getWorldDirection(new three.Vector3()).toArray();
  }

  /** Image of all pictures as on the page, above the legend, at twice the screen resolution. */
  async picture(): Promise<Blob> {
    const canvas = await this.drawing(2);
    return new Promise((resolve) => canvas.toBlob((blob) => resolve(blob!), "image/png"));
  }

  /** Drawing of all pictures as on the page, above the legend; `finer`: its resolution / that of the screen. */
  async drawing(finer: number): Promise<HTMLCanvasElement> {
    const shown = this.views.filter((view) => view.isShown);
    await Promise.all(shown.map(({ run }) => run.load()));
    const { clientWidth: width, clientHeight: height } = this.holder;
    const canvas = element("canvas");
    canvas.width = finer * width;
    canvas.height = finer * (height + legendHeight);
    const context = canvas.getContext("2d")!;
    context.scale(finer, finer);
    context.fillStyle = styleColour("paper");
    context.fillRect(0, 0, width, height + legendHeight);
    for (const view of shown) {
      view.update();
      const { offsetLeft, offsetTop } = view.box;
      context.save();
      context.translate(offsetLeft, offsetTop + view.canvas.offsetTop);
      view.paint(context, finer, this.titleOf(view));
      context.restore();
      if (!view.hasCaption) continue;
      context.font = "13px system-ui, sans-serif";
      context.textBaseline = "top";
      context.textAlign = "left";
      context.fillStyle = styleColour("ink");
      context.fillText(view.run.name, offsetLeft + 4, offsetTop + 4, view.size.width - 8);
    }
    context.translate(0, height);
    drawLegend(context, width, this.state.now.field, this.page);
    return canvas;
  }

  private titleOf(view: RunView): string {
    return this.views.length > 1 ? view.run.name : "";
  }

  private makeStale(): void {
    for (const view of this.views) view.stale = true;
  }

  // Snapshots are unpacked and drawn when their picture is visible.
  private watch(): void {
    const observer = new IntersectionObserver((entries) => {
      for (const { target, isIntersecting } of entries) {
        const view = this.views.find(({ box }) => box === target)!;
        view.near = isIntersecting;
        if (isIntersecting) void this.makeReady(view);
      }
    }, { rootMargin: "100px" });
    for (const view of this.views) observer.observe(view.box);
  }

  /** Unpack the snapshots of a run for its picture. */
  async makeReady(view = this.views[0]): Promise<void> {
    view.near = true;
    if (view.run.loaded) return;
    const isFirst = !this.views.some(({ run }) => run.loaded);
    await view.run.load();
    view.stale = true;
    if (!isFirst) return;
    view.update();
    this.lookFrom();
  }

  /** Show a cell close up, from its apical side, at the end of its run, and mark it. */
  async lookAtCell(run: Run, id: number): Promise<void> {
    const view = this.views.find((candidate) => candidate.run === run);
    if (!view) return;
    await run.load();
    this.focus = view;
    this.state.set({ time: run.endTime, playing: false, cut: null, picked: { run: run.number, id } });
    this.lookFrom();
  }

  private sort(): void {
    for (const view of this.views) view.order = this.state.now.order.indexOf(view.run.number);
  }

  // Few pictures are large, many are small.
  private arrange(): void {
    const { shown } = this.state.now;
    for (const view of this.views) view.box.hidden = !shown.has(view.run.number);
    const count = this.views.filter((view) => view.isShown).length;
    this.holder.dataset.count = count > fewRuns ? "many" : String(count);
    if (this.large && (!this.large.isShown || count <= fewRuns)) this.large = null;
    for (const view of this.views) {
      view.setSmall(count > fewRuns && view !== this.large, this.looks);
      view.box.classList.toggle("large", view === this.large);
    }
    this.resize();
  }

  private resize(): void {
    const sizes = this.views.filter((view) => view.isShown).map(({ size }) => `${size.width} ${size.height}`);
    const shape = `${this.holder.dataset.count} ${sizes.join(" ")}`;
    if (shape === this.shape) return;
    this.shape = shape;
    for (const view of this.views) view.resize(this.radius);
    this.lookFrom();
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
      if (view.isDrawable) view.update();
      const centre = new three.Vector3(...run.centre);
      camera.near = 0.1 * this.radius;
      camera.far = 10 * this.radius;
      camera.up.set(...up).normalize();
      camera.position.copy(centre).addScaledVector(new three.Vector3(...sight).normalize(), -4 * this.radius);
      controls.target.copy(centre);
      camera.lookAt(centre);
      camera.updateMatrixWorld();
      view.moved = true;
    }
    this.fit();
    if (this.focus) this.closeUp(this.focus);
  }

  private closeUp(view: RunView): void {
    const { picked, time } = this.state.now;
    const cell = picked?.run === view.run.number ? view.run.placeOfCell(picked.id, time) : null;
    if (!cell) return;
    const { camera, controls } = view;
    const centre = new three.Vector3(...cell.centre);
    const outward = new three.Vector3(...cell.outward);
    const up = new three.Vector3(...this.state.now.view.up).projectOnPlane(outward);
    if (up.length() < 0.1) up.set(1, 0, 0).projectOnPlane(outward);
    camera.up.copy(up.normalize());
    // A little from below, so that the height of the sheet is seen, too.
    camera.position.copy(centre).addScaledVector(outward.addScaledVector(up, -0.5).normalize(), 4 * this.radius);
    controls.target.copy(centre);
    camera.lookAt(centre);
    camera.updateMatrixWorld();
    camera.zoom = this.radius / (closeUpSize * cell.radius);
    camera.updateProjectionMatrix();
    view.moved = true;
  }

  // Common scale at which the largest fits; runs not yet unpacked are assumed similar. An enlarged picture has its own.
  private fit(): void {
    const shown = this.views.filter((view) => view.isShown && view !== this.large);
    const known = shown.flatMap((view) => {
      const zoom = view.fittingZoom();
      return zoom === null ? [] : [{ view, zoom }];
    });
    if (known.length > 0) {
      const size = (view: RunView) => Math.hypot(...view.run.halfSize);
      const smallest = known.reduce((a, b) => (a.zoom * size(a.view) < b.zoom * size(b.view) ? a : b));
      const zooms = shown.map((view) => view.fittingZoom() ?? (smallest.zoom * size(smallest.view)) / size(view));
      for (const { camera } of this.views) camera.zoom = Math.min(...zooms);
    }
    if (this.large) this.large.camera.zoom = this.large.fittingZoom() ?? 1;
    for (const { camera } of this.views) camera.updateProjectionMatrix();
  }

  // All cameras follow one, relative to the centre of their run.
  private follow(leader: RunView): void {
    for (const view of this.views) {
      if (view === leader) continue;
      const shift = leader.controls.target.clone().sub(new three.Vector3(...leader.run.centre));
      view.controls.target.set(...view.run.centre).add(shift);
      view.camera.position.copy(leader.camera.position).sub(leader.controls.target).add(view.controls.target);
      view.camera.up.copy(leader.camera.up);
      if (leader !== this.large && view !== this.large) view.camera.zoom = leader.camera.zoom;
      view.camera.lookAt(view.controls.target);
      view.camera.updateProjectionMatrix();
      view.moved = true;
    }
    leader.moved = true;
  }

  private listen(view: RunView): void {
    const lead = () => (this.leader = view);
    view.canvas.addEventListener("pointerdown", lead, { capture: true });
    view.canvas.addEventListener("wheel", lead, { capture: true, passive: true });
    view.controls.addEventListener("change", () => {
      view.moved = true;
      if (this.leader === view) this.follow(view);
    });
    view.caption.addEventListener("click", () => {
      this.large = this.large === view ? null : view;
      this.arrange();
      if (this.large) this.large.box.scrollIntoView({ block: "nearest" });
    });
    pointWith(view.box, view.run.number, this.state);
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
    // Axis of rotation in the picture (0 rightward, 1 upward), and direction.
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
