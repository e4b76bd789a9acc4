// Colour and dashes of each run in plots, tables and beside pictures.
import { lineColours, rampColour } from "./colour";
import { styleColour } from "./dom";
import { fewRuns, type PageData, type Varied } from "./page_data";
import type { Run } from "./run";
import type { State } from "./state";

export interface LineLook {
  colour: string;
  dash: number[];
}

// Six colours: 36 runs.
const dashes: number[][] = [[], [8, 4], [2, 3], [9, 3, 2, 3], [16, 4], [9, 3, 2, 3, 2, 3]];

/** Whether all values of the key are numbers. */
export function isNumeric({ values }: Varied): boolean {
  const given = values.filter((value) => value !== "");
  return new Set(given).size > 1 && given.every((value) => Number.isFinite(Number(value)));
}

export class RunLooks {
  /** Keys usable for colouring runs. */
  readonly keys: Varied[];

  constructor(private readonly runs: Run[], page: PageData, private readonly state: State) {
    this.keys = page.varied.filter(isNumeric);
  }

  /** Initial key for colouring runs: the only numeric key with many values; else one colour per run. */
  static firstKey(page: PageData): string {
    const numeric = page.varied.filter(isNumeric);
    return page.runs.length > fewRuns && page.varied.length === 1 && numeric.length === 1 ? numeric[0].key : "";
  }

  lookOf(run: Run): LineLook {
    const key = this.keys.find((candidate) => candidate.key === this.state.now.colourBy);
    if (!key) {
      const turn = Math.floor(run.number / lineColours.length);
      return { colour: lineColours[run.number % lineColours.length], dash: dashes[turn % dashes.length] };
    }
    // Runs with equal values share a colour and differ in dashes.
    const value = key.values[run.number];
    const same = this.runs.filter((other) => key.values[other.number] === value);
    const dash = dashes[same.indexOf(run) % dashes.length];
    if (value === "") return { colour: styleColour("faint"), dash };
    const order = [...new Set(key.values.filter((other) => other !== "").map(Number))].sort((a, b) => a - b);
    return { colour: this.ramp(order.indexOf(Number(value)) / (order.length - 1)), dash };
  }

  /** Colour of the ramp at `part`, from 0 (smallest value) to 1 (largest). */
  ramp(part: number): string {
    return rampColour(part);
  }
}

/** Line sample for legends. */
export function sampleOf({ colour, dash }: LineLook): SVGElement {
  const make = (tag: string, attributes: Record<string, string>) => {
    const made = document.createElementNS("http://www.w3.org/2000/svg", tag);
    for (const [name, value] of Object.entries(attributes)) made.setAttribute(name, value);
    return made;
  };
  const sample = make("svg", { class: "sample", width: "30", height: "8", "aria-hidden": "true" });
  sample.append(make("line", {
    x1: "0", x2: "30", y1: "4", y2: "4", stroke: colour, "stroke-width": "3", "stroke-dasharray": dash.join(" "),
  }));
  return sample as SVGElement;
}
