// Plots over time by uPlot: the curves of all runs over each other, tied to the page's time.
import uPlot from "uplot";
import { lineColours } from "./colour";
import { element, styleColour } from "./dom";
import type { Run } from "./run";
import type { State } from "./state";
import { number, words } from "./text";

const plotHeight = 190;
const readingTime = 250; // ms
export const plotFont = "12px system-ui, sans-serif";
const dashes: number[][] = [[], [7, 4], [2, 3], [9, 3, 2, 3]];

export interface Curve {
  name: string;
  column: string; // of series.csv, or what names it in a saved table
  run: Run;
  points: { time: number; value: number | null }[];
  colour: string;
  dash: number[];
}

export interface ChartContent {
  title: string;
  unit: string;
  curves: Curve[];
  logarithmic?: boolean; // the values' axis
}

/** The plots of series.csv: quantities of one unit and kind together, then the scenario's monitors by unit. */
export function seriesCharts(runs: Run[]): ChartContent[] {
  const groups: { title: string; columns: string[]; logarithmic?: boolean }[] = [
    { title: "Furrow depth and lips", columns: ["furrow_depth_um", "furrow_depth_below_lips_um", "lip_distance_um"] },
    { title: "Speeds of the middle and the end", columns: ["vml_speed_um_per_s", "vce_speed_um_per_s"], logarithmic: true },
    { title: "Speed ratio, end to middle", columns: ["speed_ratio"] },
    { title: "Apical areas, to those at rest", columns: ["vml_apical_area_ratio", "vce_apical_area_ratio"] },
    { title: "Displacements of the middle and the end", columns: ["vml_displacement_um", "vce_displacement_um"] },
  ];
  const monitors = new Map<string, string[]>();
  for (const run of runs)
    for (const column of run.series.columns.filter((name) => name.includes("."))) {
      const unit = words(column)[1];
      if (!monitors.get(unit)?.includes(column)) monitors.set(unit, [...(monitors.get(unit) ?? []), column]);
    }
  for (const [unit, columns] of monitors) groups.push({ title: unit === "" ? "Monitors" : `Monitors in ${unit}`, columns });
  return groups
    .map(({ title, columns, logarithmic }) => ({
      title, logarithmic, unit: words(columns[0])[1], curves: curvesOf(runs, columns),
    }))
    .filter((chart) => chart.curves.length > 0);
}

// One run: a colour a column. Several: a colour a run, a dash a column.
function curvesOf(runs: Run[], columns: string[]): Curve[] {
  return runs.flatMap((run) =>
    columns
      .filter((column) => run.series.column(column).some((value) => value !== null))
      .map((column) => {
        const place = columns.indexOf(column);
        const times = run.series.column("time_s");
        return {
          name: words(column)[0], column, run,
          points: run.series.column(column).map((value, i) => ({ time: times[i]!, value })),
          colour: runs.length > 1 ? colourOfRun(run) : lineColours[place % lineColours.length],
          dash: runs.length > 1 ? dashes[place % dashes.length] : [],
        };
      }),
  );
}

export class Chart {
  readonly box = element("figure", { class: "chart" });
  private readonly holder = element("div");
  private readonly values: HTMLElement[] = [];
  private readonly sizes = new ResizeObserver(() => this.fit());
  private readonly forget: () => void;
  private shownAt = 0; // ms
  private plot: uPlot | null = null;
  private line: TimeLine | null = null;

  constructor(readonly content: ChartContent, private readonly state: State, private logarithmicTime = false) {
    const unit = content.unit === "" ? "" : `, ${content.unit}`;
    this.box.append(element("figcaption", {}, content.title + unit), this.holder, this.legend());
    this.sizes.observe(this.holder);
    this.forget = state.on(["time", "playing"], () => this.showTime());
    this.rebuild();
  }

  /** Ends the plot: it no longer follows the page. */
  destroy(): void {
    this.forget();
    this.sizes.disconnect();
    this.plot?.destroy();
  }

  setLogarithmicTime(on: boolean): void {
    this.logarithmicTime = on;
    this.rebuild();
  }

  /** Makes the plot anew: colours of the page or scales have changed. */
  rebuild(): void {
    this.plot?.destroy();
    this.line = null;
    this.plot = new uPlot(this.options(), this.data(), this.holder);
    this.line = new TimeLine(this.plot);
    this.showTime();
  }

