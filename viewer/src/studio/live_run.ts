// Run whose frames come one by one from the server, in the classes that draw the runs of a report.
import type { Field, RunData, Vec3 } from "../page_data";
import { type Place, Run, Topology } from "../run";
import { Table } from "../table";
import type { Frame, Message, Numbers, Shape } from "./messages";

function emptyData(name: string): RunData {
  return {
    name, summary: null, scenario: "", series: "", midline: "", shell: null, axes: [], letters: [],
    depth_word: "furrow", frames_saved: 0, every: 1, box: { low: [-1, -1, -1], high: [1, 1, 1] },
    fields: {}, regions: [], coloured_regions: [], topologies: [], arrays: [],
  };
}

function hasEqual(a: Uint32Array, b: Uint32Array): boolean {
  return a.length === b.length && a.every((value, i) => value === b[i]);
}

export class LiveTopology extends Topology {
  readonly rest: Float32Array;
  now: Float32Array; // positions
  shown: Numbers | null = null; // values of the field of the last frame
  shownField = "";
  other: LiveTopology | null = null; // the run beside it, for differences
  colouredRegions: string[] = []; // those with some but not all cells
  private readonly members = new Map<string, Set<number>>(); // of each region
  private centres: Float32Array | null = null;
  private readonly mirrors = new Map<number, number>();
  private regionNumbers = new Float32Array(0); // smallest coloured region of each cell, from 1; 0: none

  constructor(readonly shape: Shape, private readonly given: Map<string, Numbers>) {
    super({ ...emptyData(""), topologies: [{ times_s: [0], nodes: shape.nodes, elements: 0, cells: shape.cells }] }, 0,
      []);
    const ids = (name: string) => given.get(name) as Uint32Array;
    this.elements = ids("elements");
    this.cellOfElement = ids("cell_of_element");
    this.facets = ids("facets");
    this.elementOfFacet = ids("element_of_facet");
    this.outlines = ids("outlines");
    this.cellIds = ids("cell_id");
    this.generation = new Uint32Array(shape.cells);
    this.rest = given.get("rest") as Float32Array;
    this.now = this.rest;
    this.elementsOfCell = Array.from({ length: this.cells }, () => []);
    this.cellOfElement.forEach((cell, element) => this.elementsOfCell[cell].push(element));
    for (const name of shape.regions) {
      const members = new Set<number>();
      given.get(`region/${name}`)!.forEach((is, cell) => is && members.add(cell));
      this.members.set(name, members);
    }
    this.colourRegions();
  }

  membersOf(region: string): ReadonlySet<number> {
    return this.members.get(region) ?? new Set();
  }

  get regionNames(): string[] {
    return [...this.members.keys()];
  }

  get regionSizes(): Map<string, number> {
    return new Map([...this.members].map(([name, { size }]) => [name, size]));
  }

  /** Show a painted region at once, before the server has built the tissue with it. */
  setRegion(name: string, members: ReadonlySet<number>): void {
    this.members.set(name, new Set(members));
    this.colourRegions();
  }

  private colourRegions(): void {
    const some = [...this.members].filter(([, { size }]) => size > 0 && size < this.cells);
    this.colouredRegions = some.map(([name]) => name);
    this.regionNumbers = new Float32Array(this.cells);
    const bySize = some.map(([, members], i) => ({ members, number: i + 1 })).sort((a, b) =>
      b.members.size - a.members.size);
    for (const { members, number } of bySize) for (const cell of members) this.regionNumbers[cell] = number;
  }

  override motherOf(): number | null {
    return null;
  }

  override regionsOf(cell: number): string[] {
    return this.regionNames.filter((name) => this.membersOf(name).has(cell));
  }

  override positions(_moment: number, _part: number, out: Float32Array): void {
    out.set(this.now);
  }

  override values(field: Field, _moment: number, _part: number, out: Float32Array): void {
    const values = this.valuesOf(field);
    if (values) out.set(values);
    else out.fill(field.scale === "about" ? (field.low + field.high) / 2 : field.low); // not sent yet: pale
  }

