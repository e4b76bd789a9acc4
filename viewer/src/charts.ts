// Plots over time (uPlot): curves of all runs, linked to the time of the page.
import uPlot from "uplot";
import { lineColours } from "./colour";
import { element, styleColour } from "./dom";
import { plotFont } from "./fonts";
import { fewRuns } from "./page_data";
import type { Run } from "./run";
import { type LineLook, type RunLooks, sampleOf } from "./run_looks";
import { pointWith, type State } from "./state";
import { number, words } from "./text";

const plotHeight = 190;
const readingTime = 250; // ms
const pointingReach = 30; // pixels from the pointer to a curve
const faded = 0.15; // opacity of other curves
const dashes: number[][] = [[], [7, 4], [2, 3], [9, 3, 2, 3]];

interface Point {
  time: number;
  value: number | null;
}

export interface Curve {
  name: string;
  column: string; // of series.csv, or name in a saved table
  run: Run;
  points: Point[];
  look: () => LineLook;
}

export interface ChartContent {
  title: string;
  unit: string;
  curves: Curve[];
  logarithmic?: boolean; // axis of values
}

interface Group {
  title: string;
  columns: string[];
  of: (run: Run, isFew: boolean) => boolean; // runs that it describes
  names?: string[]; // of the columns
  logarithmic?: boolean;
}

const ofFurrow = (run: Run) => run.depthWord === "furrow";
const ofFold = (run: Run) => run.depthWord === "fold";
const ofOther = (run: Run) => run.depthWord !== "furrow";
const ofFew = (run: Run, isFew: boolean) => isFew || ofOther(run);

const usualGroups: Group[] = [
  { title: "Furrow depth and borders", of: ofFurrow, columns: ["furrow_depth_um", "furrow_depth_below_lips_um", "lip_distance_um"] },
  { title: "Speeds: furrow centre (VML), near its end (VCE)", of: ofFurrow, columns: ["vml_speed_um_per_s", "vce_speed_um_per_s"], logarithmic: true },
  { title: "Speed ratio, VCE / VML", of: ofFurrow, columns: ["speed_ratio"] },
  { title: "Apical area / reference area", of: ofFurrow, columns: ["vml_apical_area_ratio", "vce_apical_area_ratio"] },
  { title: "Displacements: VML and VCE", of: ofFurrow, columns: ["vml_displacement_um", "vce_displacement_um"] },
  { title: "Fold depth", of: ofFold, columns: ["furrow_depth_um"], names: ["fold depth"] },
  { title: "Largest displacement", of: ofOther, columns: ["max_displacement_um"] },
  { title: "Largest speed of a node", of: ofOther, columns: ["max_node_speed_um_per_s"], logarithmic: true },
  { title: "Smallest apical area / reference area", of: ofOther, columns: ["min_apical_area_ratio"] },
  { title: "Mean cell height", of: ofOther, columns: ["mean_height_um"] },
  { title: "Number of cells", of: ofFew, columns: ["cells"] },
  { title: "Volume / reference volume", of: ofOther, columns: ["tissue_volume_ratio", "lumen_volume_ratio"], names: ["cells", "lumen"] },
  { title: "Pressure of the enclosed volume", of: ofFew, columns: ["yolk_pressure_Pa"] },
  { title: "Energy", of: ofFew, columns: ["active_work_nN_um", "stored_energy_nN_um", "dissipated_energy_nN_um"] },
];

function monitorGroups(runs: Run[]): Group[] {
  const monitors = new Map<string, string[]>();
  for (const run of runs)
    for (const column of run.series.columns.filter((name) => name.includes("."))) {
      const unit = words(column)[1];
      if (!monitors.get(unit)?.includes(column)) monitors.set(unit, [...(monitors.get(unit) ?? []), column]);
    }
  return [...monitors.values()].map((columns) => ({ title: "Monitors", of: () => true, columns }));
}

/** The plots of series.csv that fit the tissue and change: quantities of one unit and kind together, then the scenario's
 * monitors by unit; with many runs, one plot per quantity. */
