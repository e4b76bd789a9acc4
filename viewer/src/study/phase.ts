// Phase plot: results over two keys. Grids: one cell per pair of values; otherwise one point per run.
import { element, styleColour } from "../dom";
import { number } from "../text";
import { Colours, withoutResult } from "./colours";
import { columnSelect } from "./column_choice";
import { drawTicks, drawTitles, type Frame, frameOf } from "./frame";
import { Layers } from "./layers";
import { Points } from "./points";
import type { Selection } from "./selection";
import type { Column } from "./column";
import { verdictRule } from "./verdict";

interface Cell {
  rows: number[];
  x: number; // indices of its values among the steps
  y: number;
}

/** Runs of each pair of values, by index `x + y * steps of x`. */
export function cellsOf(x: Column, y: Column, rows: Iterable<number>): Map<number, Cell> {
  const [placesX, placesY] = [x, y].map((column) => new Map(column.steps!.map((value, i) => [value, i])));
  const cells = new Map<number, Cell>();
  for (const row of rows) {
    const [i, j] = [placesX.get(x.values[row]), placesY.get(y.values[row])];
    if (i === undefined || j === undefined) continue;
    const cell = cells.get(i + j * placesX.size);
    if (cell) cell.rows.push(row);
    else cells.set(i + j * placesX.size, { rows: [row], x: i, y: j });
  }
  return cells;
}

export class Phase {
  private readonly layers: Layers;
  private readonly points: Points;
  private readonly told = element("p", { class: "note told" });
  private frame: Frame = { left: 0, right: 0, top: 0, bottom: 0 };
  private cells = new Map<number, Cell>();

  constructor(box: HTMLElement, private readonly selection: Selection, private x: Column, private y: Column) {
    const keys = selection.study.of("key").filter(({ varies }) => varies);
    this.layers = new Layers("Phase plot of two keys", () => this.draw());
    this.points = new Points(selection, x, y, "Phase plot of two keys");
    box.append(
      element("h2", {}, "Phase plot"),
      element("div", { class: "group choices" },
        element("span", { class: "choice" }, element("label", {}, "Up ", columnSelect("phase-y", keys, y, (column) => this.show(this.x, column)))),
        element("span", { class: "choice" }, element("label", {}, "Across ", columnSelect("phase-x", keys, x, (column) => this.show(column, this.y))))),
      this.layers.box, this.points.layers.box, this.told,
    );
    this.followHand();
    selection.on("shown", () => this.draw());
    selection.on("colour", () => this.draw());
    selection.on("picked", () => this.drawOver());
    selection.on("pointed", () => this.drawOver());
    this.show(x, y);
  }

  private show(x: Column, y: Column): void {
    [this.x, this.y, this.points.x, this.points.y] = [x, y, x, y];
    this.layers.box.hidden = !this.isOfCells;
    this.points.layers.box.hidden = this.isOfCells;
    this.redraw();
  }

  /** Update after a change of colours. */
  redraw(): void {
    this.draw();
    this.points.draw();
  }

  private get isOfCells(): boolean {
    if (!this.x.steps || !this.y.steps) return false;
    return this.selection.study.page.design === "grid" || this.x.steps.length * this.y.steps.length <= 0.5 * this.selection.study.runs;
  }

  draw(): void {
    const { layers, x, y } = this;
    if (layers.width === 0 || layers.box.hidden) return;
    this.frame = frameOf(layers, y.steps!.map((value) => y.textOf(value)));
    this.cells = cellsOf(x, y, this.selection.shownRows);
    layers.clear(layers.base);
    const ticks = (column: Column, middle: (i: number) => number) =>
      column.steps!.map((value, i) => ({ at: middle(i), text: column.textOf(value) }));
    drawTicks(layers, this.frame, ticks(x, (i) => this.box(i, 0).x + this.size.width / 2),
              ticks(y, (j) => this.box(0, j).y + this.size.height / 2), false);
    drawTitles(layers, this.frame, x.title, y.title);
    const colours = Colours.of(this.selection.colour);
    for (const cell of this.cells.values()) this.drawCell(cell, colours);
    this.drawOver();
    layers.box.dataset.cells = String(this.cells.size);
    this.told.textContent = this.legend();
  }

  // Legend of cells, until the pointer is over one.
  private legend(): string {
    const { colour } = this.selection;
    const cells = [...this.cells.values()];
    const most = Math.max(0, ...cells.map(({ rows }) => rows.length));
    const several = most < 2 ? "" : `Up to ${most} runs per cell, which has the colour${colour.words ? "s of all" : " of their mean"}. `;
    const { study } = this.selection;
    const isCrossed = ({ rows }: Cell) => !rows.some((row) => study.hasResult(row));
    const isEmpty = (cell: Cell) => !isCrossed(cell) && cell.rows.every((row) => !colour.has(row));
    const rule = colour.role === "verdict" ? `${verdictRule} ` : "";
    const crosses = cells.some(isCrossed) ? "×: failed, no result. " : "";
    return several + rule + crosses + (cells.some(isEmpty) ? "Hatched: no run has a value." : "");
  }

