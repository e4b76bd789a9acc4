// Data of the page, written by src/show/report.cpp.
import type { Outcomes } from "./outcomes";
import type { ArrayEntry } from "./packed";

export type Vec3 = [number, number, number];

export interface Field {
  name: string;
  label: string;
  unit: string;
  on_nodes: boolean;
  scale: "from-zero" | "about" | "steps";
  map: string;
  low: number;
  high: number;
}

export interface View {
  name: string;
  title: string;
  label: string;
  sight: Vec3;
  up: Vec3;
  cut_axis: number | null;
}

export interface Range {
  low: number;
  high: number;
}

export type Summary = Record<string, string | number | null | object>;

/** Whether a value of a summary is a table: provenance, energies by law. */
export function isTable(value: unknown): boolean {
  return typeof value === "object" && value !== null;
}

export interface RunData {
  name: string;
  summary: Summary | null;
  scenario: string;
  series: string;
  midline: string;
  shell: { half_axis_um: number; radius_um: number } | null;
  axes: [string, string][]; // names of the low and high ends of x, y, z
  letters: [string, string][];
  depth_word: "furrow" | "fold" | ""; // for furrow_depth_um; "": it has no meaning
  frames_saved: number;
  every: number;
  box: { low: Vec3; high: Vec3 };
  fields: Record<string, Range>;
  regions: string[];
  coloured_regions: string[]; // values of the field "region", from 1
  topologies: { times_s: number[]; nodes: number; elements: number; cells: number }[];
  arrays: ArrayEntry[];
}

export interface PageData {
  format: number;
  made_by: string;
  fields: Field[];
  maps: Record<string, string[]>;
  views: View[];
  view_cut_um: number;
  varied: Varied[];
  outcomes: Outcomes | null;
  runs: RunData[];
}

/** Key that differs between runs; values as in TOML, "" if missing. */
export interface Varied {
  key: string;
  values: string[];
}

/** Number of runs above which pictures are small. */
export const fewRuns = 4;

export function readPageData(): PageData {
  const data = JSON.parse(document.getElementById("data")!.textContent!) as PageData;
  if (data.format !== 1) throw new Error(`the data have format ${data.format}, but this page reads format 1`);
  return data;
}

/** Coloured regions of all runs; the legend and the field "region" count them from 1. */
export function colouredRegions(page: PageData): string[] {
  return [...new Set(page.runs.flatMap((run) => run.coloured_regions))];
}

/** Name of an integer value of the field; null if it is just a number. */
export function nameOfStep(field: Field, step: number, page: PageData): string | null {
  if (field.name === "region") return step === 0 ? "other cells" : (colouredRegions(page)[step - 1] ?? null);
  if (field.name === "self-intersections") return ["no", "yes"][step] ?? null;
  return null;
}

/** Title of a field with unit: "pressure, Pa". */
export function titleOf(field: Field): string {
  return field.unit === "" ? field.label : `${field.label}, ${field.unit}`;
}