export function seriesCharts(runs: Run[], looks: RunLooks): ChartContent[] {
  let groups = [...usualGroups, ...monitorGroups(runs)];
  const isFew = runs.length <= fewRuns;
  if (!isFew)
    groups = groups.flatMap(({ columns, names, ...rest }) =>
      columns.map((column, i) => ({ ...rest, title: capital(names?.[i] ?? words(column)[0]), columns: [column] })));
  return groups
    .map(({ title, columns, names, of, logarithmic }) => ({
      title, logarithmic, unit: words(columns[0])[1],
      curves: curvesOf(runs.filter((run) => of(run, isFew)), columns, names, looks, runs.length === 1),
    }))
    .filter((chart) => chart.curves.length > 0);
}

function capital(text: string): string {
  return text.charAt(0).toUpperCase() + text.slice(1);
}

// Whether a column has values, and monitors apart, more than rounding errors of one value.
function changes(run: Run, column: string): boolean {
  const values = run.series.column(column).filter((value) => value !== null);
  const [least, greatest] = [values.reduce((a, b) => Math.min(a, b), Infinity), values.reduce((a, b) => Math.max(a, b), -Infinity)];
  return values.length > 0 && (column.includes(".") || greatest - least > 1e-6 * Math.max(Math.abs(least), Math.abs(greatest)));
}

// One run: one colour per column. Several: one colour per run, one dash pattern per column.
function curvesOf(runs: Run[], columns: string[], names: string[] | undefined, looks: RunLooks, isAlone: boolean): Curve[] {
  return runs.flatMap((run) =>
    columns
      .filter((column) => changes(run, column))
      .map((column) => {
        const place = columns.indexOf(column);
        const times = run.series.column("time_s");
        return {
          name: names?.[place] ?? words(column)[0], column, run,
          points: run.series.column(column).map((value, i) => ({ time: times[i]!, value })),
          look: () => {
            if (isAlone) return { colour: lineColours[place % lineColours.length], dash: [] };
            const look = looks.lookOf(run);
            return columns.length === 1 ? look : { ...look, dash: dashes[place % dashes.length] };
          },
        };
      }),
  );
}

export class Chart {
  readonly box = element("figure", { class: "chart" });
  private readonly holder = element("div");
  private readonly pointedValue = element("span", { class: "pointed-value" });
  private readonly legend = element("ul", { class: "curves" });
  private values: HTMLElement[] = [];
  private readonly many: boolean;
  private readonly sizes = new ResizeObserver(() => this.fit());
  private readonly forget: (() => void)[];
  private shownAt = 0; // ms
  private plot: uPlot | null = null;
  private line: TimeLine | null = null;

  constructor(public content: ChartContent, private readonly state: State, private logarithmicTime = false) {
    this.many = new Set(content.curves.map((curve) => curve.run)).size > fewRuns;
    const unit = content.unit === "" ? "" : `, ${content.unit}`;
    this.box.append(element("figcaption", {}, content.title + unit, this.pointedValue), this.holder, this.legend);
    this.legend.hidden = this.many; // the table of runs serves all plots
    this.sizes.observe(this.holder);
    this.forget = [
      state.on(["time", "playing"], () => this.showTime()),
      state.on(["shown"], () => this.rebuild()),
      state.on(["colourBy"], () => this.rebuild()),
      state.on(["pointed"], () => this.showPointed()),
    ];
    this.rebuild();
  }

  /** Remove the plot; it no longer follows the page. */
  destroy(): void {
    for (const forget of this.forget) forget();
    this.sizes.disconnect();
    this.plot?.destroy();
  }

  /** Show other points of the same curves; false, and no change, where the curves are others. */
  take(content: ChartContent): boolean {
    const named = ({ title, curves }: ChartContent) => JSON.stringify([title, ...curves.map(({ name, column, run }) =>
      [name, column, run.number, run.name])]);
    if (named(content) !== named(this.content)) return false;
    this.content = content;
    this.plot!.setData(this.data());
    this.showTime();
    return true;
  }

