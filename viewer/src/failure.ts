// Runs that failed: what, where and when, at the head of the page, with buttons that show the cell.
import { byId, element } from "./dom";
import type { EmbryoViews } from "./embryo_view";
import { fewRuns } from "./page_data";
import type { Run } from "./run";
import type { State } from "./state";
import { time } from "./text";

const mostShown = fewRuns;

export function showFailures(runs: Run[], state: State, views: EmbryoViews | null): void {
  const failed = runs.filter((run) => run.failed);
  if (failed.length === 0) return;
  const notice = byId("failure");
  notice.hidden = false;
  for (const run of failed.slice(0, mostShown)) notice.append(lineOf(run, runs.length > 1, state, views));
  if (failed.length > mostShown) notice.append(element("p", {}, `… and ${failed.length - mostShown} more runs failed (see their status).`));
  const [first] = failed;
  if (views && runs.length === 1 && first.hasFrames && first.failedCell !== null) void views.lookAtCell(first, first.failedCell);
}

function lineOf(run: Run, named: boolean, state: State, views: EmbryoViews | null): HTMLElement {
  const { failure, time_s: at } = run.data.summary!;
  const line = element("p", {},
    element("strong", {}, `${named ? `${run.name} failed` : "Failed"} at ${time(Number(at))}: `), `${failure ?? "no reason is known"}. `);
  const cell = run.failedCell;
  if (cell === null || !views || !run.hasFrames) return line;
  const show = element("button", { type: "button", "data-cell": String(cell) }, `Show cell ${cell}`);
  show.addEventListener("click", () => void views.lookAtCell(run, cell));
  const whole = element("button", { type: "button", "data-whole": "" }, "Show the whole tissue");
  whole.addEventListener("click", () => state.set({ view: { ...state.now.view } }));
  line.append(show, " ", whole);
  return line;
}
