// Numbers and texts of the runs: summary, provenance, scenario.
import { byId, element } from "./dom";
import type { Run } from "./run";
import { number, words } from "./text";

const shownElsewhere = ["title", "provenance"];

export function showTables(runs: Run[]): void {
  byId("numbers").append(element("h2", {}, "Summary"), summaryTable(runs));
  byId("texts").append(element("h2", {}, "Provenance"), provenanceTable(runs), element("h2", {}, "Scenario"), ...scenarios(runs));
}

type Row = [HTMLElement, string[]];

// The rows in a few tables beside each other, as many as have room.
function table(runs: Run[], rows: Row[]): HTMLElement {
  const parts = Math.max(1, Math.min(Math.ceil(rows.length / 8), Math.floor(4 / (1 + runs.length)) + 1));
  const length = Math.ceil(rows.length / parts);
  const pieces = Array.from({ length: parts }, (_, i) => rows.slice(i * length, (i + 1) * length));
  return element("div", { class: "tables" }, ...pieces.map((piece) => element("div", { class: "scroll" }, onePiece(runs, piece))));
}

function onePiece(runs: Run[], rows: Row[]): HTMLElement {
  const head = element("tr", {}, element("th", {}, ""), ...runs.map((run) => element("th", { scope: "col" }, run.name)));
  const body = rows.map(([name, values]) => element("tr", {}, name, ...values.map((value) => element("td", {}, value))));
  return element("table", {}, element("thead", {}, head), element("tbody", {}, ...body));
}

function summaryTable(runs: Run[]): HTMLElement {
  if (runs.every((run) => run.data.summary === null))
    return element("p", { class: "note" }, "There is no summary: the run has not come to its end.");
  const keys = [...new Set(runs.flatMap((run) => Object.keys(run.data.summary ?? {})))].filter(
    (key) => !shownElsewhere.includes(key),
  );
  return table(runs, keys.map((key) => {
    const [name, unit] = words(key);
    const cells = runs.map((run) => {
      const value = run.data.summary?.[key];
      return typeof value === "number" ? number(value, 5) : value === null || value === undefined ? "–" : String(value);
    });
    return [element("th", { scope: "row", title: key }, unit === "" ? name : `${name}, ${unit}`), cells];
  }));
}

function provenanceTable(runs: Run[]): HTMLElement {
  const of = (run: Run) => (run.data.summary?.provenance ?? {}) as Record<string, string | number | null>;
  const keys = [...new Set(runs.flatMap((run) => Object.keys(of(run))))];
  return table(runs, keys.map((key) => [
    element("th", { scope: "row" }, key.replaceAll("_", " ")), runs.map((run) => String(of(run)[key] ?? "–")),
  ]));
}

function scenarios(runs: Run[]): HTMLElement[] {
  return runs.map((run) =>
    element("details", {},
      element("summary", {}, `${run.name}: as resolved, every default filled in`),
      element("pre", { class: "scenario" }, run.data.scenario)));
}
