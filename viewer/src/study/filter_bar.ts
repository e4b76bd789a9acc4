// Bar above all plots: filter, active restrictions and their removal, and choice of colours.
import { byId, download, element } from "../dom";
import { csvText } from "../table";
import { count, number } from "../text";
import { columnSelect } from "./column_choice";
import { Colours, colourOfStatus, swatch } from "./colours";
import { patternOf } from "./failures";
import type { RowsTable } from "./rows_table";
import type { Selection } from "./selection";
import type { Column } from "./column";

export class FilterBar {
  private readonly text = element("input", { type: "search", id: "filter", "aria-label": "Filter runs" });
  private readonly count = element("output", { id: "shown-count" });
  private readonly chips = element("div", { class: "group", id: "chips" });
  private readonly statuses = element("div", { class: "group", id: "statuses" });
  private readonly legend = element("span", { class: "ramp" });
  private readonly rangeForm: HTMLElement;

  constructor(private readonly selection: Selection, table: RowsTable) {
    const { study } = selection;
    const key = study.of("key").find((column) => !column.words && column.varies);
    this.text.placeholder = key ? `Filter: failed, or ${words1(key.name)}>=${number(key.low)}` : "Filter runs";
    this.text.addEventListener("input", () => selection.setText(this.text.value));
    const save = element("button", { type: "button", id: "save-table" }, "Save CSV");
    save.addEventListener("click", () => saveTable(selection, table.rows));
    const colour = columnSelect("colour-by", study.plottable, selection.colour, (column) => selection.colourBy(column));
    this.rangeForm = this.makeRangeForm();
    byId("runs-bar").append(
      this.text, this.count, this.statuses, this.rangeForm, save,
      element("span", { class: "group" }, element("label", {}, "Colour ", colour), this.legend), this.chips,
    );
    new ResizeObserver(([{ target }]) =>
      document.body.style.setProperty("--bar", `${(target as HTMLElement).offsetHeight}px`)).observe(byId("runs-bar"));
    this.fillStatuses();
    selection.on("shown", () => this.show());
    selection.on("colour", () => this.rebuild());
    this.show();
    this.rebuild();
  }

  /** Update after a change of colours. */
  rebuild(): void {
    const legend = Colours.of(this.selection.colour).legend();
    this.legend.replaceChildren(...legend.childNodes);
    for (const dot of this.statuses.querySelectorAll<HTMLElement>("[data-status] .swatch"))
      dot.style.background = colourOfStatus(dot.closest<HTMLElement>("[data-status]")!.dataset.status!);
  }

  private fillStatuses(): void {
    const status = this.selection.study.the("status");
    const boxes = status.words!.map((word, value) => {
      const box = element("input", { type: "checkbox" });
      box.checked = true;
      const many = status.values.reduce((sum, own) => sum + Number(own === value), 0);
      this.statuses.append(element("label", { "data-status": word }, box, swatch(colourOfStatus(word)), `${status.textOf(value)} ${count(many)}`));
      return box;
    });
    this.statuses.hidden = boxes.length < 2;
    this.statuses.addEventListener("change", () => {
      const wanted = new Set(boxes.flatMap((box, value) => (box.checked ? [value] : [])));
      this.selection.setTicks(status, wanted.size === boxes.length ? null : wanted);
    });
    this.selection.on("shown", () => {
      const wanted = this.selection.ticks.get(status);
      boxes.forEach((box, value) => (box.checked = !wanted || wanted.has(value)));
    });
  }

