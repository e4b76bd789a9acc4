// Start of the page: reads its data, shows the first picture, then plots, tables and texts.
import { CellPanel } from "./cell_panel";
import { Controls, frameTimes, save } from "./controls";
import { byId } from "./dom";
import { EmbryoViews } from "./embryo_view";
import { showFailures } from "./failure";
import { showHeadline } from "./headline";
import { colouredRegions, fewRuns, type PageData, readPageData } from "./page_data";
import { showOutcomes } from "./outcomes";
import { Plots } from "./plots";
import { Run } from "./run";
import { RunLooks } from "./run_looks";
import { RunsTable } from "./runs_table";
import { State } from "./state";
import { showSections } from "./sections";
import { showTables } from "./tables";
import { followTheme } from "./theme";

const usualPlaySeconds = 10; // for a whole run
const mostCellsWithEdges = 5000; // initially: more edges would hide the colours

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
    shell: true, marks: runs.length <= fewRuns, picked: null,
    shown: new Set(runs.map((run) => run.number)), order: runs.map((run) => run.number), pointed: null, colourBy: RunLooks.firstKey(page),
  });
}

function startClock(state: State, end: number, draw: () => void): void {
  let before = performance.now();
  const tick = (now: number) => {
    const seconds = Math.min((now - before) / 1000, 0.25); // no jump after the tab was suspended
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

function makeViews(runs: Run[], page: PageData, state: State, looks: RunLooks): EmbryoViews | null {
  if (!runs.some((run) => run.hasFrames)) {
    tell("No snapshots of the tissue; its numbers are below.");
    return null;
  }
  try {
    return new EmbryoViews(runs, page, state, looks, byId("canvases"), byId("legend") as HTMLCanvasElement);
  } catch (error) {
    console.info("no picture:", error);
    tell("The tissue cannot be drawn, since this browser has no WebGL. Plots, tables and texts below are complete.");
    byId("canvases").hidden = byId("legend").hidden = true;
    return null;
  }
}

function nameOf(runs: Run[], state: State): string {
  const shown = runs.filter((run) => state.now.shown.has(run.number));
  return shown.length > fewRuns ? `${shown.length}-runs` : shown.map((run) => run.name).join("-");
}

async function start(): Promise<void> {
  const page = readPageData();
  byId("made-by").textContent = `Made by ${page.made_by}.`;
  const regions = colouredRegions(page);
  const runs = page.runs.map((data, i) => new Run(data, i, regions));
  const state = firstState(page, runs);
  const looks = new RunLooks(runs, page, state);
  document.body.classList.toggle("many", runs.length > fewRuns);
  showHeadline(runs, page);
  showOutcomes(runs, page, state);
  const table = runs.length > 1 ? new RunsTable(runs, page, state, looks) : null;
  const views = makeViews(runs, page, state, looks);
  let plots: Plots | null = null;
  let panel: CellPanel | null = null;
  new Controls(byId("controls"), byId("timeline"), runs, page, state, {
    savePicture: views && (async () => save(`${nameOf(runs, state)}.png`, await views.picture())),
    saveTable: () =>
      save(`${nameOf(runs, state)}.csv`, new Blob([plots?.table(panel?.curves ?? []) ?? ""], { type: "text/csv" })),
    sight: () => views?.sight() ?? [1, 1, 1],
  });
  await views?.makeReady();
  showFailures(runs, state, views);
  views?.draw();
  performance.mark("first-picture");
  document.body.dataset.picture = views ? "drawn" : "none";
  await new Promise((resolve) => setTimeout(resolve)); // let the first picture appear
  plots = new Plots(runs, page, state, looks);
  if (views) panel = new CellPanel(byId("cell"), runs, page, state);
  else byId("cell").hidden = true;
  if (views) showSections(runs, page, state);
  showTables(runs, state);
  followTheme(() => {
    plots!.rebuild();
    panel?.rebuild();
    table?.rebuild();
    views?.refresh();
  });
  startClock(state, Math.max(...runs.map((run) => run.endTime)), () => views?.draw());
  document.body.dataset.ready = "true";
}

start().catch((error) => {
  tell(`Error while showing the data: ${error instanceof Error ? error.message : error}`);
  throw error;
});
