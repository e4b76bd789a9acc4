// Summary, provenance and scenario of the runs. With many runs, the table of runs has the summaries.
import { byId, element } from "./dom";
import { fewRuns, isTable } from "./page_data";
import type { Run } from "./run";
import type { State } from "./state";
import { number, words } from "./text";

const shownElsewhere = ["title", "failure", "outcome"]; // and tables

export function showTables(runs: Run[], state: State): void {
  if (runs.length <= fewRuns) byId("numbers").append(element("h2", {}, "Summary"), summaryTable(runs));
  if (runs.length <= fewRuns) showEnergies(runs);
  byId("texts").append(element("h2", {}, "Provenance"), provenanceTable(runs), element("h2", {}, "Scenario"), ...scenarios(runs, state));
}

type Row = [HTMLElement, string[]];

// Split rows into several tables side by side, as space allows.
function table(runs: Run[], rows: Row[], heads = runs.map((run) => run.name)): HTMLElement {
  const parts = Math.max(1, Math.min(Math.ceil(rows.length / 8), Math.floor(4 / (1 + runs.length)) + 1));
  const length = Math.ceil(rows.length / parts);
  const pieces = Array.from({ length: parts }, (_, i) => rows.slice(i * length, (i + 1) * length));
  return element("div", { class: "tables" }, ...pieces.map((piece) => element("div", { class: "scroll" }, onePiece(heads, piece))));
}

const longestNumber = 14; // characters; shorter texts are not broken

function onePiece(heads: string[], rows: Row[]): HTMLElement {
  const look = (text: string) => (text.length <= longestNumber ? { class: "short" } : undefined);
  const head = element("tr", {}, element("th", {}, ""), ...heads.map((head) => element("th", { scope: "col", ...look(head) }, head)));
  const body = rows.map(([name, values]) => element("tr", {}, name, ...values.map((value) => element("td", look(value), value))));
  return element("table", {}, element("thead", {}, head), element("tbody", {}, ...body));
}

function titleOf(runs: Run[], key: string): string {
  const [name, unit] = words(key);
  const isFold = key === "furrow_depth_um" && runs.every((run) => run.depthWord !== "furrow");
  return `${isFold ? "fold depth" : name}${unit === "" ? "" : `, ${unit}`}`;
}

// Quantities without a value are listed below.
function summaryTable(runs: Run[]): HTMLElement {
  if (runs.every((run) => run.data.summary === null))
    return element("p", { class: "note" }, "No summary: the run has not ended.");
  const keys = [...new Set(runs.flatMap((run) => Object.keys(run.data.summary ?? {})))].filter(
    (key) => !shownElsewhere.includes(key) && !runs.some((run) => isTable(run.data.summary?.[key])),
  );
  const isEmpty = (key: string) => runs.every((run) => (run.data.summary?.[key] ?? null) === null);
  const rows: Row[] = keys.filter((key) => !isEmpty(key)).map((key) => {
    const cells = runs.map((run) => {
      const value = run.data.summary?.[key];
      return typeof value === "number" ? number(value, 5) : value === null || value === undefined ? "–" : String(value);
    });
    return [element("th", { scope: "row", title: key }, titleOf(runs, key)), cells];
  });
  const empty = keys.filter(isEmpty).map((key) => titleOf(runs, key));
  return element("div", {}, table(runs, rows),
    element("p", { class: "note" }, empty.length > 0 ? `Without a value: ${empty.join("; ")}.` : ""));
}

// Active work, stored and dissipated energy of each law.
function showEnergies(runs: Run[]): void {
  const kinds = ["active", "stored", "dissipated"];
  for (const run of runs) {
    const byLaw = run.data.summary?.energy_by_law_nN_um as Record<string, Record<string, number>> | undefined;
    if (!byLaw || Object.keys(byLaw).length === 0) continue;
    const rows: Row[] = Object.entries(byLaw).map(([law, energies]) => [
      element("th", { scope: "row" }, law), kinds.map((kind) => (energies[kind] ? number(energies[kind]) : "")),
    ]);
    byId("numbers").append(
      element("h2", {}, `Energy by law, nN·µm${runs.length > 1 ? `: ${run.name}` : ""}`),
      element("div", { class: "scroll" }, onePiece(kinds, rows)));
  }
}

type Provenance = Record<string, string | number | null>;

function provenanceOf(run: Run): Provenance {
  return (run.data.summary?.provenance ?? {}) as Provenance;
}

// With many runs: common values; those of a run are listed with its scenario.
function provenanceTable(runs: Run[]): HTMLElement {
  const keys = [...new Set(runs.flatMap((run) => Object.keys(provenanceOf(run))))];
  const columns = runs.length > fewRuns ? runs.slice(0, 1) : runs;
  const rows: Row[] = keys
    .filter((key) => runs.length <= fewRuns || isShared(runs, key))
    .map((key) => [
      element("th", { scope: "row" }, key.replaceAll("_", " ")), columns.map((run) => String(provenanceOf(run)[key] ?? "–")),
    ]);
  return table(columns, rows, runs.length > fewRuns ? ["all runs"] : runs.map((run) => run.name));
}

function isShared(runs: Run[], key: string): boolean {
  return new Set(runs.map((run) => provenanceOf(run)[key])).size === 1;
}

function scenarios(runs: Run[], state: State): HTMLElement[] {
  const details = runs.map((run) => {
    const own = Object.entries(provenanceOf(run)).filter(([key]) => runs.length > fewRuns && !isShared(runs, key));
    const parts = own.map(([key, value]) => `${key.replaceAll("_", " ")} ${value}`);
    if (runs.length > fewRuns && run.data.every > 1) parts.push(`${run.frames.length} of ${run.data.frames_saved} snapshots are in this page`);
    const text = parts.join("; ");
    return element("details", { "data-run": run.name },
      element("summary", {}, runs.length > fewRuns ? run.name : `${run.name}: with all defaults`),
      ...(text === "" ? [] : [element("p", { class: "note" }, text)]),
      element("pre", { class: "scenario" }, run.data.scenario));
  });
  state.on(["shown"], () => details.forEach((one, i) => (one.hidden = !state.now.shown.has(runs[i].number))));
  if (runs.length <= fewRuns) return details;
  return [element("p", { class: "note" }, "With all defaults:"), element("div", { class: "scenarios" }, ...details)];
}
