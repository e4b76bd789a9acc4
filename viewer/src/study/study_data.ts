// Data of the page of a study, written by src/study/study_report.cpp: columns with one value per run.
import { type ArrayEntry, inflate, PackedArrays } from "../packed";
import { lastOf, words } from "../text";
import { Column, type ColumnEntry, hasEnded, type Role } from "./column";
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
  columns: ColumnEntry[];
  arrays: ArrayEntry[];
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
  const packed = new PackedArrays(await inflate(document.getElementById("rows")!.textContent!), page.arrays);
  const columns = page.columns.map((entry, place) =>
    new Column(entry, unpacked(entry, String(place), packed), page.log_keys.includes(entry.name)));
  return new Study(page, page.depth_word === "furrow" ? withVerdict(withoutUnfinished(columns)) : withoutUnfinished(columns));
}

function unpacked(entry: ColumnEntry, place: string, packed: PackedArrays): Float64Array {
  if (entry.words) return Float64Array.from(packed.get(`${place}/words`), (word) => (word === 0 ? NaN : word - 1));
  if (entry.numbers === "float") return Float64Array.from(new Float32Array(packed.get(`${place}/float`).buffer));
  const [high, low] = [packed.get(`${place}/high`), packed.get(`${place}/low`)];
  const values = new Float64Array(high.length);
  const bytes = new DataView(values.buffer);
  const isLittle = new Uint8Array(new Uint16Array([1]).buffer)[0] === 1;
  for (let i = 0; i < high.length; ++i) {
    bytes.setUint32(8 * i, isLittle ? low[i] : high[i], isLittle);
    bytes.setUint32(8 * i + 4, isLittle ? high[i] : low[i], isLittle);
  }
  return values;
}
