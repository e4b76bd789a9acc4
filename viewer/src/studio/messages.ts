// Binary messages of the server: python/plica/studio/messages.py.
import type { Range, RunData, Vec3 } from "../page_data";

export type Numbers = Float32Array | Uint32Array;

export interface Shape {
  kind: "shape";
  shape: string; // name
  nodes: number;
  cells: number;
  regions: string[];
  changing: string[]; // fields of its active laws and signals
  own_fields: Record<string, [number, number]>;
  box: { low: Vec3; high: Vec3 };
  shell: RunData["shell"];
  views: Record<string, { sight: Vec3; up: Vec3; cut_axis: number | null; cut_um: number }>;
}

export interface Frame {
  kind: "frame";
  slot: number;
  run: number;
  index: number;
  count: number;
  time_s: number;
  shape: string;
  field: string;
  range?: [number, number];
  columns: string[];
  first_row: number;
  rows: (number | null)[][];
}

export interface Message<Head> {
  head: Head;
  arrays: Map<string, Numbers>;
}

export function unpack(bytes: ArrayBuffer): Message<Shape | Frame> {
  const length = new DataView(bytes).getUint32(0, true);
  const { arrays: index, ...head } = JSON.parse(new TextDecoder().decode(new Uint8Array(bytes, 4, length)));
  const arrays = new Map<string, Numbers>();
  let offset = 4 + length;
  for (const [name, kind, count] of index as [string, string, number][]) {
    arrays.set(name, kind === "f" ? new Float32Array(bytes, offset, count) : new Uint32Array(bytes, offset, count));
    offset += 4 * count;
  }
  return { head, arrays };
}

export function rangeOf([low, high]: [number, number]): Range {
  return { low, high };
}
