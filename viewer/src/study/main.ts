// Start of the page of a study: reads its data, then shows its parts, which share one selection of runs.
import { byId, element } from "../dom";
import { count, time } from "../text";
import { followTheme } from "../theme";
import { FilterBar } from "./filter_bar";
import { showFailures } from "./failures";
import { Parallel } from "./parallel";
import { Phase } from "./phase";
import { RowsTable } from "./rows_table";
import { RunPanel } from "./run_panel";
import { makeScatter } from "./scatter";
import { Selection } from "./selection";
import type { Column } from "./column";
import { readStudy, type Study } from "./study_data";

const mostAxes = 10; // of the parallel coordinates, initially

function showHeadline(study: Study): void {
  const { page } = study;
  byId("title").textContent = page.name;
  const status = study.the("status");
  const counts = status.words!.map((_, value) => {
    const many = status.values.reduce((sum, own) => sum + Number(own === value), 0);
    return `${count(many)} ${status.textOf(value)}`;
  });
  const took = study.the("wall_s").values.reduce((sum, own) => sum + (own || 0), 0);
  const parts = [
    `${page.design === "" ? "Points" : `${page.design.charAt(0).toUpperCase()}${page.design.slice(1)}`} over ${study.of("key").length} ` +
      `${study.of("key").length === 1 ? "key" : "keys"} of ${page.scenario}`,
    `${count(study.runs)} ${study.runs === 1 ? "run" : "runs"}: ${counts.join(", ")}`,
    `${took >= 7200 ? `${(took / 3600).toFixed(1)} h` : time(took)} total run time`,
  ];
  byId("headline").textContent = parts.join("; ");
  byId("made-by").textContent = `Made by ${page.made_by}; run by plica ${page.begun_by} on ${page.processor}.`;
  if (page.set.length > 0) byId("headline").append(`; in all runs: ${page.set.join(", ")}`);
}

// Verdict on the embryos, or the most informative output variable, or else the status of runs.
function firstColour(study: Study): Column {
  return study.of("verdict")[0] ?? study.mainMeasures(1).find(({ varies }) => varies) ?? study.the("status");
}

function varying(study: Study): Column[] {
  const keys = study.of("key").filter(({ varies }) => varies);
  return keys.length > 0 ? keys : study.plottable;
}

async function start(): Promise<void> {
  const study = await readStudy();
  showHeadline(study);
  const selection = new Selection(study, firstColour(study));
  const keys = varying(study);
  const measures = study.mainMeasures(6).filter(({ varies }) => varies);
  const first = [...keys.slice(0, mostAxes - 2), ...measures].slice(0, mostAxes);
  const axes = study.plottable.filter((column) => first.includes(column));
  const parallel = new Parallel(byId("parallel"), selection, axes.length >= 2 ? axes : study.plottable.slice(0, 2));
  const scatter = makeScatter(byId("scatter"), selection, keys[0], measures[0] ?? study.plottable.at(-1)!);
  const phase = keys.length >= 2 && keys[1].role === "key" ? new Phase(byId("phase"), selection, keys[0], keys[1]) : null;
  byId("phase").hidden = !phase;
  showFailures(byId("failures"), selection);
  const table = new RowsTable(byId("runs"), selection);
  const bar = new FilterBar(selection, table);
  const panel = new RunPanel(byId("run"), selection);
  byId("texts").append(element("details", {}, element("summary", {}, "The study's file"), element("pre", {}, study.page.study)));
  followTheme(() => {
    parallel.draw();
    scatter.draw();
    phase?.redraw();
    table.rebuild();
    bar.rebuild();
    panel.show();
  });
  requestAnimationFrame(() => requestAnimationFrame(() => {
    performance.mark("first-picture");
    document.body.dataset.ready = "true";
  }));
}

start().catch((error) => {
  const notice = byId("problem");
  notice.textContent = `Error while showing the data: ${error instanceof Error ? error.message : error}`;
  notice.hidden = false;
  throw error;
});
