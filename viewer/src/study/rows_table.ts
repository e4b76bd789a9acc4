// Table of all runs. Only visible rows exist in the page, so that a hundred thousand remain usable.
import { element } from "../dom";
import { compareValues } from "../order";
import { colourOfStatus, swatch } from "./colours";
import type { Selection } from "./selection";
import type { Column } from "./column";

const rowHeight = 27; // pixels, as in style.css
const rowsAround = 8; // beyond the visible ones
const mostMeasures = 8; // initial columns; the others with "all columns"

export class RowsTable {
  private readonly body = element("tbody");
  private readonly head = element("tr");
  private readonly scroll = element("div", { class: "scroll runs rows", tabindex: "0", "aria-label": "Table of runs" });
  private readonly table = element("table", {});
  private readonly before = element("tr", { "aria-hidden": "true" }); // height of the rows above
  private readonly after = element("tr", { "aria-hidden": "true" });
  private columns: Column[];
  private all: number[] = []; // runs in sorted order
  private order: number[] = []; // visible runs
  private sortedBy: { column: Column; down: boolean };
  private drawn = "";

  constructor(box: HTMLElement, private readonly selection: Selection) {
    const { study } = selection;
    this.columns = this.mainColumns();
    this.sortedBy = { column: study.the("point"), down: false };
    const all = element("input", { type: "checkbox", id: "all-columns" });
    all.addEventListener("change", () => {
      this.columns = all.checked ? study.columns.filter(({ role }) => role !== "kept" && role !== "seeds") : this.mainColumns();
      this.fillHead();
      this.draw();
    });
    this.table.append(element("thead", {}, this.head), this.body);
    this.scroll.append(this.table);
    box.append(element("h2", {}, "Runs"), this.scroll, element("label", {}, all, " all columns"));
    this.scroll.addEventListener("scroll", () => this.draw(false));
    new ResizeObserver(() => this.draw(false)).observe(this.scroll);
    this.followHand();
    selection.on("shown", () => this.filter());
    selection.on("picked", () => this.showPicked());
    this.fillHead();
    this.sort();
  }

  /** Visible runs in sorted order. */
  get rows(): readonly number[] {
    return this.order;
  }

  /** Update after a change of colours. */
  rebuild(): void {
    this.draw();
  }

  private mainColumns(): Column[] {
    const { study } = this.selection;
    const [replicate, reason] = [study.the("replicate"), study.the("reason")];
    return [
      study.the("point"), ...(replicate.varies ? [replicate] : []), study.the("status"), ...study.of("verdict"), ...study.of("key"),
      ...study.mainMeasures(mostMeasures), study.the("wall_s"), ...(reason.low <= reason.high ? [reason] : []),
    ];
  }

  // Columns keep the width of their longest texts while rows change.
  private fillHead(): void {
    const { study } = this.selection;
    const every = Math.max(1, Math.floor(study.runs / 200));
    const widths = this.columns.map((column) => {
      let longest = 4;
      for (let row = 0; row < study.runs; row += every) longest = Math.max(longest, column.text(row).length);
      return Math.min(longest + (column.role === "status" ? 2 : 0), 44);
    });
    this.head.replaceChildren(...this.columns.map((column) => this.headOf(column)));
    const group = element("colgroup", {}, ...this.columns.map((column, i) => {
      const col = element("col");
      const section = column.role === "key" ? sectionOf(column).length * 0.9 : 0;
      col.style.width = `${Math.max(widths[i], Math.min(Math.max(longestWord(column.heading), section), 26)) * 7.6 + 38}px`;
      return col;
    }));
    this.table.querySelector("colgroup")?.remove();
    this.table.prepend(group);
    for (const spacer of [this.before, this.after]) spacer.replaceChildren(element("td", { colspan: String(this.columns.length) }));
    this.drawn = "";
  }

