// Columns of the table of a study.
import { lastOf, number, words } from "../text";

export type Role =
  "point" | "key" | "replicate" | "status" | "verdict" | "measure" | "steps" | "wall_s" | "reason" | "seeds" | "kept";

export interface ColumnEntry {
  name: string;
  role: Role;
  words?: string[];
}

const mostSteps = 60; // distinct values of a column treated as steps

/** Column of values, one number per run: for words the index in the list, from 0. NaN if missing. */
export class Column {
  readonly name: string;
  readonly role: Role;
  readonly words: string[] | null;
  readonly low: number;
  readonly high: number;
  readonly missing: number; // runs without a value
  readonly steps: number[] | null; // distinct values, if few
  private usual: { low: number; high: number } | null = null;
  label: string;
  readonly unit: string;

  /** `written`: values as in runs.csv, where they differ. */
  constructor({ name, role, words: list }: Pick<ColumnEntry, "name" | "role" | "words">, readonly values: Float64Array,
              readonly isLogarithmic = false, private readonly written = values) {
    [this.name, this.role, this.words] = [name, role, list ?? null];
    [this.label, this.unit] = role === "wall_s" ? ["time taken", "s"] : words(lastOf(name));
    let [low, high, missing] = [Infinity, -Infinity, 0];
    const different = new Set<number>();
    for (const value of values) {
      if (Number.isNaN(value)) {
        ++missing;
        continue;
      }
      low = Math.min(low, value);
      high = Math.max(high, value);
      if (different.size <= mostSteps) different.add(value);
    }
    [this.low, this.high, this.missing] = [low, high, missing];
    this.steps = different.size <= mostSteps ? [...different].sort((a, b) => a - b) : null;
  }

  get title(): string {
    return this.unit === "" ? this.label : `${this.label}, ${this.unit}`;
  }

  /** Title whose unit is not separated from the preceding word by line breaks. */
  get heading(): string {
    return this.unit === "" ? this.label : `${this.label},\u00a0${this.unit.replaceAll(" ", "\u00a0")}`;
  }

  /** Range of values, without outliers (1 % at each end). */
  get usualRange(): { low: number; high: number } {
    if (!this.usual) {
      const sorted = this.values.filter((value) => !Number.isNaN(value)).sort();
      const [low, high] = [0.01, 0.99].map((part) => sorted[Math.round(part * (sorted.length - 1))]);
      const areFar = !this.words && high > low && this.high - this.low > 1.5 * (high - low);
      this.usual = areFar ? { low, high } : { low: this.low, high: this.high };
    }
    return this.usual;
  }

  /** Whether the column has more than one value. */
  get varies(): boolean {
    return this.high > this.low;
  }

  has(row: number): boolean {
    return !Number.isNaN(this.values[row]);
  }

  /** Format a value for reading. */
  textOf(value: number): string {
    if (Number.isNaN(value)) return "none";
    return this.words ? plainWord(this.words[value], this.role) : number(value);
  }

  text(row: number): string {
    return this.textOf(this.values[row]);
  }

  /** Format a value as input of plica; "" if missing. */
  exact(row: number): string {
    const value = this.written[row];
    if (Number.isNaN(value)) return "";
    return this.words ? this.words[value] : String(value);
  }
}

// Words of keys are in TOML, with quotes; a status is one word.
function plainWord(word: string, role: Role): string {
  if (role === "status") return word.replaceAll("_", " ");
  return role === "key" && /^"[^"\\]*"$/.test(word) ? word.slice(1, -1) : word;
}

/** Whether a run has ended regularly, by its status. */
export function hasEnded(status: Column, row: number): boolean {
  return ["equilibrium", "end_time"].includes(status.exact(row));
}
