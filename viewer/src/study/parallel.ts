// Parallel coordinates: one line per run, one axis per column. A drag along an axis hides runs outside of it.
import { element, styleColour } from "../dom";
import { plotFont } from "../fonts";
import { Axis } from "./axis";
import { Colours } from "./colours";
import { columnTicks } from "./column_choice";
import { Layers, wrapped } from "./layers";
import type { Selection } from "./selection";
import type { Column } from "./column";

const room = { top: 52, bottom: 10, sides: 54 };
const leastGap = 92; // pixels between axes; narrower places scroll
const linesAtOnce = 700;
const mostFaint = 1200; // lines of hidden runs
const reach = 8; // pixels from the pointer to a line
const handleTop = 46; // pixels, below the titles
const handle = 34; // width in pixels of the draggable strip of an axis

export class Parallel {
  private shownColumns: Column[];
  private axes: Axis[] = [];
  private places: number[] = []; // of the axes, in pixels
  private readonly layers: Layers;
  private readonly handles = element("div", { class: "handles" });
  private drawing = 0;

  constructor(box: HTMLElement, private readonly selection: Selection, columns: Column[]) {
    this.shownColumns = columns;
    this.layers = new Layers("Parallel coordinates of the runs", () => this.draw());
    this.layers.box.append(this.handles);
    box.append(
      element("h2", {}, "Parallel coordinates"),
      element("p", { class: "note" }, "Drag along an axis to select a range; click the axis to remove it. Click a line to pick its run."),
      element("div", { class: "scroll" }, this.layers.box),
      columnTicks("axes", selection.study.plottable, columns, (wanted) => {
        this.shownColumns = wanted;
        this.fitWidth();
        this.draw();
      }),
    );
    this.fitWidth();
    this.followHand();
    selection.on("shown", () => this.draw());
    selection.on("colour", () => this.draw());
    selection.on("picked", () => this.drawOver());
    selection.on("pointed", () => this.drawOver());
  }

  private fitWidth(): void {
    this.layers.box.style.minWidth = `${2 * room.sides + (this.shownColumns.length - 1) * leastGap}px`;
  }

  /** Redraw after a change of the page's colours. */
  draw(): void {
    const { width, height, base } = this.layers;
    if (width === 0 || height === 0) return;
    const gap = this.shownColumns.length > 1 ? (width - 2 * room.sides) / (this.shownColumns.length - 1) : 0;
    this.places = this.shownColumns.map((_, i) => room.sides + i * gap);
    this.axes = this.shownColumns.map((column) => new Axis(column, height - room.bottom, room.top));
    this.placeHandles(gap);
    this.layers.clear(base);
    this.drawFaint();
    this.drawLines();
    this.drawOver();
  }

  private path(context: CanvasRenderingContext2D, row: number): void {
    this.axes.forEach((axis, i) => {
      const y = axis.at(axis.column.values[row]);
      if (i === 0) context.moveTo(this.places[0], y);
      else context.lineTo(this.places[i], y);
    });
  }

  private drawFaint(): void {
    const { base } = this.layers;
    const { study, shown } = this.selection;
    const every = Math.max(1, Math.ceil((study.runs - this.selection.shownRows.length) / mostFaint));
    base.globalAlpha = 0.6;
    base.lineWidth = 1;
    base.strokeStyle = styleColour("grid");
    base.beginPath();
    for (let row = 0, left = 0; row < study.runs; ++row) if (!shown[row] && left++ % every === 0) this.path(base, row);
    base.stroke();
    base.globalAlpha = 1;
  }

  // In batches, so that drags are followed immediately.
  private drawLines(): void {
    const { base } = this.layers;
    const { shownRows, colour } = this.selection;
    const colours = Colours.of(colour);
    const run = ++this.drawing;
    // In an order that mixes early and late runs, so that the first part is a sample of all.
    const stride = Math.max(1, Math.floor(shownRows.length / linesAtOnce));
    const order: number[] = [];
    for (let s = 0; s < stride; ++s) for (let i = s; i < shownRows.length; i += stride) order.push(shownRows[i]);
    let at = 0;
    const some = () => {
      if (run !== this.drawing) return;
      const groups = new Map<number, number[]>();
      for (const row of order.slice(at, at + linesAtOnce)) {
        const place = colours.placeOf(colour.values[row]);
        const group = groups.get(place);
        if (group) group.push(row);
        else groups.set(place, [row]);
      }
      base.globalAlpha = Math.min(0.85, Math.max(0.05, 25 / order.length ** 0.65));
      base.lineWidth = order.length > 500 ? 1 : 1.4;
      for (const [place, rows] of groups) {
        base.strokeStyle = colours.list[place];
        base.beginPath();
        for (const row of rows) this.path(base, row);
        base.stroke();
      }
      base.globalAlpha = 1;
      this.drawAxes();
      at += linesAtOnce;
      if (at < order.length) requestAnimationFrame(some);
      else this.layers.box.dataset.drawn = String(order.length);
    };
    some();
  }

  private drawAxes(): void {
    const { base, height } = this.layers;
    const gap = this.places.length > 1 ? this.places[1] - this.places[0] : 2 * room.sides;
    base.font = plotFont;
    this.axes.forEach((axis, i) => {
      const x = this.places[i];
      base.strokeStyle = styleColour("faint");
      base.lineWidth = 1;
      base.beginPath();
      base.moveTo(x, axis.at(axis.valueAt(height - room.bottom - (axis.hasLane ? 22 : 0))));
      base.lineTo(x, room.top);
      base.stroke();
      base.textAlign = "center";
      base.textBaseline = "top";
      const isLast = i === this.axes.length - 1;
      const lines = wrapped(base, axis.column.heading, i === 0 || isLast ? Math.min(gap, 2 * room.sides) - 6 : gap - 8, 3);
      base.fillStyle = styleColour("paper");
      base.fillRect(x - gap / 2, 0, gap, room.top - 5);
      base.fillStyle = styleColour("ink");
      lines.forEach((line, l) => base.fillText(line, x, 44 - 14 * (lines.length - l)));
    });
  }

