// Kymograph of the midline: onset and spread of invagination.
import uPlot from "uplot";
import { goToClicks, plotPadding, timeAxis, TimeLine, timeScale, valueAxis } from "./charts";
import { colourAt, css } from "./colour";
import { element, styleColour, whenNear } from "./dom";
import { plotFont } from "./fonts";
import { fewRuns, type PageData } from "./page_data";
import type { Run } from "./run";
import { pointWith, type State } from "./state";
import { number } from "./text";

export const midlineQuantities = ["depth_um", "normal_speed_um_per_s", "apical_area_ratio"];
const plotHeight = 240;
const smallHeight = 150; // with many runs

/** Scale common to all runs: diverging for ratios and signed values, else from the smallest value. */
export interface MidlineScale {
  map: string;
  low: number;
  high: number;
}

export function midlineScale(runs: Run[], quantity: string): MidlineScale {
  const centre = quantity === "apical_area_ratio" ? 1 : 0;
  let [least, greatest] = [centre, centre];
  for (const run of runs)
    for (const value of run.midline.column(quantity))
      if (value !== null) [least, greatest] = [Math.min(least, value), Math.max(greatest, value)];
  const [below, above] = [centre - least, greatest - centre];
  if (centre === 0 && below < above / 4) return { map: "still", low: least, high: greatest || 1 };
  const reach = Math.max(below, above) || 1;
  return { map: "about", low: centre - reach, high: centre + reach };
}

interface Column {
  time: number;
  cells: { place: number; value: number }[]; // along the axis
}

function columnsOf(run: Run, quantity: string): Column[] {
  const { columns, rows } = run.midline;
  const [place, value] = [columns.indexOf("ap_um"), columns.indexOf(quantity)];
  const result: Column[] = [];
  for (const row of rows) {
    if (result.at(-1)?.time !== row[0]) result.push({ time: row[0]!, cells: [] });
    if (row[place] !== null && row[value] !== null)
      result.at(-1)!.cells.push({ place: row[place]!, value: row[value]! });
  }
  for (const column of result) column.cells.sort((a, b) => a.place - b.place);
  return result.filter((column) => column.cells.length > 1);
}

export class Kymograph {
  readonly box = element("figure", { class: "chart" });
  private readonly holder = element("div");
  private readonly caption = element("figcaption");
  private readonly isSmall: boolean;
  private plot: uPlot | null = null;
  private line: TimeLine | null = null;
  private columns: Column[] = [];
  private scale: MidlineScale = { map: "still", low: 0, high: 1 };
  private isNear = false;

  constructor(
    private readonly run: Run, private readonly allRuns: Run[], private readonly page: PageData,
    private readonly state: State, private quantity: string, private logarithmicTime = false,
  ) {
    this.isSmall = allRuns.length > fewRuns;
    this.caption.textContent = allRuns.length > 1 ? run.name : "";
    this.holder.style.minHeight = `${this.height}px`;
    this.box.dataset.run = run.name;
    this.box.append(this.caption, this.holder);
    new ResizeObserver(() => this.fit()).observe(this.holder);
    state.on(["time"], () => this.line?.show(state.now.time));
    state.on(["pointed"], () => this.box.classList.toggle("pointed", state.now.pointed === run.number));
    pointWith(this.box, run.number, state);
    const sort = () => (this.box.style.order = String(state.now.order.indexOf(run.number)));
    state.on(["order"], sort);
    sort();
    const hide = () => (this.box.hidden = !state.now.shown.has(run.number));
    state.on(["shown"], hide);
    hide();
    whenNear(this.box, () => {
      this.isNear = true;
      this.rebuild();
    });
  }

  setLogarithmicTime(on: boolean): void {
    this.logarithmicTime = on;
    this.rebuild();
  }

  show(quantity: string): void {
    this.quantity = quantity;
    this.rebuild();
  }

  rebuild(): void {
    if (!this.isNear) return;
    this.columns = columnsOf(this.run, this.quantity).filter(({ time }) => !this.logarithmicTime || time > 0);
    this.scale = midlineScale(this.allRuns, this.quantity);
    this.plot?.destroy();
    this.line = null;
    this.plot = new uPlot(this.options(), this.data(), this.holder);
    this.line = new TimeLine(this.plot);
    this.line.show(this.state.now.time);
  }