  private headOf(column: Column): HTMLElement {
    const section = column.role === "key" ? sectionOf(column) : "";
    const title = element("span", { title: column.name }, ...(section ? [element("small", {}, section)] : []), column.heading);
    const button = element("button", { type: "button", class: "sort" }, title);
    const { column: sorted, down } = this.sortedBy;
    const head = element("th", { scope: "col", "data-key": column.name, class: column.words ? "" : "number",
      "aria-sort": sorted !== column ? "none" : down ? "descending" : "ascending" }, button);
    button.addEventListener("click", () => {
      this.sortedBy = { column, down: this.sortedBy.column === column && !this.sortedBy.down };
      for (const other of this.head.children) other.setAttribute("aria-sort", "none");
      head.setAttribute("aria-sort", this.sortedBy.down ? "descending" : "ascending");
      this.sort();
    });
    return head;
  }

  private sort(): void {
    const { column, down } = this.sortedBy;
    const value = (row: number) => (!column.has(row) ? null : column.words ? column.text(row) : column.values[row]);
    const keyed = Array.from(column.values, (_, row) => ({ row, value: value(row) }));
    keyed.sort((a, b) => compareValues(a.value, b.value, down) || a.row - b.row);
    this.all = keyed.map(({ row }) => row);
    this.filter();
  }

  private filter(): void {
    this.order = this.all.filter((row) => this.selection.shown[row]);
    this.scroll.scrollTop = 0;
    this.draw();
  }

  private draw(anew = true): void {
    const height = this.scroll.clientHeight || 400;
    const first = Math.max(0, Math.floor(this.scroll.scrollTop / rowHeight) - rowsAround);
    const last = Math.min(this.order.length, first + Math.ceil(height / rowHeight) + 2 * rowsAround);
    const now = `${first} ${last}`;
    if (!anew && now === this.drawn) return;
    this.drawn = now;
    this.selection.point(null); // removed rows send no leave event
    this.before.style.height = `${first * rowHeight}px`;
    this.after.style.height = `${(this.order.length - last) * rowHeight}px`;
    [this.before.hidden, this.after.hidden] = [first === 0, last === this.order.length];
    this.body.replaceChildren(this.before, ...this.order.slice(first, last).map((row) => this.rowOf(row)), this.after);
  }

  private rowOf(row: number): HTMLTableRowElement {
    const cells = this.columns.map((column) => {
      const text = column.has(row) ? column.text(row) : "–";
      const cell = element(column.role === "point" ? "th" : "td", { "data-key": column.name });
      if (column.role === "point") cell.setAttribute("scope", "row");
      if (column.words && text.length > 30) cell.title = text;
      if (!column.words) cell.className = "number";
      if (column.role === "status") cell.append(swatch(colourOfStatus(column.exact(row))));
      cell.append(text);
      return cell;
    });
    const made = element("tr", { "data-row": String(row), class: row === this.selection.picked ? "picked" : "" }, ...cells);
    return made;
  }

  private followHand(): void {
    const rowAt = (event: Event) => {
      const row = (event.target as HTMLElement).closest<HTMLElement>("tr[data-row]")?.dataset.row;
      return row === undefined ? null : Number(row);
    };
    this.body.addEventListener("click", (event) => {
      const row = rowAt(event);
      if (row !== null) this.selection.pick(row);
    });
    this.body.addEventListener("pointerover", (event) => this.selection.point(rowAt(event)));
    this.body.addEventListener("pointerleave", () => this.selection.point(null));
    this.scroll.addEventListener("keydown", (event) => {
      const step = { ArrowDown: 1, ArrowUp: -1 }[event.key];
      if (!step || this.order.length === 0) return;
      event.preventDefault();
      const at = this.selection.picked === null ? -1 : this.order.indexOf(this.selection.picked);
      this.selection.pick(this.order[Math.min(Math.max(at + step, 0), this.order.length - 1)]);
    });
  }

  private showPicked(): void {
    const { picked } = this.selection;
    const at = picked === null ? -1 : this.order.indexOf(picked);
    const { scrollTop, clientHeight } = this.scroll;
    const room = clientHeight - 2 * rowHeight;
    if (at >= 0 && (at * rowHeight < scrollTop || at * rowHeight > scrollTop + room - rowHeight))
      this.scroll.scrollTop = Math.max(0, at * rowHeight - room / 2);
    this.draw();
  }
}

function sectionOf(column: Column): string {
  return column.name.split(".").slice(0, -1).join(".");
}

function longestWord(title: string): number {
  return Math.max(...title.split(" ").map((word) => word.length), Math.min(title.length, 12));
}
