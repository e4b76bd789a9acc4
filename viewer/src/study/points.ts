// Plot of one point per run, one column over another. A drag selects the runs inside.
import { element, styleColour } from "../dom";
import { Axis } from "./axis";
import { Colours, withoutResult } from "./colours";
import { drawFrame, type Frame, frameOf } from "./frame";
import { Layers } from "./layers";
import type { Selection } from "./selection";
import type { Column } from "./column";

const mostDiscs = 2500; // more are drawn as squares
const reach = 14; // pixels from the pointer to a point

export class Points {
  readonly layers: Layers;
  private frame: Frame = { left: 0, right: 0, top: 0, bottom: 0 };
  private axes: { x: Axis; y: Axis } | null = null;
  private readonly rectangle = element("div", { class: "brush" });
  isLogarithmic = { x: false, y: false };

  constructor(private readonly selection: Selection, public x: Column, public y: Column, label: string) {
    this.layers = new Layers(label, () => this.draw());
    this.rectangle.hidden = true;
    this.layers.box.append(this.rectangle);
    this.followHand();
    selection.on("shown", () => this.draw());
    selection.on("colour", () => this.draw());
    selection.on("picked", () => this.drawOver());
    selection.on("pointed", () => this.drawOver());
  }

  draw(): void {
    const { layers } = this;
    if (layers.width === 0 || layers.box.hidden) return;
    const logarithmic = { x: this.isLogarithmic.x || this.x.isLogarithmic, y: this.isLogarithmic.y || this.y.isLogarithmic };
    const trial = new Axis(this.y, layers.height - 44, 10, logarithmic.y);
    this.frame = frameOf(layers, trial.ticks(6).map(({ text }) => text).concat(trial.hasLane ? "none" : []));
    const { left, right, top, bottom } = this.frame;
    this.axes = { x: new Axis(this.x, left, right, logarithmic.x), y: new Axis(this.y, bottom, top, logarithmic.y) };
    layers.clear(layers.base);
    drawFrame(layers, this.frame, this.axes.x, this.axes.y);
    this.drawFaint();
    this.drawPoints();
    this.drawOver();
  }

  private place(row: number): [number, number] {
    const { x, y } = this.axes!;
    return [x.at(x.column.values[row]), y.at(y.column.values[row])];
  }

  private drawFaint(): void {
    const { base } = this.layers;
    base.fillStyle = styleColour("grid");
    for (let row = 0; row < this.selection.study.runs; ++row) {
      if (this.selection.shown[row]) continue;
      const [x, y] = this.place(row);
      base.fillRect(x - 1.5, y - 1.5, 3, 3);
    }
  }

  private drawPoints(): void {
    const { base } = this.layers;
    const { shownRows, colour, study } = this.selection;
    const colours = Colours.of(colour);
    const groups: number[][] = colours.list.map(() => []);
    const failed = shownRows.filter((row) => !study.hasResult(row));
    for (const row of shownRows) if (study.hasResult(row)) groups[colours.placeOf(colour.values[row])].push(row);
    const isDense = shownRows.length > mostDiscs;
    const size = shownRows.length > 400 ? 2.6 : 4;
    base.globalAlpha = isDense ? 0.75 : 0.9;
    groups.forEach((rows, i) => {
      if (rows.length === 0) return;
      base.fillStyle = colours.list[i];
      base.beginPath();
      for (const row of rows) {
        const [x, y] = this.place(row);
        if (isDense) {
          base.fillRect(x - 1.5, y - 1.5, 3, 3); // many times faster than discs
        } else {
          base.moveTo(x + size, y);
          base.arc(x, y, size, 0, 2 * Math.PI);
        }
      }
      base.fill();
    });
    this.crossOut(failed, isDense ? 2 : size);
    base.globalAlpha = 1;
    Object.assign(this.layers.box.dataset, { points: String(shownRows.length), crossed: String(failed.length) });
  }

  // Runs without a result, as in figures of the Python package.
  private crossOut(rows: number[], size: number): void {
    const { base } = this.layers;
    base.strokeStyle = withoutResult();
    base.lineWidth = 1.6;
    base.beginPath();
    for (const row of rows) {
      const [x, y] = this.place(row);
      base.moveTo(x - size, y - size), base.lineTo(x + size, y + size);
      base.moveTo(x - size, y + size), base.lineTo(x + size, y - size);
    }
    base.stroke();
  }

  private drawOver(): void {
    const { over } = this.layers;
    const { picked, pointed } = this.selection;
    this.layers.clear(over);
    if (!this.axes) return;
    for (const [row, colour] of [[picked, styleColour("accent")], [pointed, styleColour("ink")]] as const) {
      if (row === null) continue;
      const [x, y] = this.place(row);
      over.strokeStyle = colour;
      over.lineWidth = 2.5;
      over.beginPath();
      over.arc(x, y, 7, 0, 2 * Math.PI);
      over.stroke();
    }
  }

  private rowAt(event: MouseEvent): number | null {
    if (!this.axes) return null;
    const hand = this.layers.place(event);
    let [best, nearest] = [null as number | null, reach * reach];
    for (const row of this.selection.shownRows) {
      const [x, y] = this.place(row);
      const distance = (x - hand.x) ** 2 + (y - hand.y) ** 2;
      if (distance < nearest) [best, nearest] = [row, distance];
    }
    return best;
  }

  private followHand(): void {
    const { box } = this.layers;
    let from: { x: number; y: number } | null = null;
    const isDrag = (event: MouseEvent) => {
      const to = this.layers.place(event);
      return from !== null && Math.abs(to.x - from.x) > 5 && Math.abs(to.y - from.y) > 5;
    };
    box.addEventListener("pointerdown", (event) => {
      if (event.pointerType !== "mouse" || event.button !== 0) return; // touch scrolls the page
      from = this.layers.place(event);
      box.setPointerCapture(event.pointerId);
    });
    box.addEventListener("pointermove", (event) => {
      if (from === null) return this.selection.point(this.rowAt(event));
      this.rectangle.hidden = !isDrag(event);
      const to = this.layers.place(event);
      const style = this.rectangle.style;
      [style.left, style.top] = [`${Math.min(from.x, to.x)}px`, `${Math.min(from.y, to.y)}px`];
      [style.width, style.height] = [`${Math.abs(to.x - from.x)}px`, `${Math.abs(to.y - from.y)}px`];
    });
    box.addEventListener("pointerup", (event) => {
      if (isDrag(event)) this.keep(from!, this.layers.place(event));
      [from, this.rectangle.hidden] = [isDrag(event) ? from : null, true];
    });
    box.addEventListener("pointerleave", () => this.selection.point(null));
    box.addEventListener("click", (event) => {
      if (from !== null) {
        from = null; // the end of a drag
        return;
      }
      const row = this.rowAt(event);
      if (row !== null) this.selection.pick(row);
    });
  }

  private keep(a: { x: number; y: number }, b: { x: number; y: number }): void {
    const { x, y } = this.axes!;
    const [x1, x2, y1, y2] = [x.valueAt(a.x), x.valueAt(b.x), y.valueAt(a.y), y.valueAt(b.y)];
    this.selection.setRanges([
      [this.x, { low: Math.min(x1, x2), high: Math.max(x1, x2) }],
      [this.y, { low: Math.min(y1, y2), high: Math.max(y1, y2) }],
    ]);
  }
}