  private get size(): { width: number; height: number } {
    const { left, right, top, bottom } = this.frame;
    return { width: (right - left) / this.x.steps!.length, height: (bottom - top) / this.y.steps!.length };
  }

  private box(i: number, j: number): { x: number; y: number } {
    return { x: this.frame.left + i * this.size.width, y: this.frame.bottom - (j + 1) * this.size.height };
  }

  // Colour of the mean; for words one part of the cell each. Hatched without values.
  private drawCell(cell: Cell, colours: Colours): void {
    const { base } = this.layers;
    const { colour } = this.selection;
    const { x, y } = this.box(cell.x, cell.y);
    const [width, height] = [this.size.width - 1, this.size.height - 1];
    const values = cell.rows.map((row) => colour.values[row]).filter((value) => !Number.isNaN(value));
    if (!cell.rows.some((row) => this.selection.study.hasResult(row))) return this.crossOut(x + width / 2, y + height / 2);
    if (values.length === 0) return this.hatch(x, y, width, height);
    if (!colour.words) {
      base.fillStyle = colours.at(mean(values));
      base.fillRect(x, y, width, height);
      return;
    }
    values.sort((a, b) => a - b);
    values.forEach((value, i) => {
      base.fillStyle = colours.at(value);
      base.fillRect(x + (i / values.length) * width, y, width / values.length + 0.3, height);
    });
  }

  private crossOut(x: number, y: number): void {
    const { base } = this.layers;
    const size = Math.min(7, this.size.width / 3, this.size.height / 3);
    base.strokeStyle = withoutResult();
    base.lineWidth = 2;
    base.beginPath();
    base.moveTo(x - size, y - size), base.lineTo(x + size, y + size);
    base.moveTo(x - size, y + size), base.lineTo(x + size, y - size);
    base.stroke();
  }

  private hatch(x: number, y: number, width: number, height: number): void {
    const { base } = this.layers;
    base.save();
    base.beginPath();
    base.rect(x, y, width, height);
    base.clip();
    base.strokeStyle = styleColour("faint");
    base.lineWidth = 1;
    base.beginPath();
    for (let at = -height; at < width; at += 6) base.moveTo(x + at, y + height), base.lineTo(x + at + height, y);
    base.stroke();
    base.restore();
  }

  private drawOver(): void {
    const { over } = this.layers;
    this.layers.clear(over);
    if (!this.isOfCells) return;
    const { picked, pointed } = this.selection;
    for (const [row, colour] of [[picked, styleColour("accent")], [pointed, styleColour("ink")]] as const) {
      if (row === null) continue;
      const [cell] = cellsOf(this.x, this.y, [row]).values();
      if (!cell) continue;
      const { x, y } = this.box(cell.x, cell.y);
      over.strokeStyle = colour;
      over.lineWidth = 3;
      over.strokeRect(x + 1, y + 1, this.size.width - 3, this.size.height - 3);
    }
  }

  private cellAt(event: MouseEvent): Cell | null {
    if (!this.isOfCells) return null;
    const { x, y } = this.layers.place(event);
    const [i, j] = [Math.floor((x - this.frame.left) / this.size.width), Math.floor((this.frame.bottom - y) / this.size.height)];
    if (i < 0 || j < 0 || i >= this.x.steps!.length) return null;
    return this.cells.get(i + j * this.x.steps!.length) ?? null;
  }

  private tell({ rows }: Cell): void {
    const { colour } = this.selection;
    const values = rows.map((row) => colour.values[row]).filter((value) => !Number.isNaN(value));
    const what = colour.words
      ? [...new Set(values)].map((value) => `${values.filter((other) => other === value).length} ${colour.textOf(value)}`).join(", ")
      : values.length === 0 ? "none" : `${values.length > 1 ? "mean " : ""}${number(mean(values))}`;
    const least = !colour.words && values.length > 1 ? ` (${number(Math.min(...values))} to ${number(Math.max(...values))})` : "";
    this.told.textContent = `${this.y.label} ${this.y.text(rows[0])}, ${this.x.label} ${this.x.text(rows[0])}: ` +
      `${rows.length === 1 ? "1 run" : `${rows.length} runs`}, ${colour.label} ${what}${least}`;
  }

  // Repeated clicks on a cell with several runs show one after the other.
  private followHand(): void {
    const { box } = this.layers;
    box.addEventListener("pointermove", (event) => {
      const cell = this.cellAt(event);
      this.selection.point(cell ? cell.rows[0] : null);
      if (cell) this.tell(cell);
    });
    box.addEventListener("pointerleave", () => {
      this.selection.point(null);
      this.told.textContent = this.legend();
    });
    box.addEventListener("click", (event) => {
      const cell = this.cellAt(event);
      if (!cell) return;
      this.tell(cell);
      const next = cell.rows.indexOf(this.selection.picked ?? -1) + 1;
      this.selection.pick(cell.rows[next % cell.rows.length]);
    });
  }
}

function mean(values: number[]): number {
  return values.reduce((sum, value) => sum + value, 0) / values.length;
}
