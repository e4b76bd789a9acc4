// Cross-sections at 25, 50 and 75 % of the length, at the time of the page.
import { colourAt, css, partOf } from "./colour";
import { byId, element, whenNear } from "./dom";
import { fewRuns, type PageData, titleOf } from "./page_data";
import type { Run, Topology } from "./run";
import { cutByPlane, cutOutlines } from "./section";
import type { State } from "./state";
import { number } from "./text";

const places = [0.25, 0.5, 0.75]; // of the length, from the anterior end
const margin = 6; // pixels

class RunSections {
  readonly box = element("figure", { class: "sections" });
  private readonly canvases = places.map(() => element("canvas", { role: "img", "aria-label": "Cross-section of the tissue" }));
  private readonly captions = places.map(() => element("span"));
  private cuts: number[] | null = null; // um

  constructor(private readonly run: Run, private readonly page: PageData, private readonly state: State, named: boolean) {
    if (named) this.box.append(element("figcaption", {}, run.name));
    places.forEach((_, i) => this.box.append(element("div", {}, this.captions[i], this.canvases[i])));
  }

  draw(): void {
    if (!this.run.loaded) return;
    this.cuts ??= this.placesAtRest();
    const { topology, moment, part } = this.run.placeAt(this.state.now.time);
    const positions = new Float32Array(3 * topology.nodes);
    topology.positions(moment, part, positions);
    const values = new Float32Array(Math.max(topology.nodes, topology.cells));
    topology.values(this.state.now.field, moment, part, values);
    this.cuts.forEach((at, i) => {
      this.captions[i].textContent = `x = ${number(Math.round(at))} µm`;
      this.paint(this.canvases[i], topology, positions, values, at);
    });
  }

  private placesAtRest(): number[] {
    const { topology, moment } = this.run.frames[0];
    const positions = new Float32Array(3 * topology.nodes);
    topology.positions(moment, 0, positions);
    let [low, high] = [Infinity, -Infinity];
    for (let n = 0; n < positions.length; n += 3) [low, high] = [Math.min(low, positions[n]), Math.max(high, positions[n])];
    return places.map((part) => low + part * (high - low));
  }

  // Seen from the front: the left side is to the right.
  private paint(canvas: HTMLCanvasElement, topology: Topology, positions: Float32Array, values: Float32Array, at: number): void {
    const ratio = Math.min(devicePixelRatio, 2);
    const [, halfWidth, halfHeight] = this.run.halfSize;
    const width = canvas.clientWidth;
    const scale = (width - 2 * margin) / (2 * halfWidth); // pixels a um
    const height = Math.ceil(2 * halfHeight * scale + 2 * margin);
    canvas.style.height = `${height}px`;
    [canvas.width, canvas.height] = [width * ratio, height * ratio];
    const context = canvas.getContext("2d")!;
    context.scale(ratio, ratio);
    const [, y0, z0] = this.run.centre;
    const place = ([, y, z]: [number, number, number]): [number, number] =>
      [width / 2 - scale * (y - y0), height / 2 - scale * (z - z0)];
    const { field } = this.state.now;
    const map = this.page.maps[field.map];
    const polygons = cutByPlane(topology, positions, { axis: 0, at: at + this.page.view_cut_um, keep: 1 });
    for (const { element: e, corners } of polygons) {
      const value = field.on_nodes
        ? corners.reduce((sum, { first, second, part }) => sum + (1 - part) * values[first] + part * values[second], 0) / corners.length
        : values[topology.cellOfElement[e]];
      context.fillStyle = context.strokeStyle = css(colourAt(map, partOf(field, value)));
      context.lineWidth = 0.5; // no gaps between neighbours
      context.beginPath();
      for (const corner of corners) context.lineTo(...place(corner.point));
      context.closePath();
      context.fill();
      context.stroke();
    }
    context.strokeStyle = "#1c1c22";
    context.lineWidth = 0.7;
    context.beginPath();
    for (const [a, b] of cutOutlines(topology, polygons)) {
      context.moveTo(...place(a.point));
      context.lineTo(...place(b.point));
    }
    context.stroke();
  }
}

// The end of x that is nearest to the viewer; "the front" of an embryo.
function frontOf(run: Run): string {
  const [front] = run.data.axes[0];
  return front === "anterior" ? "the front" : front;
}

/** Cross-sections, only for few runs; drawn when visible. */
export function showSections(runs: Run[], page: PageData, state: State): void {
  const shown = runs.filter((run) => run.hasFrames);
  if (shown.length === 0 || shown.length > fewRuns) return;
  const all = shown.map((run) => new RunSections(run, page, state, shown.length > 1));
  const holder = byId("sections");
  const legend = element("p", { class: "note" });
  const showLegend = () => (legend.textContent = `Colour: ${titleOf(state.now.field)}, on the scale of the picture.`);
  state.on(["field"], showLegend);
  showLegend();
  holder.append(
    element("h2", {}, `Cross-sections at 25, 50 and 75 % of the length, from ${frontOf(shown[0])}`),
    legend,
    ...all.map(({ box }) => box),
  );
  let waits = false;
  const draw = () => {
    waits = false;
    all.forEach((one) => one.draw());
    holder.dataset.drawn = String(state.now.time);
  };
  const drawSoon = () => {
    if (!waits) requestAnimationFrame(draw);
    waits = true;
  };
  whenNear(holder, () => {
    void Promise.all(shown.map((run) => run.load())).then(drawSoon);
    state.on(["time", "field"], drawSoon);
    new ResizeObserver(drawSoon).observe(holder);
  });
  state.on(["shown"], () => all.forEach(({ box }, i) => (box.hidden = !state.now.shown.has(shown[i].number))));
}
