// What plica put into the page: src/show/report.cpp and report_run.hpp.
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
  label: string;
  sight: Vec3;
  up: Vec3;
  cut_axis: number | null;
}

export interface Range {
  low: number;
  high: number;
}

export type Summary = Record<string, string | number | null | Record<string, string | number | null>>;

export interface RunData {
  name: string;
  summary: Summary | null;
  scenario: string;
  series: string;
  midline: string;
  shell: { half_axis_um: number; radius_um: number } | null;
  frames_saved: number;
  every: number;
  box: { low: Vec3; high: Vec3 };
  fields: Record<string, Range>;
  regions: string[];
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
  runs: RunData[];
}

export function readPageData(): PageData {
  const data = JSON.parse(document.getElementById("data")!.textContent!) as PageData;
  if (data.format !== 1) throw new Error(`the data are of format ${data.format}; this page reads format 1`);
  return data;
}

/** The field's title with its unit: "pressure, Pa". */
export function titleOf(field: Field): string {
  return field.unit === "" ? field.label : `${field.label}, ${field.unit}`;
}