  private data(): uPlot.AlignedData {
    // A logarithmic axis has no place for zero and less, nor for what only rounding leaves: it would be all of the axis.
    let largest = 0;
    for (const { points } of this.content.curves)
      for (const point of points) largest = Math.max(largest, point.value ?? 0);
    const least = 1e-9 * largest;
    const tables = this.content.curves.map(({ points }) => {
      const shown = points.filter(({ time }) => !this.logarithmicTime || time > 0);
      const value = (v: number | null) => (this.content.logarithmic && v !== null && v <= least ? null : v);
      return [shown.map(({ time }) => time), shown.map((point) => value(point.value))] as uPlot.AlignedData;
    });
    return uPlot.join(tables, tables.map((table) => table.map(() => 1 as uPlot.JoinNullMode)));
  }

  private options(): uPlot.Options {
    return {
      width: Math.max(this.holder.clientWidth, 200),
      height: plotHeight,
      legend: { show: false },
      cursor: { points: { show: false }, y: false, sync: { key: "time" } },
      scales: {
        x: { time: false, distr: this.logarithmicTime ? 3 : 1 },
        y: { distr: this.content.logarithmic ? 3 : 1 },
      },
      axes: [
        timeAxis(),
        { ...timeAxis(), label: undefined, labelSize: 0, size: 56 },
      ],
      series: [
        {},
        ...this.content.curves.map(({ name, colour, dash }) => ({
          label: name, stroke: colour, dash, width: 2, spanGaps: false, points: { show: false },
        })),
      ],
      hooks: { draw: [() => this.line?.show(this.state.now.time)], ready: [(plot) => goToClicks(plot, this.state)] },
    };
  }

  // Each quantity with the values of its curves at the page's time: those of the nearest step.
  private legend(): HTMLElement {
    const list = element("ul", { class: "curves" });
    for (const name of new Set(this.content.curves.map((curve) => curve.name))) {
      const item = element("li", {}, `${name} `);
      for (const [i, curve] of this.content.curves.entries()) {
        if (curve.name !== name) continue;
        this.values[i] = element("output", { "data-column": curve.column, "data-run": curve.run.name });
        item.append(element("span", {}, sampleOf(curve), this.values[i]), " ");
      }
      list.append(item);
    }
    return list;
  }

  private showTime(): void {
    this.line?.show(this.state.now.time);
    // While time runs, numbers change as fast as they can be read.
    const now = performance.now();
    if (this.state.now.playing && now - this.shownAt < readingTime) return;
    this.shownAt = now;
    this.content.curves.forEach(({ points }, i) => {
      const { time } = this.state.now;
      let nearest = points[0];
      for (const point of points) if (Math.abs(point.time - time) < Math.abs(nearest.time - time)) nearest = point;
      this.values[i].textContent = number(nearest?.value);
    });
  }

  private fit(): void {
    const width = this.holder.clientWidth;
    if (this.plot && width > 0 && width !== this.plot.width) this.plot.setSize({ width, height: plotHeight });
  }
}

function sampleOf({ colour, dash }: { colour: string; dash: number[] }): HTMLElement {
  const sample = element("span", { class: "sample" });
  sample.style.borderTop = `3px ${dash.length > 0 ? "dashed" : "solid"} ${colour}`;
  return sample;
}

/** Which colour is which run, where there are several. */
export function runKey(runs: Run[]): HTMLElement[] {
  if (runs.length < 2) return [];
  const items = runs.map((run) => element("li", {}, sampleOf({ colour: colourOfRun(run), dash: [] }), run.name));
  return [element("ul", { class: "curves" }, ...items)];
}

function colourOfRun(run: Run): string {
  return lineColours[run.number % lineColours.length];
}

/** A click, other than a drag, goes to its time. */
export function goToClicks(plot: uPlot, state: State): void {
  let pressed = 0;
  plot.over.addEventListener("mousedown", (event) => (pressed = event.clientX));
  plot.over.addEventListener("mouseup", (event) => {
    if (Math.abs(event.clientX - pressed) > 3) return;
    const time = plot.posToVal(event.clientX - plot.over.getBoundingClientRect().left, "x");
    state.set({ time, playing: false });
  });
}

/** The axis of time, as all plots have it. */
export function timeAxis(): uPlot.Axis {
  return {
    stroke: styleColour("ink"), grid: { stroke: styleColour("grid"), width: 1 }, ticks: { stroke: styleColour("grid") },
    label: "time, s", labelSize: 16, size: 34, labelGap: 0, font: plotFont, labelFont: plotFont,
  };
}

/** A line over the plot at the page's time: an element of its own, so that it moves without the plot being drawn. */
export class TimeLine {
  private readonly line = element("div", { class: "time-line" });

  constructor(private readonly plot: uPlot) {
    plot.over.append(this.line);
  }

  show(time: number): void {
    const x = this.plot.valToPos(time, "x");
    this.line.hidden = !(x >= 0 && x <= this.plot.over.clientWidth);
    this.line.style.transform = `translateX(${x}px)`;
  }
}