  private valuesOf(field: Field): Numbers | null {
    if (field.name === "difference") return this.difference();
    if (field.name === "region") return this.regionNumbers;
    const own = this.given.get(`field/${field.name}`);
    const values = own ?? (this.shownField === field.name ? this.shown : null);
    return values && values.length === (field.on_nodes ? this.nodes : this.cells) ? values : null;
  }

  private difference(): Float32Array | null {
    const other = this.other;
    if (!other || !hasEqual(other.elements, this.elements)) return null;
    const distances = new Float32Array(this.nodes);
    for (let n = 0; n < this.nodes; ++n) {
      const [x, y, z] = [0, 1, 2].map((k) => this.now[3 * n + k] - other.now[3 * n + k]);
      distances[n] = Math.hypot(x, y, z);
    }
    return distances;
  }

  /** Largest distance of a node from its place in the run beside; um. */
  get largestDifference(): number {
    return (this.difference() ?? new Float32Array(1)).reduce((a, b) => Math.max(a, b), 0);
  }

  override valueOfCell(field: Field, _moment: number, cell: number): number {
    const values = this.valuesOf(field);
    if (!values) return NaN;
    if (!field.on_nodes) return values[cell];
    const nodes = this.nodesOfCell(cell);
    return nodes.reduce((sum, node) => sum + values[node], 0) / nodes.length;
  }

  /** Cell whose centre at rest is nearest to the mirror image, at −y, of that of a cell. */
  mirrorOf(cell: number): number {
    const known = this.mirrors.get(cell);
    if (known !== undefined) return known;
    const centres = (this.centres ??= this.restCentres());
    let [best, least] = [cell, Infinity];
    for (let c = 0; c < this.cells; ++c) {
      const [x, y, z] = [0, 1, 2].map((k) => centres[3 * c + k] - (k === 1 ? -1 : 1) * centres[3 * cell + k]);
      const apart = x * x + y * y + z * z;
      if (apart < least) [best, least] = [c, apart];
    }
    this.mirrors.set(cell, best);
    return best;
  }

  // Mean of the nodes of each cell at rest; um, 3 a cell.
  private restCentres(): Float32Array {
    const centres = new Float32Array(3 * this.cells);
    this.elementsOfCell.forEach((_, cell) => {
      const nodes = this.nodesOfCell(cell);
      for (const node of nodes)
        for (let k = 0; k < 3; ++k) centres[3 * cell + k] += this.rest[3 * node + k] / nodes.length;
    });
    return centres;
  }
}

export class LiveRun extends Run {
  shown: LiveTopology | null = null;
  time = 0;
  label: string;

  constructor(number: number) {
    super(emptyData("At rest"), number, []);
    this.label = "At rest";
  }

  /** Show a frame in the shape that it names. */
  take(topology: LiveTopology, message: Message<Frame>): void {
    const { head, arrays } = message;
    topology.now = arrays.get("positions") as Float32Array;
    topology.shown = arrays.get("values") ?? null;
    topology.shownField = head.field;
    this.time = head.time_s;
    if (this.shown !== topology) {
      this.shown = topology;
      this.data.shell = topology.shape.shell;
      this.data.box = topology.shape.box;
    }
    this.data.regions = topology.regionNames;
    this.data.coloured_regions = topology.colouredRegions;
    if (head.first_row === 0 || head.columns.length !== this.series.columns.length) {
      this.series = new Table("");
      this.series.columns.push(...head.columns);
    }
    if (this.series.rows.length === head.first_row) this.series.rows.push(...head.rows);
  }

  forgetRows(): void {
    this.series = new Table("");
  }

  override get name(): string {
    return this.label;
  }

  override get title(): string {
    return this.label;
  }

  override get hasFrames(): boolean {
    return true;
  }

  override get loaded(): boolean {
    return this.shown !== null;
  }

  override load(): Promise<void> {
    return Promise.resolve();
  }

  override get endTime(): number {
    return this.time;
  }

  override placeAt(): Place {
    return { topology: this.shown!, moment: 0, part: 0 };
  }

  override ancestorAt(id: number): number {
    return this.shown?.cellWith(id) ?? -1;
  }

  override placeOfCell(id: number): { centre: Vec3; outward: Vec3; radius: number } | null {
    const cell = this.ancestorAt(id);
    return cell < 0 ? null : this.shown!.placeOfCell(cell, 0);
  }
}
