// The midline over place and time: where invagination starts, and how it spreads.
import uPlot from "uplot";
import { goToClicks, plotFont, timeAxis, TimeLine } from "./charts";
import { colourAt, css } from "./colour";
import { element, styleColour } from "./dom";
import type { PageData } from "./page_data";
import type { Run } from "./run";
import type { State } from "./state";
import { number, words } from "./text";

export const midlineQuantities = ["depth_um", "normal_speed_um_per_s", "apical_area_ratio"];
const plotHeight = 240;

/** A scale that all runs share: two-sided for ratios and where both signs matter, else from the least value up. */
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
  private readonly scaleBar = element("canvas", { class: "bar" });
  private plot: uPlot | null = null;
  private line: TimeLine | null = null;
  private columns: Column[] = [];
  private scale: MidlineScale = { map: "still", low: 0, high: 1 };

  constructor(
    private readonly run: Run, private readonly allRuns: Run[], private readonly page: PageData,
    private readonly state: State, private quantity: string, private logarithmicTime = false,
  ) {
    this.box.append(this.caption, this.holder, this.scaleBar);
    new ResizeObserver(() => this.fit()).observe(this.holder);
    state.on(["time"], () => this.line?.show(state.now.time));
    this.rebuild();
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
    const [name, unit] = words(this.quantity);
    this.caption.textContent =
      `${name}${unit === "" ? "" : `, ${unit}`}, of the midline's cells` +
      (this.allRuns.length > 1 ? `: ${this.run.name}` : "");
    this.columns = columnsOf(this.run, this.quantity);
    this.scale = midlineScale(this.allRuns, this.quantity);
    this.plot?.destroy();
    this.line = null;
    this.plot = new uPlot(this.options(), this.data(), this.holder);
    this.line = new TimeLine(this.plot);
    this.line.show(this.state.now.time);
    this.drawScaleBar();
  }

  private data(): uPlot.AlignedData {
    const times = this.columns.map((column) => column.time).filter((time) => !this.logarithmicTime || time > 0);
    return [times, times.map(() => null)];
  }

  private options(): uPlot.Options {
    const places = this.columns.flatMap((column) => column.cells.map((cell) => cell.place));
    const reach = Math.max(...places.map(Math.abs), 1) * 1.05;
    return {
      width: Math.max(this.holder.clientWidth, 200),
      height: plotHeight,
      legend: { show: false },
      cursor: { points: { show: false }, y: false, sync: { key: "time" } },
      scales: { x: { time: false, distr: this.logarithmicTime ? 3 : 1 }, y: { range: () => [-reach, reach] } },
      axes: [
        { ...timeAxis(), grid: { show: false } },
        { ...timeAxis(), grid: { show: false }, label: "A  ←  at rest, µm  →  P", size: 50 },
      ],
      series: [{}, {}],
      hooks: {
        draw: [(plot) => this.paint(plot), () => this.line?.show(this.state.now.time)],
        ready: [(plot) => goToClicks(plot, this.state)],
      },
    };
  }

  // A moment's colours last until the next one; a cell reaches half-way to its neighbours.
  private paint(plot: uPlot): void {
    const { ctx, bbox } = plot;
    ctx.save();
    ctx.beginPath();
    ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height);
    ctx.clip();
    const x = (time: number) => plot.valToPos(Math.max(time, 1e-9), "x", true);
    const y = (place: number) => plot.valToPos(place, "y", true);
    this.columns.forEach((column, c) => {
      const next = this.columns[c + 1];
      const [left, right] = [x(column.time), next ? x(next.time) : bbox.left + bbox.width];
      if (right <= left) return;
      const { cells } = column;
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

  private drawScaleBar(): void {
    const ratio = Math.min(devicePixelRatio, 2);
    const [width, height] = [Math.min(this.box.clientWidth || 320, 420), 30];
    this.scaleBar.style.width = `${width}px`;
    this.scaleBar.style.height = `${height}px`;
    this.scaleBar.width = width * ratio;
    this.scaleBar.height = height * ratio;
    const context = this.scaleBar.getContext("2d")!;
    context.scale(ratio, ratio);
    const [left, wide] = [56, width - 112];
    for (let i = 0; i < wide; ++i) {
      context.fillStyle = css(colourAt(this.page.maps[this.scale.map], i / (wide - 1)));
      context.fillRect(left + i, 2, 1.5, 10);
    }
    context.fillStyle = styleColour("ink");
    context.font = plotFont;
    context.textAlign = "center";
    context.textBaseline = "top";
    for (const part of [0, 0.5, 1])
      context.fillText(number(this.scale.low + part * (this.scale.high - this.scale.low), 3), left + part * wide, 15);
  }

  private fit(): void {
    const width = this.holder.clientWidth;
    if (this.plot && width > 0 && width !== this.plot.width) {
      this.plot.setSize({ width, height: plotHeight });
      this.drawScaleBar();
    }
  }
}
