// Headline of the page: title, status, and warnings.
import { byId, element } from "./dom";
import { fewRuns, type PageData } from "./page_data";
import type { Run } from "./run";
import { number, time, words } from "./text";

export function showHeadline(runs: Run[], page: PageData): void {
  byId("title").textContent = page.outcomes?.title ?? [...new Set(runs.map((run) => run.title))].join(" | ");
  byId("headline").textContent = runs.length > fewRuns ? manyRuns(runs, page) : runs.map((run) => oneRun(run, runs.length > 1)).join("; ");
  showCrossings(runs);
  showWarnings(runs);
  showThinning(runs);
}

function oneRun(run: Run, named: boolean): string {
  const summary = run.data.summary;
  if (!summary) return `${run.name}: not finished`;
  const crossing = Number(summary.self_intersections ?? 0) > 0 ? ", self-intersecting" : "";
  return `${named ? `${run.name}: ` : ""}${summary.cells} cells, ${String(summary.status).replaceAll("_", " ")} at ${time(Number(summary.time_s))}${outcomeOf(run)}${crossing}`;
}

// What the tissue did.
function outcomeOf(run: Run): string {
  const { furrow_depth_um: depth, lips_closed_time_s: closed_s, outcome } = run.data.summary!;
  if (run.depthWord !== "furrow") return typeof outcome === "string" && outcome !== "" ? `, ${outcome.replaceAll(" um", " µm").replaceAll(" -", " −")}` : "";
  const closed = typeof closed_s === "number" ? `, closed at ${time(closed_s)}` : "";
  return typeof depth === "number" ? `, furrow ${number(depth)} µm deep${closed}` : "";
}

function manyRuns(runs: Run[], page: PageData): string {
  const parts = [`${runs.length} runs`];
  const keys = page.varied.map(({ key }) => words(key.slice(key.lastIndexOf(".") + 1))[0]);
  if (keys.length > 0) parts.push(`differ in ${keys.slice(0, 4).join(", ")}${keys.length > 4 ? ` and ${keys.length - 4} more keys` : ""}`);
  const ended = runs.filter((run) => !run.failed && run.depthWord !== "");
  const depths = ended.map((run) => run.data.summary?.furrow_depth_um).filter((depth) => typeof depth === "number");
  if (depths.length > 0) parts.push(`${ended.every((run) => run.depthWord === "fold") ? "folds" : "furrows"} ${number(Math.min(...depths), 3)} to ${number(Math.max(...depths), 3)} µm deep`);
  const failed = runs.filter((run) => run.failed).length;
  if (failed > 0) parts.push(`${failed} failed`);
  const unfinished = runs.filter((run) => !run.data.summary).length;
  if (unfinished > 0) parts.push(`${unfinished} not finished`);
  return parts.join("; ");
}

// Warn first about self-intersections, with their time: later results are unphysical.
function showCrossings(runs: Run[]): void {
  const since = runs.flatMap((run) => {
    const first = run.series.column("self_intersections").findIndex((pairs) => (pairs ?? 0) > 0);
    return first < 0 ? [] : [{ name: run.name, minutes: (run.series.column("time_s")[first] ?? 0) / 60 }];
  });
  if (since.length === 0) return;
  const notice = byId("crossing");
  const first = number(Math.min(...since.map(({ minutes }) => minutes)));
  const when = since.length > fewRuns
    ? `In ${since.length} of ${runs.length} runs (see their status), the first from ${first} min`
    : since.map(({ name, minutes }) => `${runs.length > 1 ? `${name}: from` : "From"} ${number(minutes)} min`).join("; ");
  notice.textContent = `${when} on, the tissue self-intersects; later results are unphysical. Colour by “self-intersecting” to see where.`;
  notice.hidden = false;
}

// Other reasons to doubt the results.
function showWarnings(runs: Run[]): void {
  const warned = runs.map(({ name, data }) => ({ name, texts: Object.values((data.summary?.warnings ?? {}) as Record<string, string>) }))
    .filter(({ texts }) => texts.length > 0);
  if (warned.length === 0) return;
  const notice = byId("warnings");
  const lines = warned.length > fewRuns
    ? [`${warned.length} of ${runs.length} runs have warnings (see warnings in their summary.json).`]
    : warned.flatMap(({ name, texts }) => texts.map((text) => `${runs.length > 1 ? `${name}: ` : "Warning: "}${text}.`));
  notice.append(...lines.map((line) => element("p", {}, line)));
  notice.hidden = false;
}

function showThinning(runs: Run[]): void {
  const thinned = runs.filter((run) => run.data.every > 1);
  if (thinned.length === 0) return;
  // With many runs, the number of snapshots of each is listed with its scenario.
  const which = thinned.length > fewRuns
    ? `This page shows only some snapshots of ${thinned.length} of ${runs.length} runs`
    : thinned.map(({ name, frames, data }) => `${name}: this page has ${frames.length} of ${data.frames_saved} snapshots`).join("; ");
  const steps = [...new Set(thinned.map((run) => run.data.every))].sort((a, b) => a - b);
  byId("thinned").textContent = `${which} (every ${steps.map((every) => (every === 2 ? "2nd" : `${every}th`)).join(" or ")}, ` +
    "the last, and those around a division) to limit its size.";
}
