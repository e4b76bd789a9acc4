// Selection: visible, picked and highlighted runs, and their colouring.
import { comparisonIn, compares, isNamed, isPart, wordsOf } from "../filter";
import type { Column } from "./column";
import type { Study } from "./study_data";

export interface Range {
  low: number;
  high: number;
}

export type What = "shown" | "picked" | "pointed" | "colour";

export class Selection {
  /** Visibility of runs, 1 if visible. */
  readonly shown: Uint8Array;
  shownRows: number[] = [];
  text = "";
  readonly ranges = new Map<Column, Range>();
  readonly ticks = new Map<Column, Set<number>>(); // selected values of a column of words
  picked: number | null = null;
  pointed: number | null = null;
  private isWaiting = false;
  private readonly listeners: { what: What; tell: () => void }[] = [];

  constructor(readonly study: Study, private colouredBy: Column) {
    this.shown = new Uint8Array(study.runs);
    this.filter();
  }

  get colour(): Column {
    return this.colouredBy;
  }

  on(what: What, tell: () => void): void {
    this.listeners.push({ what, tell });
  }

  setText(text: string): void {
    this.text = text;
    this.apply();
  }

  /** Hide runs with values outside a range or missing; null removes the range. */
  setRange(column: Column, range: Range | null): void {
    if (range) this.ranges.set(column, range);
    else this.ranges.delete(column);
    this.applySoon();
  }

  setRanges(ranges: [Column, Range][]): void {
    for (const [column, range] of ranges) this.ranges.set(column, range);
    this.apply();
  }

  setTicks(column: Column, values: Set<number> | null): void {
    if (values) this.ticks.set(column, values);
    else this.ticks.delete(column);
    this.apply();
  }

  clear(): void {
    this.text = "";
    this.ranges.clear();
    this.ticks.clear();
    this.apply();
  }

  pick(row: number | null): void {
    this.picked = row;
    this.tell("picked");
  }

  point(row: number | null): void {
    if (row === this.pointed) return;
    this.pointed = row;
    this.tell("pointed");
  }

  colourBy(column: Column): void {
    this.colouredBy = column;
    this.tell("colour");
  }

  // At most once per frame.
  private applySoon(): void {
    if (this.isWaiting) return;
    this.isWaiting = true;
    requestAnimationFrame(() => {
      this.isWaiting = false;
      this.apply();
    });
  }

  private apply(): void {
    this.filter();
    this.tell("shown");
  }

  private filter(): void {
    const fits = fitting(this.study, this.text);
    this.shownRows = [];
    for (let row = 0; row < this.study.runs; ++row) {
      const isIn = this.isTicked(row) && this.isInRanges(row) && fits(row);
      this.shown[row] = Number(isIn);
      if (isIn) this.shownRows.push(row);
    }
  }

  private isInRanges(row: number): boolean {
    for (const [{ values }, { low, high }] of this.ranges) if (!(values[row] >= low && values[row] <= high)) return false;
    return true;
  }

  private isTicked(row: number): boolean {
    for (const [{ values }, wanted] of this.ticks) if (!wanted.has(values[row])) return false;
    return true;
  }

  private tell(what: What): void {
    for (const listener of this.listeners) if (listener.what === what) listener.tell();
  }
}

/** Runs that match all words of a text (../filter.ts). */
export function fitting(study: Study, text: string): (row: number) => boolean {
  const columns = study.columns.filter(({ role }) => role !== "kept" && role !== "seeds");
  const tests = wordsOf(text).map((word) => testOf(columns, word));
  return (row) => tests.every((test) => test(row));
}

function testOf(columns: Column[], word: string): (row: number) => boolean {
  const asked = comparisonIn(word);
  if (asked) {
    const column = columns.find(({ name }) => isNamed(name, asked.name));
    if (!column) return () => false;
    if (!column.words) return (row) => compares(column.has(row) ? String(column.values[row]) : "", asked.sign, asked.value);
    const fits = column.words.map((_, value) => compares(column.textOf(value).toLowerCase(), asked.sign, asked.value));
    return (row) => column.has(row) && fits[column.values[row]];
  }
  const tests = columns.map((column) => {
    if (!column.words) return (row: number) => column.values[row] === Number(word);
    const fits = column.words.map((own, value) =>
      isPart(own.toLowerCase(), word) || isPart(column.textOf(value).toLowerCase(), word));
    return (row: number) => column.has(row) && fits[column.values[row]];
  });
  return (row) => tests.some((test) => test(row));
}