  setLogarithmicTime(on: boolean): void {
    this.logarithmicTime = on;
    this.rebuild();
  }

  /** Rebuild the plot after a change of colours, scales or visible runs. */
  rebuild(): void {
    this.plot?.destroy();
    this.line = null;
    this.fillLegend();
    this.plot = new uPlot(this.options(), this.data(), this.holder);
    this.line = new TimeLine(this.plot);
    const { plot } = this;
    if (this.many) pointWith(plot.over, (event) => this.runNear(plot, event), this.state);
    this.showTime();
    this.showPointed();
  }

  private isShown({ run }: Curve): boolean {
    return this.state.now.shown.has(run.number);
  }

  private data(): uPlot.AlignedData {
    // A logarithmic axis excludes zero and less, and rounding errors, which would fill it.
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
      padding: plotPadding,
      legend: { show: false },
      cursor: { points: { show: false }, y: false, sync: { key: "time" } },
      scales: { x: timeScale(this.logarithmicTime), y: { distr: this.content.logarithmic ? 3 : 1 } },
      axes: [timeAxis(this.logarithmicTime), valueAxis()],
      series: [
        {},
        ...this.content.curves.map((curve) => {
          const { colour, dash } = curve.look();
          return {
            label: curve.name, stroke: colour, dash, width: this.many ? 1.5 : 2, spanGaps: false, points: { show: false },
            show: this.isShown(curve),
          };
        }),
      ],
      hooks: { draw: [() => this.line?.show(this.state.now.time)], ready: [(plot) => goToClicks(plot, this.state)] },
    };
  }

  // Each quantity with the values of its curves at the time of the page (nearest step).
  private fillLegend(): void {
    this.legend.replaceChildren();
    this.values = [];
    if (this.many) return;
    for (const name of new Set(this.content.curves.map((curve) => curve.name))) {
      const item = element("li", {}, `${name} `);
      for (const [i, curve] of this.content.curves.entries()) {
        if (curve.name !== name) continue;
        this.values[i] = element("output", { "data-column": curve.column, "data-run": curve.run.name });
        const part = element("span", {}, sampleOf(curve.look()), this.values[i]);
        part.hidden = !this.isShown(curve);
        item.append(part, " ");
      }
      this.legend.append(item);
    }
  }

  private showTime(): void {
    this.line?.show(this.state.now.time);
    // While time runs, numbers change no faster than they can be read.
    const now = performance.now();
    if (this.state.now.playing && now - this.shownAt < readingTime) return;
    this.shownAt = now;
    this.values.forEach((output, i) => {
      output.textContent = number(nearestPoint(this.content.curves[i].points, this.state.now.time)?.value);
    });
    this.showPointedValue();
  }

  private showPointed(): void {
    const { pointed } = this.state.now;
    if (!this.plot || !this.many) return;
    const known = this.content.curves.some((curve) => curve.run.number === pointed && this.isShown(curve));
    this.content.curves.forEach(({ run }, i) => {
      this.plot!.series[i + 1].alpha = !known || run.number === pointed ? 1 : faded;
    });
    this.plot.redraw(false, false);
    this.showPointedValue();
  }

  private showPointedValue(): void {
    const { pointed, time } = this.state.now;
    const curve = this.many && this.content.curves.find(({ run }) => run.number === pointed);
    this.pointedValue.textContent = curve ? `${curve.run.name}: ${number(nearestPoint(curve.points, time)?.value)}` : "";
  }

  private runNear(plot: uPlot, { clientX, clientY }: MouseEvent): number | null {
    const { left, top } = plot.over.getBoundingClientRect();
    const time = plot.posToVal(clientX - left, "x");
    let [nearest, least]: [number | null, number] = [null, pointingReach];
    for (const curve of this.content.curves) {
      const value = this.isShown(curve) ? nearestPoint(curve.points, time)?.value : null;
      if (value === null || value === undefined) continue;
      const distance = Math.abs(plot.valToPos(value, "y") - (clientY - top));
      if (distance < least) [nearest, least] = [curve.run.number, distance];
    }
    return nearest;
  }

  private fit(): void {
    const width = this.holder.clientWidth;
    if (this.plot && width > 0 && width !== this.plot.width) this.plot.setSize({ width, height: plotHeight });
  }
}

