// Table of the runs of a page: differences, results, and selection of visible runs.
import { byId, element } from "./dom";
import { matches, type Traits } from "./filter";
import { fewRuns, isTable, type PageData } from "./page_data";
import type { Run } from "./run";
import { compareValues } from "./order";
import { isNumeric, type RunLooks, sampleOf } from "./run_looks";
import { pointWith, type State } from "./state";
import { lastOf, number, words } from "./text";

const mostKeys = 6; // initial columns; the others with "all measures and keys"

interface Column {
  key: string;
  isMain: boolean;
  values: (string | number | null)[]; // by run number
  head: HTMLElement;
}

export class RunsTable {
  private readonly ticked: Set<number>;
  private readonly columns: Column[];
  private readonly rows: HTMLTableRowElement[];
  private readonly body = element("tbody");
  private readonly text = element("input", { type: "search", id: "filter", "aria-label": "Filter runs" });
  private readonly count = element("output", { id: "shown-count" });
  private readonly ramp = element("span", { class: "ramp" });
  private sortedBy: { column: Column | "run" | null; down: boolean } = { column: null, down: false };

  constructor(private readonly runs: Run[], private readonly page: PageData, private readonly state: State, private readonly looks: RunLooks) {
    this.ticked = new Set(runs.map((run) => run.number));
    this.columns = [...this.keyColumns(), ...this.measureColumns()];
    this.rows = runs.map((run) => this.rowOf(run));
    this.body.append(...this.rows);
    byId("runs-bar").append(...this.bar());
    const more = element("input", { type: "checkbox", id: "all-measures" });
    const table = element("table", {}, element("thead", {}, this.headRow()), this.body);
    more.addEventListener("change", () => table.classList.toggle("all", more.checked));
    byId("runs").append(
      element("div", { class: "scroll runs", tabindex: "0", "aria-label": "Table of runs" }, table),
      element("label", {}, more, " all measures and keys"),
    );
    byId("runs").hidden = byId("runs-bar").hidden = false;
    state.on(["pointed"], () => this.showPointed());
    state.on(["colourBy"], () => this.rebuild());
    this.rebuild();
    if (runs.length > fewRuns) this.sort();
    this.apply();
  }

  /** Update after a change of colours. */
  rebuild(): void {
    this.runs.forEach((run, i) => this.rows[i].querySelector(".sample")!.replaceWith(sampleOf(this.looks.lookOf(run))));
    const key = this.looks.keys.find((candidate) => candidate.key === this.state.now.colourBy);
    this.ramp.hidden = !key;
    if (!key) return;
    const order = key.values.filter((value) => value !== "").map(Number).sort((a, b) => a - b);
    const colours = [0, 0.25, 0.5, 0.75, 1].map((part) => this.looks.ramp(part));
    const strip = element("span", { class: "strip" });
    strip.style.background = `linear-gradient(to right, ${colours.join(", ")})`;
    this.ramp.replaceChildren(number(order[0]), strip, number(order.at(-1)));
  }

  private bar(): HTMLElement[] {
    this.text.placeholder = this.example(); // shown in the empty field
    this.text.addEventListener("input", () => this.apply());
    const tickAll = (on: boolean) => {
      // Among the runs that match the filter.
      for (const run of this.runs) if (matches(this.traitsOf(run), this.text.value)) this.tick(run.number, on);
      this.apply();
    };
    const button = (id: string, text: string, act: () => void) => {
      const made = element("button", { type: "button", id }, text);
      made.addEventListener("click", act);
      return made;
    };
    const parts: HTMLElement[] = [
      this.text, this.count,
      element("span", { class: "group" }, button("tick-all", "All", () => tickAll(true)), button("tick-none", "None", () => tickAll(false))),
    ];
    if (this.looks.keys.length > 0) parts.push(element("label", {}, "Line colour ", this.colourChoice()), this.ramp);
    return parts;
  }

  private example(): string {
    const key = this.page.varied.find(isNumeric);
    return key ? `Filter: a name, or ${lastOf(key.key)}=${key.values.find((value) => value !== "")}` : "Filter runs";
  }

  private colourChoice(): HTMLElement {
    const select = element("select", { id: "colour-by" }, element("option", { value: "" }, "one per run"));
    for (const { key } of this.looks.keys) select.append(element("option", { value: key }, words(lastOf(key))[0]));
    select.value = this.state.now.colourBy;
    select.addEventListener("change", () => this.state.set({ colourBy: select.value }));
    return select;
  }

  private keyColumns(): Column[] {
    // First columns of all runs, numbers before words; the title is already the name of a run.
    const rank = (values: string[]) => values.filter((value) => value === "").length;
    const keys = this.page.varied.filter(({ key }) => key !== "title");
    const order = [...keys].sort((a, b) => rank(a.values) - rank(b.values) || Number(isNumeric(b)) - Number(isNumeric(a)));
    return order.map((varied, i) => {
      const [name, unit] = words(lastOf(varied.key));
      const section = varied.key.split(".").slice(0, -1).join(".");
      const numeric = isNumeric(varied);
      const head = element("span", { title: varied.key }, element("small", {}, section), unit === "" ? name : `${name}, ${unit}`);
      const values = varied.values.map((value) => (value === "" ? null : numeric ? Number(value) : value));
      return { key: varied.key, isMain: i < mostKeys, values, head };
    });
  }

