// Mapping of values to pixels along one axis, and its ticks. Runs without a value have a separate lane before the axis.
import { number } from "../text";
import type { Column } from "./column";

export interface Tick {
  at: number; // pixels
  text: string;
}

const laneWidth = 22;

export class Axis {
  private readonly low: number;
  private readonly high: number;
  private readonly begin: number; // pixels of the axis proper
  readonly isLogarithmic: boolean;
  readonly hasLane: boolean;

  /** Axis from pixel `from` (smallest values) to pixel `to`. */
  constructor(readonly column: Column, private readonly from: number, private readonly to: number, logarithmic = column.isLogarithmic) {
    this.isLogarithmic = logarithmic && !column.words && column.low > 0;
    this.hasLane = column.missing > 0;
    this.begin = this.hasLane ? from + Math.sign(to - from) * laneWidth : from;
    const [low, high] = column.low <= column.high ? [column.low, column.high] : [0, 1]; // no value at all
    if (column.words) [this.low, this.high] = [low - 0.5, high + 0.5];
    else {
      const [a, b] = [this.inner(low), this.inner(high)];
      const margin = b > a ? 0.03 * (b - a) : Math.max(Math.abs(a) * 0.1, 1e-12);
      [this.low, this.high] = [a - margin, b + margin];
    }
  }

  private inner(value: number): number {
    return this.isLogarithmic ? Math.log10(value) : value;
  }

  /** Position of the lane of missing values. */
  get lane(): number {
    return this.from + Math.sign(this.to - this.from) * 0.35 * laneWidth;
  }

  at(value: number): number {
    if (Number.isNaN(value)) return this.lane;
    return this.begin + ((this.inner(value) - this.low) / (this.high - this.low)) * (this.to - this.begin);
  }

  valueAt(pixel: number): number {
    const inner = this.low + ((pixel - this.begin) / (this.to - this.begin)) * (this.high - this.low);
    return this.isLogarithmic ? 10 ** inner : inner;
  }

  /** About `most` ticks at round values. */
  ticks(most: number): Tick[] {
    const { words } = this.column;
    if (words) {
      const every = Math.ceil(words.length / Math.max(most * 2, 1));
      return words.flatMap((_, i) => (i % every === 0 ? [{ at: this.at(i), text: this.column.textOf(i) }] : []));
    }
    const values = this.isLogarithmic ? this.decades(most) : roundValues(this.low, this.high, most);
    return values.map((value) => ({ at: this.at(value), text: number(value) }));
  }

  private decades(most: number): number[] {
    const decades = this.high - this.low;
    const factors = decades > most ? [1] : decades > most / 3 ? [1, 3] : [1, 2, 5];
    const every = Math.max(Math.ceil(decades / most), 1);
    const values: number[] = [];
    for (let power = Math.floor(this.low); power <= this.high; ++power)
      if (power % every === 0)
        for (const factor of factors) {
          const value = Number((factor * 10 ** power).toPrecision(3));
          if (Math.log10(value) >= this.low && Math.log10(value) <= this.high) values.push(value);
        }
    return values.length > 1 ? values : [this.column.low, this.column.high];
  }
}

/** Multiples of 1, 2 or 5 times a power of ten: about `most` of them. */
export function roundValues(low: number, high: number, most: number): number[] {
  const rough = (high - low) / Math.max(most, 1);
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].map((factor) => factor * power).find((candidate) => candidate >= rough / 1.6)!;
  const values: number[] = [];
  for (let i = Math.ceil(low / step); i * step <= high + 1e-9 * step; ++i) values.push(Number((i * step).toPrecision(12)));
  return values;
}