  // Range as numbers, for values that cannot be drawn.
  private makeRangeForm(): HTMLElement {
    const columns = this.selection.study.plottable.filter((column) => !column.words && column.varies);
    if (columns.length === 0) return element("span");
    let column = columns[0];
    const [low, high] = ["from", "to"].map((name) => element("input", { type: "number", step: "any", id: `range-${name}`, "aria-label": name }));
    const bounds = () => {
      const range = this.selection.ranges.get(column);
      [low.value, high.value] = range ? [shortNumber(range.low), shortNumber(range.high)] : ["", ""];
      [low.placeholder, high.placeholder] = [shortNumber(column.low), shortNumber(column.high)];
    };
    const select = columnSelect("range-of", columns, column, (chosen) => {
      column = chosen;
      bounds();
    });
    const take = () => {
      const numberOr = (input: HTMLInputElement, other: number) => (input.value === "" ? other : Number(input.value));
      const isFree = low.value === "" && high.value === "";
      this.selection.setRange(column, isFree ? null : { low: numberOr(low, -Infinity), high: numberOr(high, Infinity) });
    };
    for (const input of [low, high]) input.addEventListener("change", take);
    this.selection.on("shown", () => {
      if (document.activeElement !== low && document.activeElement !== high) bounds();
    });
    bounds();
    const menu = element("details", { class: "menu", id: "range" }, element("summary", {}, "Range"),
      element("div", { class: "group" }, select, low, "to", high));
    document.addEventListener("pointerdown", (event) => {
      if (!menu.contains(event.target as Node)) menu.open = false;
    });
    return menu;
  }

  private show(): void {
    const { selection } = this;
    const { ranges, ticks, shownRows, study } = selection;
    this.count.textContent = `${count(shownRows.length)} of ${count(study.runs)} shown`;
    if (this.text.value !== selection.text) this.text.value = selection.text;
    const chip = (column: Column, text: string, drop: () => void) => {
      const made = element("button", { type: "button", class: "chip", title: "Remove this restriction", "data-key": column.name }, `× ${text}`);
      made.addEventListener("click", drop);
      return made;
    };
    const chips = [
      ...[...ranges].map(([column, { low, high }]) => chip(column, rangeText(column, low, high), () => selection.setRange(column, null))),
      ...[...ticks].filter(([column]) => column.role !== "status").map(([column, values]) => {
        const first = column.textOf([...values][0]);
        const shown = values.size > 1 ? patternOf(first) : first;
        const short = shown.length > 60 ? `${shown.slice(0, 60)}…` : shown;
        return chip(column, `${column.label}: ${short}`, () => selection.setTicks(column, null));
      }),
    ];
    if (ranges.size > 0 || ticks.size > 0 || selection.text !== "") {
      const clear = element("button", { type: "button", id: "show-all" }, "Show all");
      clear.addEventListener("click", () => selection.clear());
      chips.unshift(clear);
    }
    this.chips.replaceChildren(...chips);
  }
}

function words1(key: string): string {
  return key.slice(key.lastIndexOf(".") + 1).split("_")[0];
}

function shortNumber(value: number): string {
  return String(Number(value.toPrecision(4)));
}

export function rangeText(column: Column, low: number, high: number): string {
  if (column.words) {
    const inside = column.words.map((_, i) => i).filter((i) => i >= low && i <= high).map((i) => column.textOf(i));
    return `${column.label}: ${inside.length > 3 ? `${inside.length} words` : inside.join(", ") || "nothing"}`;
  }
  const unit = column.unit === "" ? "" : ` ${column.unit}`;
  if (low === -Infinity) return `${column.label} ≤ ${number(high, 3)}${unit}`;
  if (high === Infinity) return `${column.label} ≥ ${number(low, 3)}${unit}`;
  return `${column.label} ${number(low, 3)} to ${number(high, 3)}${unit}`;
}

/** Table of the visible runs with all values, as in runs.csv. */
export function tableText(selection: Selection, rows: readonly number[]): string {
  const columns = selection.study.columns.filter(({ role }) => role !== "seeds" && role !== "kept" && role !== "verdict");
  const value = (column: Column, row: number) => {
    const exact = column.exact(row);
    return csvText(column.role === "key" && /^"[^"\\]*"$/.test(exact) ? exact.slice(1, -1) : exact);
  };
  return [columns.map(({ name }) => csvText(name)), ...rows.map((row) => columns.map((column) => value(column, row)))]
    .map((fields) => `${fields.join(",")}\n`).join("");
}

function saveTable(selection: Selection, rows: readonly number[]): void {
  const name = selection.study.page.name.replace(/[^\w.-]+/g, "_").slice(0, 80);
  download(`${name}.csv`, new Blob([tableText(selection, rows)], { type: "text/csv" }));
}