  private measureColumns(): Column[] {
    const column = (key: string, isMain: boolean, text: string, values: Column["values"]): Column =>
      ({ key, isMain, values, head: element("span", { title: key }, text) });
    const main = ["furrow_depth_um", "time_s", "status"];
    const others = [...new Set(this.runs.flatMap((run) => Object.keys(run.data.summary ?? {})))]
      .filter((key) => !main.includes(key) && key !== "title" && !this.runs.some((run) => isTable(run.data.summary?.[key])));
    const value = (run: Run, key: string) => (run.data.summary?.[key] ?? null) as string | number | null;
    // Words after numbers: reasons of failures are sentences.
    const isText = (key: string) => this.runs.some((run) => typeof value(run, key) === "string");
    others.sort((a, b) => Number(isText(a)) - Number(isText(b)));
    return [
      column("furrow_depth_um", true, "furrow depth, µm", this.runs.map((run) => value(run, "furrow_depth_um"))),
      column("time_s", true, "time, s", this.runs.map((run) => value(run, "time_s") ?? run.endTime)),
      column("status", true, "status", this.runs.map(statusOf)),
      ...others.map((key) => {
        const [name, unit] = words(key);
        return column(key, false, unit === "" ? name : `${name}, ${unit}`, this.runs.map((run) => value(run, key)));
      }),
    ];
  }

  private headRow(): HTMLElement {
    const row = element("tr");
    const cell = (content: HTMLElement, column: Column | "run") => {
      const button = element("button", { type: "button", class: "sort" }, content);
      const head = element("th", { scope: "col", "aria-sort": "none", class: column === "run" || column.isMain ? "" : "more" }, button);
      head.dataset.key = column === "run" ? "run" : column.key;
      button.addEventListener("click", () => {
        const { sortedBy } = this;
        this.sortedBy = { column, down: sortedBy.column === column && head.getAttribute("aria-sort") === "ascending" };
        for (const other of row.children) other.setAttribute("aria-sort", "none");
        head.setAttribute("aria-sort", this.sortedBy.down ? "descending" : "ascending");
        this.sort();
      });
      return head;
    };
    row.append(cell(element("span", {}, "run"), "run"), ...this.columns.map((column) => cell(column.head, column)));
    return row;
  }

  private rowOf(run: Run): HTMLTableRowElement {
    const tick = element("input", { type: "checkbox" });
    tick.checked = true;
    tick.addEventListener("change", () => {
      this.tick(run.number, tick.checked);
      this.apply();
    });
    const name = element("label", {}, tick, sampleOf(this.looks.lookOf(run)), element("span", { class: "name" }, run.name));
    const row = element("tr", { "data-run": run.name }, element("th", { scope: "row" }, name));
    for (const { key, isMain, values } of this.columns) {
      const value = values[run.number];
      const text = typeof value === "number" ? number(value) : (value ?? "–");
      row.append(element("td", { "data-key": key, class: isMain ? "" : "more" }, text));
    }
    pointWith(row, run.number, this.state);
    return row;
  }

  private tick(run: number, on: boolean): void {
    if (on) this.ticked.add(run);
    else this.ticked.delete(run);
    this.rows[run].querySelector("input")!.checked = on;
  }

  private traitsOf(run: Run): Traits {
    const traits: Traits = new Map([["run", run.name]]);
    for (const { key, values } of this.columns) traits.set(key, String(values[run.number] ?? ""));
    return traits;
  }

  // Visible: runs ticked and matching the filter. Unticked rows stay, so that they can be ticked again.
  private apply(): void {
    const shown = new Set<number>();
    this.runs.forEach((run, i) => {
      const fits = matches(this.traitsOf(run), this.text.value);
      this.rows[i].hidden = !fits;
      if (fits && this.ticked.has(run.number)) shown.add(run.number);
    });
    this.count.textContent = `${shown.size} of ${this.runs.length} shown`;
    this.state.set({ shown });
  }

  // Initially sorted by the keys: runs given by a pattern come in text order, 1000 before 500.
  private sort(): void {
    const { column, down } = this.sortedBy;
    const keys = this.columns.filter(({ key }) => this.page.varied.some((varied) => varied.key === key));
    const values = (run: Run) => (column === "run" ? [run.name] : (column ? [column] : keys).map((of) => of.values[run.number]));
    const order = [...this.runs].sort((a, b) => {
      const others = values(b);
      const first = values(a).map((value, i) => compareValues(value, others[i], down)).find((difference) => difference !== 0);
      return first ?? a.number - b.number;
    });
    this.body.append(...order.map((run) => this.rows[run.number]));
    this.state.set({ order: order.map((run) => run.number) });
  }

  private showPointed(): void {
    this.rows.forEach((row, i) => row.classList.toggle("pointed", i === this.state.now.pointed));
  }
}

function statusOf(run: Run): string {
  const { summary } = run.data;
  if (!summary) return "not finished";
  const crossing = Number(summary.self_intersections ?? 0) > 0 ? ", self-intersecting" : "";
  return String(summary.status).replaceAll("_", " ") + crossing;
}