  private get height(): number {
    return this.isSmall ? smallHeight : plotHeight;
  }

  // Common time axis, so that runs can be compared.
  private data(): uPlot.AlignedData {
    const times = new Set(this.allRuns.flatMap((run) => run.midline.column("time_s") as number[]));
    const shown = [...times].filter((time) => !this.logarithmicTime || time > 0).sort((a, b) => a - b);
    return [shown, shown.map(() => null)];
  }

  private options(): uPlot.Options {
    let reach = 1;
    for (const run of this.allRuns)
      for (const place of run.midline.column("ap_um")) reach = Math.max(reach, 1.05 * Math.abs(place ?? 0));
    const time = timeAxis(this.logarithmicTime);
    return {
      width: Math.max(this.holder.clientWidth, 150),
      height: this.height,
      padding: plotPadding,
      legend: { show: false },
      cursor: { points: { show: false }, y: false, sync: { key: "time" } },
      scales: { x: timeScale(this.logarithmicTime), y: { range: () => [-reach, reach] } },
      axes: [
        { ...time, grid: { show: false } },
        { ...valueAxis(), grid: { show: false }, label: `${this.run.data.letters[0][0]} ← µm → ${this.run.data.letters[0][1]}`, labelSize: 16 },
      ],
      series: [{}, {}],
      hooks: {
        draw: [(plot) => this.paint(plot), () => this.line?.show(this.state.now.time)],
        ready: [(plot) => goToClicks(plot, this.state)],
      },
    };
  }

  // The colours of a time extend half-way to the neighbouring times, so that the first and last are visible; those of a
  // cell half-way to its neighbours.
  private paint(plot: uPlot): void {
    const { ctx, bbox } = plot;
    ctx.save();
    ctx.beginPath();
    ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height);
    ctx.clip();
    const places = this.columns.map(({ time }) => plot.valToPos(time, "x", true));
    const between = (c: number) => (places[c] + places[c + 1]) / 2;
    const y = (place: number) => plot.valToPos(place, "y", true);
    this.columns.forEach(({ cells }, c) => {
      const [first, last] = [c === 0, c === places.length - 1];
      const left = first ? places[c] : between(c - 1);
      // A run that ends before the others: as far after its last moment as its colours reach before it.
      const right = !last ? between(c) : places[c] + (first ? 1 : places[c] - left);
      cells.forEach((cell, i) => {
        const before = i > 0 ? (cells[i - 1].place + cell.place) / 2 : 1.5 * cell.place - 0.5 * cells[1].place;
        const after = i + 1 < cells.length ? (cells[i + 1].place + cell.place) / 2 : 1.5 * cell.place - 0.5 * cells[i - 1].place;
        ctx.fillStyle = css(colourAt(this.page.maps[this.scale.map], this.partOf(cell.value)));
        const [top, bottom] = [y(after), y(before)];
        ctx.fillRect(left, top, right - left + 0.7, bottom - top + 0.7);
      });
    });
    ctx.restore();
  }

  private partOf(value: number): number {
    return (value - this.scale.low) / (this.scale.high - this.scale.low);
  }

  private fit(): void {
    const width = this.holder.clientWidth;
    if (this.plot && width > 0 && width !== this.plot.width) this.plot.setSize({ width, height: this.height });
  }
}

/** Draw the colour bar of all kymographs, `width` CSS pixels wide. */
export function drawMidlineScale(bar: HTMLCanvasElement, width: number, scale: MidlineScale, page: PageData): void {
  const ratio = Math.min(devicePixelRatio, 2);
  const height = 30;
  bar.style.width = `${width}px`;
  bar.style.height = `${height}px`;
  bar.width = width * ratio;
  bar.height = height * ratio;
  const context = bar.getContext("2d")!;
  context.scale(ratio, ratio);
  const [left, wide] = [40, width - 80];
  for (let i = 0; i < wide; ++i) {
    context.fillStyle = css(colourAt(page.maps[scale.map], i / (wide - 1)));
    context.fillRect(left + i, 2, 1.5, 10);
  }
  context.fillStyle = styleColour("ink");
  context.font = plotFont;
  context.textAlign = "center";
  context.textBaseline = "top";
  for (const part of [0, 0.5, 1])
    context.fillText(number(scale.low + part * (scale.high - scale.low), 3), left + part * wide, 15);
}
