// Colours of values, by the colour maps of the page.
import { styleColour } from "./dom";
import type { Field } from "./page_data";

export type Rgb = [number, number, number]; // 0 to 255

export function parseHex(hex: string): Rgb {
  return [1, 3, 5].map((i) => parseInt(hex.slice(i, i + 2), 16)) as Rgb;
}

/** Colour of the map at `part`, from 0 (low end) to 1 (high end). */
export function colourAt(map: string[], part: number): Rgb {
  const place = Math.min(Math.max(part, 0), 1) * (map.length - 1);
  const low = Math.min(Math.floor(place), map.length - 2);
  const from = parseHex(map[low]);
  const to = parseHex(map[low + 1]);
  return from.map((value, i) => Math.round(value + (place - low) * (to[i] - value))) as Rgb;
}

/** Position of a value on the scale of the field, 0 to 1. */
export function partOf(field: Field, value: number): number {
  return Math.min(Math.max((value - field.low) / (field.high - field.low), 0), 1);
}

export function css(rgb: Rgb): string {
  return `rgb(${rgb.join(", ")})`;
}

/** Line colours of plots: Okabe and Ito's colours for any kind of colour vision that suit light and dark backgrounds. */
export const lineColours = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9"];

// Uniform in lightness from the smallest to the largest value, so that order is visible with any kind of colour vision;
// darker than a light background, lighter than a dark one.
const ramps = {
  day: ["#2b1a6b", "#1d5a9a", "#0d8488", "#4f9636", "#c28a00"],
  night: ["#6a6fd8", "#3f9fe0", "#2fc0b0", "#9ad25a", "#ffdd55"],
};

/** Colour of lines and points at `part`, from 0 (smallest value) to 1 (largest). */
export function rampColour(part: number): string {
  const [red, green, blue] = parseHex(styleColour("paper"));
  return css(colourAt(red + green + blue > 380 ? ramps.day : ramps.night, part));
}
