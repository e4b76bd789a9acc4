// What stands above all else: of what the page is, how it ended, and warnings.
import { byId } from "./dom";
import { fewRuns, type PageData } from "./page_data";
import type { Run } from "./run";
import { number, words } from "./text";

export function showHeadline(runs: Run[], page: PageData): void {
  byId("title").textContent = [...new Set(runs.map((run) => run.title))].join(" | ");
  byId("headline").textContent = runs.length > fewRuns ? manyRuns(runs, page) : runs.map((run) => oneRun(run, runs.length > 1)).join("; ");
  showCrossings(runs);
  showThinning(runs);
}

function oneRun(run: Run, named: boolean): string {
  const summary = run.data.summary;
  if (!summary) return `${run.name}: not finished`;
  const crossing = Number(summary.self_intersections ?? 0) > 0 ? ", passes through itself" : "";
  const depth = typeof summary.furrow_depth_um === "number" ? `, furrow ${number(summary.furrow_depth_um)} µm deep` : "";
  return `${named ? `${run.name}: ` : ""}${summary.cells} cells, ${summary.status} at ${number(Number(summary.time_s) / 60)} min${depth}${crossing}`;
}

function manyRuns(runs: Run[], page: PageData): string {
  const parts = [`${runs.length} runs`];
  const keys = page.varied.map(({ key }) => words(key.slice(key.lastIndexOf(".") + 1))[0]);
  if (keys.length > 0) parts.push(`differ in ${keys.slice(0, 4).join(", ")}${keys.length > 4 ? ` and ${keys.length - 4} more keys` : ""}`);
  const depths = runs.map((run) => run.data.summary?.furrow_depth_um).filter((depth) => typeof depth === "number");
  if (depths.length > 0) parts.push(`furrows ${number(Math.min(...depths), 3)} to ${number(Math.max(...depths), 3)} µm deep`);
  const unfinished = runs.filter((run) => !run.data.summary).length;
  if (unfinished > 0) parts.push(`${unfinished} not finished`);
  return parts.join("; ");
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
  const names = new Map<string, string[]>();
  for (const { name, frames, data } of runs) {
    if (data.every <= 1) continue;
    const text = `${frames.length} of ${data.frames_saved} saved frames are in this page (every ` +
      `${data.every === 2 ? "2nd" : `${data.every}th`}, the last, and those on both sides of a division), so that it stays small.`;
    names.set(text, [...(names.get(text) ?? []), name]);
  }
  byId("thinned").textContent = [...names]
    .map(([text, of]) => `${of.length <= 3 ? of.join(", ") : `${of.length} runs, each`}: ${text}`)
    .join(" ");
}
