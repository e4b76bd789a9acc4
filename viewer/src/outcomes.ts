// Table of the outcomes of experiments, with their verdicts, above the runs.
import { byId, element } from "./dom";
import type { PageData } from "./page_data";
import { number } from "./text";
import type { Run } from "./run";
import { pointWith, type State } from "./state";

export interface Outcomes {
  title: string;
  of_claims: boolean; // else of predictions
  runs: string[]; // names of experiments with a run on this page
  columns: string[]; // those of outcomes.csv
  rows: string[][];
}

const kinds: Record<string, string> = { hit: "good", reproduced: "good", miss: "bad", "not reproduced": "bad" };

export function showOutcomes(runs: Run[], page: PageData, state: State): void {
  const outcomes = page.outcomes;
  if (!outcomes) return;
  const counts = new Map<string, number>();
  const rows = outcomes.rows.map((fields) => {
    const of = Object.fromEntries(outcomes.columns.map((column, i) => [column, fields[i]]));
    const verdict = of.verdict === "" ? "not run" : of.verdict;
    counts.set(verdict, (counts.get(verdict) ?? 0) + 1);
    const run = runs.find(({ name }) => name === of.experiment);
    const row = element("tr", { "data-verdict": verdict },
      element("td", { class: `short verdict ${kinds[verdict] ?? ""}` }, verdict),
      element("th", { scope: "row" }, `${of.experiment}, ${of.outcome}`),
      element("td", {}, of.question),
      element("td", {}, of.source === "" ? of.observed : `${of.observed} (${of.source})`),
      element("td", { class: "short", title: of.criterion }, of.number === "" ? "none" : number(Number(of.number)),
        ...(of.all_draws === "" ? [] : [element("small", {}, ` (${of.all_draws})`)])),
      element("td", {}, of.criterion),
      element("td", { class: "short", title: `probability of a hit: ${of.probability_of_hit}` }, `${of.hits} of ${of.draws}`),
      ...(outcomes.of_claims ? [] : [element("td", {}, of.role), element("td", {}, of.prediction || "–")]),
      element("td", {}, of.because));
    if (run) pointWith(row, run.number, state);
    return row;
  });
  const choice = element("select", { id: "verdict", "aria-label": "Outcomes shown" }, element("option", { value: "" }, `all ${rows.length}`),
    ...[...counts].map(([verdict, count]) => element("option", { value: verdict }, `${verdict} (${count})`)));
  choice.addEventListener("change", () => {
    for (const row of rows) row.hidden = choice.value !== "" && row.dataset.verdict !== choice.value;
  });
  const heads = ["verdict", "outcome", "question", "observed", "number (all draws)", "agrees if", "draws that agree",
    ...(outcomes.of_claims ? [] : ["role", "prediction"]), "because"];
  byId("outcomes").append(
    element("label", {}, "Outcomes ", choice),
    element("div", { class: "scroll runs", tabindex: "0", "aria-label": "Table of outcomes" },
      element("table", {}, element("thead", {}, element("tr", {}, ...heads.map((head) => element("th", { scope: "col" }, head)))),
        element("tbody", {}, ...rows))));
  byId("outcomes").hidden = false;
}
