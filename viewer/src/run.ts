// Run: its tables, and its snapshots as positions and values at any time.
import { PackedArrays, inflate } from "./packed";
import type { Field, RunData, Vec3 } from "./page_data";
import { Table } from "./table";

/** The frames between two divisions: the same cells of the same elements, at several times. Times and counts are there at
 * once, arrays after Run.load. */
export class Topology {
  readonly nodes: number;
  readonly cells: number;
  readonly times: number[];
  elements!: Uint32Array; // 8 nodes each
  cellOfElement!: Uint32Array;
  elementsOfCell!: number[][];
  facets!: Uint32Array; // 4 nodes each
  elementOfFacet!: Uint32Array;
  outlines!: Uint32Array; // 2 nodes each
  cellIds!: Uint32Array;
  generation!: Uint32Array;
  private packed!: PackedArrays;
  private motherIds!: Uint32Array;
  private regions!: Uint32Array;
  private readonly arrays = new Map<string, Uint16Array>();

  constructor(private readonly data: RunData, readonly index: number, private readonly colourOfRegion: number[]) {
    const entry = data.topologies[index];
    this.nodes = entry.nodes;
    this.cells = entry.cells;
    this.times = entry.times_s;
  }

  take(packed: PackedArrays): void {
    this.packed = packed;
    const ids = (name: string) => packed.get(`${this.index}/${name}`) as Uint32Array;
    this.elements = ids("elements");
    this.cellOfElement = ids("cell_of_element");
    this.facets = ids("facets");
    this.elementOfFacet = ids("element_of_facet");
    this.outlines = ids("outlines");
    this.cellIds = ids("cell_id");
    this.generation = ids("generation");
    this.motherIds = ids("mother_id");
    this.regions = ids("regions");
    this.elementsOfCell = Array.from({ length: this.cells }, () => []);
    this.cellOfElement.forEach((cell, element) => this.elementsOfCell[cell].push(element));
  }

  /** Index of the cell with this id in this topology; -1 if none. */
  cellWith(id: number): number {
    return this.cellIds.indexOf(id);
  }

  motherOf(cell: number): number | null {
    return this.motherIds[cell] === 0 ? null : this.motherIds[cell] - 1;
  }

  regionsOf(cell: number): string[] {
    return this.data.regions.filter((_, bit) => (this.regions[cell] >>> bit) & 1);
  }

  nodesOfCell(cell: number): number[] {
    return this.elementsOfCell[cell].flatMap((e) => Array.from(this.elements.subarray(8 * e, 8 * e + 8)));
  }

  /** Positions at a snapshot of this topology, interpolated by `part` to the next; um, 3 per node. */
  positions(moment: number, part: number, out: Float32Array): void {
    const { low, high } = this.data.box;
    const steps = this.array("positions");
    const at = moment * 3 * this.nodes;
    const next = part > 0 ? at + 3 * this.nodes : at;
    const scale = [0, 1, 2].map((i) => (high[i] - low[i]) / 65535);
    for (let n = 0; n < 3 * this.nodes; n += 3)
      for (let i = 0; i < 3; ++i)
        out[n + i] = low[i] + scale[i] * (steps[at + n + i] + part * (steps[next + n + i] - steps[at + n + i]));
  }

  /** Values of a field, interpolated likewise; nodes or cells. */
  values(field: Field, moment: number, part: number, out: Float32Array): void {
    const range = this.data.fields[field.name];
    const steps = this.array(`field/${field.name}`);
    const count = field.on_nodes ? this.nodes : this.cells;
    const scale = (range.high - range.low) / 65535;
    const at = moment * count;
    const next = part > 0 ? at + count : at;
    for (let i = 0; i < count; ++i)
      out[i] = range.low + scale * (steps[at + i] + part * (steps[next + i] - steps[at + i]));
    if (field.name === "region") for (let i = 0; i < count; ++i) out[i] = this.colourOfRegion[Math.round(out[i])] ?? 0;
  }

  /** Value of a field in a cell; for node fields the mean over its nodes. */
  valueOfCell(field: Field, moment: number, cell: number): number {
    const { low, high } = this.data.fields[field.name];
    const steps = this.array(`field/${field.name}`);
    const places = field.on_nodes ? this.nodesOfCell(cell) : [cell];
    const first = moment * (field.on_nodes ? this.nodes : this.cells);
    const mean = places.reduce((sum, place) => sum + steps[first + place], 0) / places.length;
    const value = low + ((high - low) * mean) / 65535;
    return field.name === "region" ? (this.colourOfRegion[Math.round(value)] ?? 0) : value;
  }

  /** Centre, direction from its basal to its apical side, and largest distance of a node from the centre; um. */
  placeOfCell(cell: number, moment: number): { centre: Vec3; outward: Vec3; radius: number } {
    const positions = new Float32Array(3 * this.nodes);
    this.positions(moment, 0, positions);
    const [centre, outward]: Vec3[] = [[0, 0, 0], [0, 0, 0]];
    const nodes = this.nodesOfCell(cell);
    nodes.forEach((node, i) => {
      for (let k = 0; k < 3; ++k) {
        centre[k] += positions[3 * node + k] / nodes.length;
        outward[k] += positions[3 * node + k] * (i % 8 < 4 ? -1 : 1); // nodes 4 to 7 of an element are apical
      }
    });
    const distance = (node: number) => Math.hypot(...centre.map((x, k) => positions[3 * node + k] - x));
    const length = Math.hypot(...outward) || 1;
    return { centre, outward: outward.map((x) => x / length) as Vec3, radius: Math.max(...nodes.map(distance)) };
  }

