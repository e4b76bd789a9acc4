// Values to colours, by the maps that plica put into the page.
import { styleColour } from "./dom";
import type { Field } from "./page_data";

export type Rgb = [number, number, number]; // 0 to 255

export function parseHex(hex: string): Rgb {
  return [1, 3, 5].map((i) => parseInt(hex.slice(i, i + 2), 16)) as Rgb;
}

/** The map's colour at `part` of the way from its low end to its high one. */
export function colourAt(map: string[], part: number): Rgb {
  const place = Math.min(Math.max(part, 0), 1) * (map.length - 1);
  const low = Math.min(Math.floor(place), map.length - 2);
  const from = parseHex(map[low]);
  const to = parseHex(map[low + 1]);
  return from.map((value, i) => Math.round(value + (place - low) * (to[i] - value))) as Rgb;
}

/** Where the value lies between the ends of the field's scale, 0 to 1. */
export function partOf(field: Field, value: number): number {
  return Math.min(Math.max((value - field.low) / (field.high - field.low), 0), 1);
}

export function css(rgb: Rgb): string {
  return `rgb(${rgb.join(", ")})`;
}

/** Lines in plots: Okabe and Ito's colours for any kind of colour vision, those that are seen on light and on dark. */
export const lineColours = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9"];

// From the least value to the greatest, evenly in lightness, so that order shows with any kind of colour vision; darker
// than what they stand on by day, lighter by night.
const ramps = {
  day: ["#2b1a6b", "#1d5a9a", "#0d8488", "#4f9636", "#c28a00"],
  night: ["#6a6fd8", "#3f9fe0", "#2fc0b0", "#9ad25a", "#ffdd55"],
};

/** The colour of lines and points at `part` of the way from the least value to the greatest. */
export function rampColour(part: number): string {
  const [red, green, blue] = parseHex(styleColour("paper"));
  return css(colourAt(red + green + blue > 380 ? ramps.day : ramps.night, part));
}
