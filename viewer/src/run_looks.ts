// Which line is which run: its colour and its dashes, in plots, tables and beside pictures.
import { lineColours, rampColour } from "./colour";
import { styleColour } from "./dom";
import { fewRuns, type PageData, type Varied } from "./page_data";
import type { Run } from "./run";
import type { State } from "./state";

export interface LineLook {
  colour: string;
  dash: number[];
}

// With six colours: 36 runs.
const dashes: number[][] = [[], [8, 4], [2, 3], [9, 3, 2, 3], [16, 4], [9, 3, 2, 3, 2, 3]];

/** Whether the runs that have the key all have numbers there. */
export function isNumeric({ values }: Varied): boolean {
  const given = values.filter((value) => value !== "");
  return new Set(given).size > 1 && given.every((value) => Number.isFinite(Number(value)));
}

export class RunLooks {
  /** Keys that may give runs their colours. */
  readonly keys: Varied[];

  constructor(private readonly runs: Run[], page: PageData, private readonly state: State) {
    this.keys = page.varied.filter(isNumeric);
  }

  /** The key by which runs are coloured at first: the one number in which many differ; else each run has its own. */
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
    // Runs of one value share its colour and differ in dashes.
    const value = key.values[run.number];
    const same = this.runs.filter((other) => key.values[other.number] === value);
    const dash = dashes[same.indexOf(run) % dashes.length];
    if (value === "") return { colour: styleColour("faint"), dash };
    const order = [...new Set(key.values.filter((other) => other !== "").map(Number))].sort((a, b) => a - b);
    return { colour: this.ramp(order.indexOf(Number(value)) / (order.length - 1)), dash };
  }

  /** The ramp's colour at `part` of the way from its least value to its greatest. */
  ramp(part: number): string {
    return rampColour(part);
  }
}

/** A short piece of the line. */
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