  // Numbers along the axes, above all lines.
  private drawNumbers(): void {
    const { over } = this.layers;
    const gap = this.places.length > 1 ? this.places[1] - this.places[0] : 2 * room.sides;
    over.font = plotFont;
    over.textBaseline = "middle";
    this.axes.forEach((axis, i) => {
      const isLast = i === this.axes.length - 1;
      const x = this.places[i] + (isLast ? -5 : 5);
      over.textAlign = isLast ? "right" : "left";
      for (const tick of axis.ticks(5)) this.haloed(tick.text, x, tick.at, gap - 12);
      if (axis.hasLane) this.haloed("none", x, axis.lane, gap - 12);
    });
  }

  private haloed(text: string, x: number, y: number, width: number): void {
    const { over } = this.layers;
    over.lineWidth = 5;
    over.lineJoin = "round";
    over.strokeStyle = styleColour("paper");
    over.fillStyle = styleColour("ink");
    const fitted = text.length > 8 ? [...wrapped(over, text.replaceAll(" ", "\u00a0"), width, 1)][0] : text;
    over.strokeText(fitted, x, y);
    over.fillText(fitted, x, y);
  }

  private drawOver(): void {
    const { over } = this.layers;
    const { picked, pointed } = this.selection;
    this.layers.clear(over);
    for (const [row, colour] of [[picked, styleColour("accent")], [pointed, styleColour("ink")]] as const) {
      if (row === null || this.axes.length === 0) continue;
      over.strokeStyle = colour;
      over.lineWidth = 2.5;
      over.beginPath();
      this.path(over, row);
      over.stroke();
    }
    this.drawNumbers();
  }

  // Each axis has a draggable strip, so that touches elsewhere scroll the page.
  private placeHandles(gap: number): void {
    if (this.handles.children.length !== this.axes.length || this.axes.some(({ column }, i) =>
      (this.handles.children[i] as HTMLElement).dataset.key !== column.name)) {
      this.handles.replaceChildren(...this.shownColumns.map((column) => this.handleOf(column)));
    }
    this.axes.forEach((axis, i) => {
      const strip = this.handles.children[i] as HTMLElement;
      const width = Math.min(handle, gap > 0 ? gap - 4 : handle);
      strip.style.top = `${handleTop}px`;
      strip.style.left = `${this.places[i] - width / 2}px`;
      strip.style.width = `${width}px`;
      const mark = strip.firstElementChild as HTMLElement;
      const range = this.selection.ranges.get(axis.column);
      mark.hidden = !range;
      if (!range) return;
      const clampY = (y: number) => Math.min(Math.max(y, room.top - 4), this.layers.height);
      const [top, bottom] = [clampY(axis.at(range.high)), clampY(axis.at(range.low))];
      mark.style.top = `${top - handleTop}px`;
      mark.style.height = `${Math.max(bottom - top, 2)}px`;
    });
  }

  private handleOf(column: Column): HTMLElement {
    const strip = element("div", { class: "handle", "data-key": column.name, title: `${column.name}: drag to select a range` },
      element("div", { class: "brush" }));
    let from: number | null = null;
    const axisOf = () => this.axes[this.shownColumns.indexOf(column)];
    const take = (event: PointerEvent) => {
      const y = this.layers.place(event).y;
      if (from === null || Math.abs(y - from) < 4) return;
      const [a, b] = [axisOf().valueAt(from), axisOf().valueAt(y)];
      this.selection.setRange(column, { low: Math.min(a, b), high: Math.max(a, b) });
    };
    strip.addEventListener("pointerdown", (event) => {
      from = this.layers.place(event).y;
      strip.setPointerCapture(event.pointerId);
      event.preventDefault();
    });
    strip.addEventListener("pointermove", take);
    strip.addEventListener("pointerup", (event) => {
      const isClick = from !== null && Math.abs(this.layers.place(event).y - from) < 4;
      from = null;
      if (isClick) this.selection.setRange(column, null);
    });
    strip.addEventListener("pointercancel", () => (from = null));
    return strip;
  }

  private followHand(): void {
    const { box } = this.layers;
    box.addEventListener("pointermove", (event) => {
      if (event.pointerType === "mouse" && event.buttons === 0) this.selection.point(this.rowAt(event));
    });
    box.addEventListener("pointerleave", () => this.selection.point(null));
    box.addEventListener("click", (event) => {
      if ((event.target as HTMLElement).closest(".handle")) return;
      const row = this.rowAt(event);
      if (row !== null) this.selection.pick(row);
    });
  }

  private rowAt(event: MouseEvent): number | null {
    const { x, y } = this.layers.place(event);
    const i = this.places.findIndex((place, k) => x >= place && x <= this.places[k + 1]);
    if (i < 0) return null;
    const part = (x - this.places[i]) / (this.places[i + 1] - this.places[i]);
    let [best, nearest] = [null as number | null, reach];
    for (const row of this.selection.shownRows) {
      const [a, b] = [this.axes[i].at(this.axes[i].column.values[row]), this.axes[i + 1].at(this.axes[i + 1].column.values[row])];
      const distance = Math.abs(a + part * (b - a) - y);
      if (distance < nearest) [best, nearest] = [row, distance];
    }
    return best;
  }
}
