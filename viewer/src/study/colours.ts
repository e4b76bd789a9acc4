// Colours of runs by the chosen column: uniform from its smallest to its largest value, or one colour per word.
import { lineColours, rampColour } from "../colour";
import { element, styleColour } from "../dom";
import { number } from "../text";
import type { Column } from "./column";
import { verdictColours } from "./verdict";

const rampSteps = 48;
const statusColours: Record<string, string> = {
  equilibrium: lineColours[0], end_time: lineColours[5], failed: lineColours[1], refused: lineColours[3], crashed: lineColours[4],
};

export class Colours {
  /** Colours by placeOf; the last is for runs without a value. */
  readonly list: string[];

  private static last: { colours: Colours; paper: string } | null = null;

  /** Computed once per column and theme. */
  static of(column: Column): Colours {
    const paper = styleColour("paper");
    if (this.last?.paper !== paper || this.last.colours.column !== column) this.last = { colours: new Colours(column), paper };
    return this.last.colours;
  }

  private constructor(readonly column: Column) {
    const faint = styleColour("faint");
    const own = column.words
      ? column.words.map((word, i) => colourOfWord(column, word, i, faint))
      : Array.from({ length: rampSteps }, (_, i) => rampColour(i / (rampSteps - 1)));
    this.list = [...own, faint];
  }

  placeOf(value: number): number {
    if (Number.isNaN(value)) return this.list.length - 1;
    return this.column.words ? value : Math.round(this.part(value) * (rampSteps - 1));
  }

  at(value: number): string {
    return this.list[this.placeOf(value)];
  }

  /** Position of a value between the smallest and the largest, 0 to 1. */
  private part(value: number): number {
    const { usualRange: { low, high }, isLogarithmic } = this.column;
    if (!(high > low)) return 0.5;
    const part = isLogarithmic && low > 0 ? Math.log(value / low) / Math.log(high / low) : (value - low) / (high - low);
    return Math.min(Math.max(part, 0), 1);
  }

  /** Colour ramp with its ends; columns of words have tick boxes instead. */
  legend(): HTMLElement {
    const { column } = this;
    const box = element("span", { class: "ramp" });
    if (column.words) {
      if (column.role === "status" || column.words.length > 8) return box; // its ticks have the colours
      column.words.forEach((_, i) => box.append(swatch(this.list[i]), column.textOf(i)));
    } else {
      const strip = element("span", { class: "strip" });
      strip.style.background = `linear-gradient(to right, ${[0, 0.25, 0.5, 0.75, 1].map(rampColour).join(", ")})`;
      const { low, high } = column.usualRange;
      box.append((low > column.low ? "≤ " : "") + number(low, 3), strip, (high < column.high ? "≥ " : "") + number(high, 3));
    }
    if (column.missing > 0) box.append(swatch(this.list.at(-1)!), "none");
    return box;
  }
}

/** Colour of crosses for runs without a result. */
export function withoutResult(): string {
  return styleColour("accent");
}

export function colourOfStatus(status: string): string {
  return statusColours[status] ?? styleColour("faint");
}

function colourOfWord(column: Column, word: string, i: number, faint: string): string {
  if (column.role === "verdict") return verdictColours[word];
  return column.role === "status" ? (statusColours[word] ?? faint) : lineColours[i % lineColours.length];
}

export function swatch(colour: string): HTMLElement {
  const made = element("span", { class: "swatch" });
  made.style.background = colour;
  return made;
}
