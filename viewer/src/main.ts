// The page begins here: reads its data, shows the first picture, then plots, tables and texts.
import { CellPanel } from "./cell_panel";
import { Chart, runKey, seriesCharts } from "./charts";
import { Controls, frameTimes, save } from "./controls";
import { byId, element } from "./dom";
import { EmbryoViews } from "./embryo_view";
import { Kymograph, midlineQuantities } from "./kymograph";
import { type PageData, readPageData } from "./page_data";
import { Run } from "./run";
import { State } from "./state";
import { csvText } from "./table";
import { showTables } from "./tables";
import { number, words } from "./text";

const usualPlaySeconds = 10; // for a whole run
const mostCellsWithEdges = 5000; // at first: of more, edges would hide the colours

function tell(problem: string): void {
  const notice = byId("problem");
  notice.textContent = problem;
  notice.hidden = false;
}

function firstState(page: PageData, runs: Run[]): State {
  const times = frameTimes(runs);
  const duration = (times.at(-1) ?? 0) - (times[0] ?? 0);
  return new State({
    time: times.at(-1) ?? 0, playing: false, speed: Number(Math.max(duration / usualPlaySeconds, 1).toPrecision(2)),
    field: page.fields[0], view: page.views[0], cut: null,
    edges: runs.every((run) => run.topologies.every((topology) => topology.cells <= mostCellsWithEdges)),
    shell: true, marks: true, picked: null,
  });
}

function showHeadline(runs: Run[]): void {
  byId("title").textContent = runs.map((run) => run.title).join(" | ");
  const parts = runs.map((run) => {
    const summary = run.data.summary;
    if (!summary) return `${run.name}: not finished`;
    const crossing = Number(summary.self_intersections ?? 0) > 0 ? ", passes through itself" : "";
    const depth = typeof summary.furrow_depth_um === "number" ? `, furrow ${number(summary.furrow_depth_um)} µm deep` : "";
    return `${runs.length > 1 ? `${run.name}: ` : ""}${summary.cells} cells, ${summary.status} at ${number(Number(summary.time_s) / 60)} min${depth}${crossing}`;
  });
  byId("headline").textContent = parts.join("; ");
}

// A tissue that has passed through itself is none any more: since when, before all else.
function showCrossings(runs: Run[]): void {
  const since = runs.flatMap((run) => {
    const first = run.series.column("self_intersections").findIndex((pairs) => (pairs ?? 0) > 0);
    if (first < 0) return [];
    return [`${runs.length > 1 ? `${run.name}: from` : "From"} ${number((run.series.column("time_s")[first] ?? 0) / 60)} min`];
  });
  if (since.length === 0) return;
  const notice = byId("crossing");
  notice.textContent = `${since.join("; ")} on, the tissue passes through itself: colour it by “passes through itself” to see where. What comes after is no tissue any more.`;
  notice.hidden = false;
}

function showThinning(runs: Run[]): void {
  const thinned = runs.filter((run) => run.data.every > 1);
  byId("thinned").textContent = thinned
    .map((run) => `${run.name}: ${run.frames.length} of ${run.data.frames_saved} saved frames are in this page (every ` +
      `${run.data.every === 2 ? "2nd" : `${run.data.every}th`}, the last, and those on both sides of a division), so that it stays small.`)
    .join(" ");
}

// Everything that follows the first picture.
class Plots {
  readonly charts: Chart[];
  private readonly kymographs: Kymograph[];

  constructor(runs: Run[], page: PageData, state: State) {
    this.charts = seriesCharts(runs).map((content) => new Chart(content, state));
    const logarithmic = element("input", { type: "checkbox", id: "logarithmic-time" });
    byId("plots").append(
      element("h2", {}, "Over time"),
      element("label", {}, logarithmic, " logarithmic time"),
      ...runKey(runs),
      element("div", { class: "charts" }, ...this.charts.map((chart) => chart.box)),
    );
    const withMidline = runs.filter((run) => run.midline.rows.length > 0);
    this.kymographs = withMidline.map((run) => new Kymograph(run, withMidline, page, state, midlineQuantities[0]));
    if (withMidline.length > 0) this.showMidline();
    logarithmic.addEventListener("change", () => {
      for (const plot of [...this.charts, ...this.kymographs]) plot.setLogarithmicTime(logarithmic.checked);
    });
  }

  rebuild(): void {
    for (const plot of [...this.charts, ...this.kymographs]) plot.rebuild();
  }