  private array(name: string): Uint16Array {
    let array = this.arrays.get(name);
    if (!array) this.arrays.set(name, (array = this.packed.get(`${this.index}/${name}`) as Uint16Array));
    return array;
  }
}

/** Position in time: snapshot of a topology, and fraction of the interval to the next. */
export interface Place {
  topology: Topology;
  moment: number;
  part: number;
}

export class Run {
  series: Table;
  readonly midline: Table;
  readonly topologies: Topology[];
  marked: readonly number[] = []; // cells outlined beside the picked one
  readonly frames: { topology: Topology; moment: number; time: number }[] = [];
  private loading: Promise<void> | null = null;
  private isLoaded = false;

  /** `regions`: names of the legend; a run may lack some. */
  constructor(readonly data: RunData, readonly number: number, regions: string[]) {
    this.series = new Table(data.series);
    this.midline = new Table(data.midline);
    const colourOfRegion = [0, ...data.coloured_regions.map((name) => 1 + regions.indexOf(name))];
    this.topologies = data.topologies.map((_, i) => new Topology(data, i, colourOfRegion));
    for (const topology of this.topologies)
      topology.times.forEach((time, moment) => this.frames.push({ topology, moment, time }));
  }

  /** Unpack the snapshots; slow, so only for visible runs. */
  load(): Promise<void> {
    this.loading ??= this.unpack();
    return this.loading;
  }

  get loaded(): boolean {
    return this.isLoaded;
  }

  private async unpack(): Promise<void> {
    const element = document.getElementById(`frames-${this.number}`)!;
    const packed = new PackedArrays(await inflate(element.textContent!), this.data.arrays);
    element.textContent = "";
    for (const topology of this.topologies) topology.take(packed);
    this.isLoaded = true;
  }

  get name(): string {
    return this.data.name;
  }

  get title(): string {
    const title = this.data.summary?.title;
    return typeof title === "string" && title !== "" ? title : this.name;
  }

  get hasFrames(): boolean {
    return this.frames.length > 0;
  }

  /** Word for `furrow_depth_um`: "furrow", "fold", or "" where it has no value or no meaning. */
  get depthWord(): "furrow" | "fold" | "" {
    const hasDepth = this.series.column("furrow_depth_um").some((value) => value !== null);
    return hasDepth ? this.data.depth_word : "";
  }

  /** Cell at which the solver failed, if it is one cell. */
  get failedCell(): number | null {
    const cell = this.data.summary?.failed_cell;
    return typeof cell === "number" ? cell : null;
  }

  get failed(): boolean {
    return this.data.summary?.status === "failed";
  }

  get endTime(): number {
    const rows = this.series.rows;
    return Math.max(this.frames.at(-1)?.time ?? 0, rows.at(-1)?.[0] ?? 0);
  }

  /** Last snapshot at or before a time. */
  frameAt(time: number): number {
    let low = 0;
    for (let high = this.frames.length - 1; low < high; ) {
      const middle = Math.ceil((low + high) / 2);
      if (this.frames[middle].time <= time + 1e-6) low = middle;
      else high = middle - 1;
    }
    return low;
  }

  placeAt(time: number): Place {
    const index = this.frameAt(time);
    const { topology, moment } = this.frames[index];
    const next = this.frames[index + 1];
    const within = next && next.topology === topology && time > this.frames[index].time;
    const part = within ? (time - this.frames[index].time) / (next.time - this.frames[index].time) : 0;
    return { topology, moment, part: part < 1e-9 ? 0 : Math.min(part, 1) };
  }

  get centre(): Vec3 {
    const { low, high } = this.data.box;
    return [0, 1, 2].map((i) => (low[i] + high[i]) / 2) as Vec3;
  }

  /** Half size of the bounding box of all snapshots, um. */
  get halfSize(): Vec3 {
    const { low, high } = this.data.box;
    return [0, 1, 2].map((i) => (high[i] - low[i]) / 2) as Vec3;
  }

  /** The cell at a snapshot or, before its birth, its ancestor; -1 after its division. */
  ancestorAt(id: number, topology: Topology): number {
    for (let t = this.topologies.length - 1, wanted: number | null = id; wanted !== null; ) {
      const here = topology.cellWith(wanted);
      if (here >= 0) return here;
      // The mother is known from the snapshots with the cell.
      let mother: number | null = null;
      for (let i = t; i >= 0; --i) {
        const cell = this.topologies[i].cellWith(wanted);
        if (cell >= 0) {
          mother = this.topologies[i].motherOf(cell);
          t = i;
          break;
        }
      }
      wanted = mother;
    }
    return -1;
  }

  /** Centre, apical direction and radius of a cell at a time; null after its division. */
  placeOfCell(id: number, time: number): { centre: Vec3; outward: Vec3; radius: number } | null {
    const { topology, moment } = this.placeAt(time);
    const cell = this.ancestorAt(id, topology);
    return cell < 0 ? null : topology.placeOfCell(cell, moment);
  }

  daughtersOf(id: number): number[] {
    const daughters = new Set<number>();
    for (const topology of this.topologies)
      topology.cellIds.forEach((daughter, cell) => {
        if (topology.motherOf(cell) === id) daughters.add(daughter);
      });
    return [...daughters];
  }

  /** Values of a cell over the snapshots, of its ancestors before its birth; missing after its division. */
  history(field: Field, id: number): { time: number; value: number }[] {
    const points: { time: number; value: number }[] = [];
    for (const { topology, moment, time } of this.frames) {
      const cell = this.ancestorAt(id, topology);
      if (cell >= 0) points.push({ time, value: topology.valueOfCell(field, moment, cell) });
    }
    return points;
  }
}
