// Data of the page of a study, written by src/study/study_report.cpp: tables with one row per run.
import { inflate } from "../packed";
import { csvRows } from "../table";
import { lastOf, words } from "../text";
import { Column, hasEnded, type Role } from "./column";
import { withVerdict } from "./verdict";

export interface StudyPage {
  format: number;
  made_by: string;
  begun_by: string;
  processor: string;
  name: string;
  scenario: string;
  scenario_argument: string; // of `plica run`
  design: string; // its kind; "" if the scenario of the study was not found
  set: string[]; // KEY=VALUE in all runs
  log_keys: string[];
  depth_word: "furrow" | "fold"; // for furrow_depth_um
  runs: number;
  points: string; // directory of kept files, relative to the page
  study: string; // TOML
  measures: string[];
}

export class Study {
  private ended: boolean[] | null = null;

  constructor(readonly page: StudyPage, readonly columns: Column[]) {
    tellApart(columns.filter(({ role }) => role === "key"));
    for (const column of this.of("measure")) column.label = column.label.replace(/^furrow depth\b/, `${page.depth_word} depth`);
  }

  get runs(): number {
    return this.page.runs;
  }

  /** Whether a run has ended regularly, so that its output variables are results. */
  hasResult(row: number): boolean {
    this.ended ??= Array.from({ length: this.runs }, (_, run) => hasEnded(this.the("status"), run));
    return this.ended[row];
  }

  of(role: Role): Column[] {
    return this.columns.filter((column) => column.role === role);
  }

  the(role: Role): Column {
    const found = this.columns.find((column) => column.role === role);
    if (!found) throw new Error(`the study has no column of ${role}`);
    return found;
  }

  /** Columns that can be plotted: with at least one value, keys first. */
  get plottable(): Column[] {
    const order: Role[] = ["key", "measure", "verdict", "status", "steps", "wall_s", "point", "replicate"];
    return order.flatMap((role) => this.of(role))
      .filter((column) => column.low <= column.high && (column.role !== "replicate" || column.varies));
  }

  /** Initially shown output variables: those named by the study, else those that vary. */
  mainMeasures(most: number): Column[] {
    if (this.of("measure").length <= most) return this.of("measure");
    const measures = this.of("measure").filter(({ low, high }) => low <= high);
    const place = (column: Column) => (usualMeasures.includes(column.name) ? usualMeasures.indexOf(column.name) : usualMeasures.length);
    const rank = (column: Column) => Number(!column.varies) * 1000 + place(column);
    return [...measures].sort((a, b) => rank(a) - rank(b)).slice(0, most);
  }
}

// Output variables of a run that failed are not results: missing, except in the saved table.
function withoutUnfinished(columns: Column[]): Column[] {
  const status = columns.find(({ role }) => role === "status")!;
  return columns.map((column) => {
    if (column.role !== "measure") return column;
    const values = column.values.map((value, row) => (hasEnded(status, row) ? value : NaN));
    const { name, role, isLogarithmic } = column;
    return new Column({ name, role }, values, isLogarithmic, column.values);
  });
}

const usualMeasures = [
  "furrow_depth_um", "vml_apical_area_ratio", "lip_distance_um", "vml_height_um", "lips_closed_time_s", "equilibrium_time_s",
  "max_volume_error", "self_intersections", "min_scaled_jacobian",
];

// Keys with equal endings include what precedes.
function tellApart(keys: Column[]): void {
  for (let parts = 2; parts <= 4; ++parts) {
    const titles = keys.map(({ title }) => title);
    keys.forEach((key, i) => {
      if (titles.indexOf(titles[i]) === titles.lastIndexOf(titles[i])) return;
      const before = key.name.split(".").slice(0, -1).slice(1 - parts).join(" ").replaceAll("_", " ");
      key.label = `${before} ${words(lastOf(key.name))[0]}`.trim();
    });
  }
}

export async function readStudy(): Promise<Study> {
  const page = JSON.parse(document.getElementById("data")!.textContent!) as StudyPage;
  if (page.format !== 1) throw new Error(`the data have format ${page.format}, but this page reads format 1`);
  const [points, rows, kept] = await Promise.all(["points", "rows", "kept"].map(table));
  const columns = columnsOf(page.measures, points, rows, kept)
    .map(([name, role, texts]) => columnOf(name, role, texts, page.log_keys.includes(name)));
  return new Study(page, page.depth_word === "furrow" ? withVerdict(withoutUnfinished(columns)) : withoutUnfinished(columns));
}

async function table(id: string): Promise<string[][]> {
  return csvRows(new TextDecoder().decode(await inflate(document.getElementById(id)!.textContent!)));
}

// Columns in the order of runs.csv, with the keys as in points.csv (TOML); "" if missing.
function columnsOf(measures: string[], [head, ...points]: string[][], rows: string[][], kept: string[][]): [string, Role, string[]][] {
  const keys = head.slice(3, -1);
  const [statusAt, width] = [keys.length + 2, keys.length + measures.length + 6];
  const column = (at: number, missing = "") =>
    points.map((_, run) => (rows[run]?.length === width ? rows[run][at] : missing));
  return [
    ["point", "point", points.map((point) => point[1])],
    ...keys.map((key, k): [string, Role, string[]] => [key, "key", points.map((point) => point[3 + k])]),
    ["replicate", "replicate", points.map((point) => point[2])],
    ["status", "status", column(statusAt, "not_run")],
    ...measures.map((name, m): [string, Role, string[]] => [name, "measure", column(statusAt + 1 + m)]),
    ["steps", "steps", column(width - 3)],
    ["wall_s", "wall_s", column(width - 2)],
    ["reason", "reason", column(width - 1)],
    ["seeds", "seeds", points.map((point) => point.at(-1)!)],
    ["kept", "kept", points.map((_, run) => kept[run]?.[0] ?? "")],
  ];
}

function columnOf(name: string, role: Role, texts: string[], isLogarithmic: boolean): Column {
  const isNumber = (text: string) => text.trim() !== "" && Number.isFinite(Number(text));
  const isOfWords = ["status", "reason", "seeds", "kept"].includes(role) || (role === "key" && !texts.every(isNumber));
  if (!isOfWords) return new Column({ name, role }, Float64Array.from(texts, (text) => (text === "" ? NaN : Number(text))), isLogarithmic);
  const places = new Map([...new Set(texts)].filter((text) => text !== "").map((text, place) => [text, place]));
  return new Column({ name, role, words: [...places.keys()] }, Float64Array.from(texts, (text) => places.get(text) ?? NaN), isLogarithmic);
}