  /** The plotted series as one table: a row a step a run; and a row a frame of what else is plotted. */
  table(more: { run: Run; column: string; points: { time: number; value: number | null }[] }[]): string {
    const curves = [...this.charts.flatMap((chart) => chart.content.curves), ...more];
    const columns = [...new Set(curves.map((curve) => curve.column))];
    const rows = new Map<string, string[]>();
    for (const { run, column, points } of curves)
      for (const { time, value } of points) {
        const key = `${run.number} ${time}`;
        if (!rows.has(key)) rows.set(key, [csvText(run.name), String(time), ...columns.map(() => "")]);
        rows.get(key)![2 + columns.indexOf(column)] = value === null ? "" : String(value);
      }
    const lines = [...rows.values()].map((row) => row.join(","));
    return [`run,time_s,${columns.join(",")}`, ...lines].join("\n") + "\n";
  }

  private showMidline(): void {
    const select = element("select", { id: "midline-quantity" });
    for (const quantity of midlineQuantities) select.append(element("option", { value: quantity }, words(quantity)[0]));
    select.addEventListener("change", () => this.kymographs.forEach((plot) => plot.show(select.value)));
    byId("midline").append(
      element("h2", {}, "The midline over place and time"),
      element("label", {}, "Colour ", select),
      element("div", { class: "charts" }, ...this.kymographs.map((plot) => plot.box)),
    );
  }
}

function followTheme(redraw: () => void): void {
  const root = document.documentElement;
  const dark = matchMedia("(prefers-color-scheme: dark)");
  byId("theme").addEventListener("click", () => {
    const isDark = root.dataset.theme ? root.dataset.theme === "dark" : dark.matches;
    root.dataset.theme = isDark ? "light" : "dark";
    redraw();
  });
  dark.addEventListener("change", redraw);
}

function startClock(state: State, end: number, draw: () => void): void {
  let before = performance.now();
  const tick = (now: number) => {
    const seconds = Math.min((now - before) / 1000, 0.25); // a tab that slept does not jump
    before = now;
    if (state.now.playing) {
      const time = Math.min(state.now.time + seconds * state.now.speed, end);
      state.set({ time, playing: time < end });
    }
    draw();
    requestAnimationFrame(tick);
  };
  requestAnimationFrame(tick);
}

function makeViews(runs: Run[], page: PageData, state: State): EmbryoViews | null {
  if (!runs.some((run) => run.hasFrames)) {
    tell("There are no frames to show the embryo by; its numbers are below.");
    return null;
  }
  try {
    return new EmbryoViews(runs, page, state, byId("canvases"), byId("legend") as HTMLCanvasElement);
  } catch (error) {
    console.info("no picture:", error);
    tell("This browser offers no WebGL, so the embryo cannot be drawn. Plots, tables and texts below are complete.");
    byId("canvases").hidden = byId("legend").hidden = true;
    return null;
  }
}

async function start(): Promise<void> {
  const page = readPageData();
  byId("made-by").textContent = `Made by ${page.made_by}.`;
  const runs = await Promise.all(page.runs.map((data, i) => Run.read(data, i)));
  const state = firstState(page, runs);
  showHeadline(runs);
  showCrossings(runs);
  showThinning(runs);
  const views = makeViews(runs, page, state);
  let plots: Plots | null = null;
  let panel: CellPanel | null = null;
  new Controls(byId("controls"), byId("timeline"), runs, page, state, {
    savePicture: views && (async () => save(`${runs.map((run) => run.name).join("-")}.png`, await views.picture())),
    saveTable: () =>
      save(`${runs.map((run) => run.name).join("-")}.csv`, new Blob([plots?.table(panel?.curves ?? []) ?? ""], { type: "text/csv" })),
    sight: () => views?.sight() ?? [1, 1, 1],
  });
  views?.draw();
  performance.mark("first-picture");
  document.body.dataset.picture = views ? "drawn" : "none";
  await new Promise((resolve) => setTimeout(resolve)); // the first picture goes to the screen
  plots = new Plots(runs, page, state);
  if (views) panel = new CellPanel(byId("cell"), runs, page, state);
  else byId("cell").hidden = true;
  showTables(runs);
  followTheme(() => {
    plots!.rebuild();
    panel?.rebuild();
    views?.refresh();
  });
  startClock(state, Math.max(...runs.map((run) => run.endTime)), () => views?.draw());
  document.body.dataset.ready = "true";
}

start().catch((error) => {
  tell(`The page cannot show its data: ${error instanceof Error ? error.message : error}`);
  throw error;
});