// Times increase.
function nearestPoint(points: Point[], time: number): Point | undefined {
  let [low, high] = [0, points.length - 1];
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (points[middle].time <= time) low = middle;
    else high = middle;
  }
  if (high < 0) return undefined;
  return Math.abs(points[high].time - time) < Math.abs(points[low].time - time) ? points[high] : points[low];
}

// Powers of ten, with 2 and 5 between them if there is space.
function labelledPlaces(plot: uPlot, places: number[]): (number | null)[] {
  const decade = Math.abs(plot.valToPos(10, "x") - plot.valToPos(1, "x"));
  const digits = decade >= 130 ? /^[125]/ : /^1/;
  const every = Math.ceil(40 / decade); // interval of powers
  const power = (place: number) => Math.floor(Math.log10(place) + 1e-9);
  return places.map((place) => (digits.test(place.toExponential()) && power(place) % every === 0 ? place : null));
}

/** Padding above and to the right of a plot, for labels that extend beyond its ends. */
export const plotPadding: uPlot.Padding = [10, 20, 0, 0];

/** Time range of the plot, from the first to the last time. */
export function timeScale(logarithmic: boolean): uPlot.Scale {
  return {
    time: false, distr: logarithmic ? 3 : 1,
    range: (_, least, greatest) => (least === greatest ? [least / 2, 2 * greatest || 1] : [least, greatest]),
  };
}

// uPlot's own ticks start at the least time, whatever number that is.
function logarithmicPlaces(least: number, greatest: number): number[] {
  const places: number[] = [];
  for (let power = Math.floor(Math.log10(least)); 10 ** power <= greatest; ++power)
    for (let digit = 1; digit < 10; ++digit) places.push(Number(`${digit}e${power}`));
  return places.filter((place) => place >= least && place <= greatest);
}

const measuring = element("canvas").getContext("2d")!;

/** Axis of values, as wide as its longest label. */
export function valueAxis(): uPlot.Axis {
  return {
    ...timeAxis(), label: undefined, labelSize: 0,
    size: (_, labels) => {
      measuring.font = plotFont;
      const widths = (labels ?? []).map((label) => (label === null ? 0 : measuring.measureText(label).width));
      return Math.ceil(Math.max(20, ...widths)) + 18; // for the tick and its gap
    },
  };
}

/** Set the time by clicks that are not drags. */
export function goToClicks(plot: uPlot, state: State): void {
  let pressed = 0;
  plot.over.addEventListener("mousedown", (event) => (pressed = event.clientX));
  plot.over.addEventListener("mouseup", (event) => {
    if (Math.abs(event.clientX - pressed) > 3) return;
    const time = plot.posToVal(event.clientX - plot.over.getBoundingClientRect().left, "x");
    state.set({ time, playing: false });
  });
}

/** Time axis of all plots. */
export function timeAxis(logarithmic = false): uPlot.Axis {
  return {
    ...(logarithmic && {
      splits: (_, __, least, greatest) => logarithmicPlaces(least, greatest), filter: labelledPlaces,
    }),
    stroke: styleColour("ink"), grid: { stroke: styleColour("grid"), width: 1 }, ticks: { stroke: styleColour("grid") },
    values: (_, places, __, ___, step) => labelsOf(places, step),
    label: "time, s", labelSize: 16, size: 34, labelGap: 0, font: plotFont, labelFont: plotFont,
  };
}

// With as many digits as distinguish the ticks.
function labelsOf(places: (number | null)[], step: number): string[] {
  const largest = Math.max(...places.map((place) => Math.abs(place ?? 0)));
  const digits = Math.ceil(Math.log10(largest / step)) + 1;
  return places.map((place) => (place === null ? "" : number(place, Math.min(Math.max(digits, 4) || 4, 14))));
}

/** Line at the time of the page; a separate element, so that it moves without redrawing the plot. */
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
