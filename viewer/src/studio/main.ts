// The studio's page: a draft at rest, its runs, and acts on them, in the view that reports have.
import { Encoder } from "modern-gif";
import { type Chart, Chart as TimeChart, seriesCharts } from "../charts";
import { save } from "../controls";
import { byId, element } from "../dom";
import { EmbryoViews } from "../embryo_view";
import { LookControls } from "../look_controls";
import type { Field, PageData, View } from "../page_data";
import { RunLooks } from "../run_looks";
import { State } from "../state";
import { time as timeText } from "../text";
import { followTheme } from "../theme";
import { CandidatePanel, candidateRun } from "./candidate";
import { type Candidate, Connection, type DraftState, Problem, type RunsState, type Table } from "./connection";
import { Forms } from "./forms";
import { LiveRun, LiveTopology } from "./live_run";
import { type Frame, type Message, rangeOf, type Shape } from "./messages";
import { Painting, type Stroke } from "./painting";
import { type Chosen, RunsPanel } from "./runs_panel";
import { Start } from "./start";
import { TimeBar } from "./time_bar";
import { ToolsBar } from "./tools_bar";

const chartsApart = 700; // ms
const chartsShare = 0.1; // of the time, at most, is spent on plots
const picturesShare = 0.2; // of the time, at most, is spent on pictures of a run under way that is followed
const mostCellsWithEdges = 5000;
const mostShapes = 30; // kept, since each exchange of neighbours makes another; the server sends one again
const movieLength = 8000; // ms
const mostPictures = 80; // of a movie
const movieWidth = 1000; // pixels, at most
const difference: Field = {
  name: "difference", label: "distance from the run beside, µm", unit: "", on_nodes: true, scale: "from-zero",
  map: "from_zero", low: 0, high: 1,
};

class Studio {
  private readonly token = new URLSearchParams(location.search).get("token") ?? "";
  private readonly page: PageData;
  private readonly known: Field[];
  private readonly runs = [new LiveRun(0), new LiveRun(1)];
  private readonly state: State;
  private readonly looks: RunLooks;
  private readonly chosen: Chosen = { run: 0, beside: null };
  private readonly shapes = new Map<string, LiveTopology>();
  private readonly wants = [false, false]; // slots to be asked for at the next refresh
  private readonly frameShown = [-1, -1]; // index of the frame shown in each slot
  private framesAt = 0; // of a followed run, not before, ms
  private isRecording = false; // a movie, whose pictures are not drawn on the page, too
  private frameCount = 0; // of the run in the first slot
  private isShown: (() => void) | null = null; // called when every slot shows the frame it waits for
  private at: number | null = null;
  private views: EmbryoViews | null = null;
  private selection = new Set<number>();
  private charts: Chart[] = [];
  private chartsAt = 0; // not before, ms
  private chartRows = "";
  private readonly connection: Connection;
  private readonly forms: Forms;
  private readonly panel: RunsPanel;
  private readonly time: TimeBar;
  private tools!: ToolsBar;
  private readonly start: Start;
  private readonly candidate: CandidatePanel;
  private candidateState: Candidate | null = null;
  private address = location.hash; // names the run to look at first
  private failureRead = 0; // run whose failure was closed
  private hasNoPicture = false;
  private hasDraft = false;
  private lastField = "region";

  constructor() {
    const { fields, maps } = JSON.parse(byId("data").textContent!) as { fields: Field[]; maps: Record<string,
      string[]> };
    this.known = fields;
    this.page = {
      format: 1, made_by: "", fields: [...fields], maps: { ...maps }, views: [], view_cut_um: 0.01, varied: [],
      outcomes: null,
      runs: this.runs.map(({ data }) => data),
    };
    const none: View = { name: "", title: "", label: "", sight: [0, 1, 0], up: [0, 0, 1], cut_axis: null };
    this.state = new State({
      time: Infinity, playing: false, speed: 1, field: fields.find(({ name }) =>
        name === "region") ?? fields[0], view: none, cut: null,
      edges: true, shell: true, marks: false, picked: null, shown: new Set([0]), order: [0,
        1], pointed: null, colourBy: "",
    });
    this.looks = new RunLooks(this.runs, this.page, this.state);
    this.connection = new Connection(this.token, {
      schema: (tables) => this.forms.takeSchema(tables),
      draft: (draft) => this.takeDraft(draft),
      runs: (runs) => this.takeRuns(runs),
      shape: (message) => this.takeShape(message),
      frame: (message) => this.takeFrame(message),
      connected: (on) => this.showConnected(on),
      edited: () => this.chosen.run !== 0 && this.choose({ run: 0 }),
    });
    this.forms = new Forms(byId("forms"), this.connection);
    this.panel = new RunsPanel(byId("runs"), this.chosen, this.connection, this.token, (chosen) => this.choose(chosen),
      (problem) => this.tell(problem));
    this.time = new TimeBar(byId("timeline"), {
      run: (until) => this.go(until), pause: () => void this.order("pause", { run: this.chosen.run }), step: () =>
        void this.step(),
      lookAt: (time) => {
        this.at = time;
        this.ask();
      },
    });
    this.start = new Start(this.connection, this.token, () => this.choose({ run: candidateRun }));
    this.candidate = new CandidatePanel(byId("candidate"), this.connection, (problem) => this.tell(problem), () => {
      this.choose({ run: 0 });
      if (!this.hasDraft) void this.start.open();
    });
    this.listen();
    this.state.on(["field"], () => this.fieldChanged());
    const tick = (now: number) => {
      this.time.tick(now);
      if (!this.isRecording) this.draw();
      this.askNow();
      if (now > this.chartsAt) this.updateCharts();
      requestAnimationFrame(tick);
    };
    requestAnimationFrame(tick);
  }

  // Orders

  private async order(name: string, given: object = {}): Promise<Table | null> {
    try {
      const answer = await this.connection.order(name, given);
      this.tell(null);
      return answer;
    } catch (problem) {
      this.tell(problem);
      return null;
    }
  }

  private tell(problem: unknown): void {
    const notice = byId("problem");
    notice.hidden = problem === null;
    const text = problem instanceof Problem ? problem.message : problem === null ? "" : String(problem);
    notice.replaceChildren(text, closing(notice));
  }

  private async go(untilS: number | null): Promise<void> {
    if (this.chosen.run === candidateRun) return this.tell("This tissue is not used yet; choose Use this tissue.");
    if (this.chosen.run !== 0) return void this.order("go", { run: this.chosen.run, until_s: untilS });
    const made = await this.order("start", { until_s: untilS });
    if (made) this.choose({ run: made.run as number });
  }

  private async step(): Promise<void> {
    if (this.chosen.run === candidateRun) return this.go(null);
    if (this.chosen.run !== 0) return void this.order("step", { run: this.chosen.run });
    const made = await this.order("start", { until_s: 0 });
    if (!made) return;
    this.choose({ run: made.run as number });
    await this.order("step", { run: made.run });
  }

  private async act(kind: string, strength: number, name = ""): Promise<void> {
    const run = this.runs[0];
    const cells = [...this.selection].map((cell) => run.shown!.cellIds[cell]);
    const beside = this.chosen.run;
    const made = await this.order("act", { run: this.chosen.run, at_s: run.time, kind, cells, strength, name });
    if (made) this.choose({ run: made.run as number, beside });
  }

  // What the server sends

  private takeDraft(draft: DraftState): void {
    const title = String(draft.table?.title ?? "");
    byId("title").textContent = draft.table ? `${title || draft.base || "scenario"}` : "no scenario is open";
    (byId("undo") as HTMLButtonElement).disabled = !draft.undo;
    (byId("redo") as HTMLButtonElement).disabled = !draft.redo;
    byId("advice").replaceChildren(...[draft.problem, ...draft.advice].filter((line) => line !== "").map((line) =>
      element("p", {}, line)));
    byId("text").textContent = draft.text ?? "";
    byId("take-scenario").setAttribute("href", `/take/0/scenario.toml?token=${encodeURIComponent(this.token)}`);
    byId("take-script").setAttribute("href", `/take/0/run.py?token=${encodeURIComponent(this.token)}`);
    this.forms.show(draft);
    this.candidateState = draft.candidate;
    this.hasDraft = draft.table !== undefined;
    this.showCandidate();
    if (!draft.table && this.chosen.run === 0) void this.start.open();
    this.ask();
  }

  private takeRuns(runs: RunsState): void {
    this.panel.take(runs);
    const linked = Number(/^#run-(\d+)$/.exec(this.address)?.[1]);
    this.address = ""; // looked at once
    if (this.panel.run(linked)) this.choose({ run: linked });
    this.nameRuns();
    this.showTime();
  }

  private takeShape({ head, arrays }: Message<Shape>): void {
    const stem = /^(0|-1)\//.exec(head.shape)?.[0]; // of a tissue at rest, which no later frame shows again
    if (stem) for (const name of this.shapes.keys()) if (name.startsWith(stem)) this.shapes.delete(name);
    this.shapes.set(head.shape, new LiveTopology(head, arrays));
    const shown = this.runs.map((run) => run.shown?.shape.shape);
    for (const name of this.shapes.keys())
      if (this.shapes.size > mostShapes && name !== head.shape && !shown.includes(name)) this.shapes.delete(name);
  }

  private takeFrame(message: Message<Frame>): void {
    const { head } = message;
    const topology = this.shapes.get(head.shape);
    if (!topology || head.run !== this.wanted(head.slot)) return;
    const run = this.runs[head.slot];
    const before = run.shown;
    run.take(topology, message);
    this.frameShown[head.slot] = head.index;
    this.wants[head.slot] = true;
    if (before !== topology && head.slot === 0) this.takeTopology(before, topology);
    if (this.runs[0].shown) this.runs[0].shown.other = this.chosen.beside === null ? null : this.runs[1].shown;
    if (this.runs[1].shown) this.runs[1].shown.other = this.runs[0].shown;
    if (!this.views) this.makeViews();
    else if (before === null) this.views.remeasure();
    this.updateRange(head);
    this.markSelection();
    this.showTime();
    if (head.slot === 0 && this.chosen.beside !== null) this.wants[1] = true;
    document.body.dataset.frame = `${head.run}/${head.index}`;
    this.frameCount = head.slot === 0 ? head.count : this.frameCount;
    if (this.frameShown.every((index, slot) => index >= 0 || this.wanted(slot) === null)) this.isShown?.();
  }

  private takeTopology(before: LiveTopology | null, topology: LiveTopology): void {
    const { shape } = topology;
    this.tools?.showRegions(topology.regionNames);
    if (this.chosen.run === 0) this.forms.fit(shape, topology.regionSizes);
    const own = Object.entries(shape.own_fields).map(([name, range]): Field => (
      { name, label: name, unit: "", on_nodes: false, scale: "from-zero", map: "from_zero", ...rangeOf(range) }));
    const changing = shape.changing.map((name): Field => (
      { name, label: name, unit: "", on_nodes: false, scale: "from-zero", map: "from_zero", low: 0, high: 1 }));
    const names = this.page.fields.map(({ name }) => name).join();
    this.page.fields = [...this.known, ...changing, ...own, difference];
    if (before && names !== this.page.fields.map(({ name }) => name).join()) this.showControls();
    this.keepSelection(before, topology);
    if (before && hasSameSize(before, topology)) return; // at most, cells have divided
    this.page.views = Object.entries(shape.views).map(([name, view]) => ({ name, title: name, label: "", ...view }));
    this.page.view_cut_um = 0.01;
    this.state.set({ view: this.page.views[0], cut: null, edges: topology.cells <= mostCellsWithEdges });
    this.views?.remeasure();
    this.showControls();
  }

  // Cells are selected by index, which divisions and extrusions change; another tissue has other cells.
  private keepSelection(before: LiveTopology | null, topology: LiveTopology): void {
    if (this.selection.size === 0 || !before) return;
    const isSame = hasSameSize(before, topology) && (this.chosen.run > 0 || before.cells === topology.cells);
    const cellOf = new Map(Array.from(topology.cellIds, (id, cell): [number, number] => [id, cell]));
    const kept = [...this.selection].map((cell) => cellOf.get(before.cellIds[cell])).filter((cell) => cell !== undefined);
    this.select(new Set(isSame ? kept : []));
  }

  private showControls(): void {
    if (!this.page.fields.some(({ name }) => name === this.state.now.field.name))
      this.state.set({ field: this.page.fields.find(({ name }) => name === "region")! });
    byId("controls").replaceChildren(...new LookControls([this.runs[0]], this.page, this.state, () =>
      this.views?.sight() ?? [1, 1, 1]).all());
  }

  private makeViews(): void {
    if (this.hasNoPicture) return;
    try {
      this.views = new EmbryoViews(this.runs, this.page, this.state, this.looks, byId("canvases"),
        byId("legend") as HTMLCanvasElement);
    } catch (error) {
      console.info("no picture:", error);
      this.hasNoPicture = true;
      this.tell("The tissue cannot be drawn, since this browser has no WebGL. Forms, runs and plots work.");
      return;
    }
    const paintings = this.runs.map((run) => new Painting(this.views!.viewOf(run),
      (stroke) => this.takeStroke(stroke)));
    this.tools = new ToolsBar(byId("tools"), byId("acts-holder"), paintings, {
      clear: () => this.select(new Set()),
      paintInto: (region) => {
        this.select(new Set(region === "" ? [] : this.runs[0].shown!.membersOf(region)));
        if (this.chosen.run > 0) this.tools.target.value = ""; // strokes change the selection only
      },
      makeRegion: (name) => this.makeRegion(name),
      act: (kind, strength) => void this.act(kind, strength),
      end: (name) => void this.act("end", 0, name),
    });
    this.tools.showRegions(this.runs[0].shown!.regionNames);
    void this.views.makeReady();
    this.views.remeasure();
    this.views.draw();
    performance.mark("first-picture");
    document.body.dataset.ready = "true";
  }

  private showConnected(on: boolean): void {
    byId("connection").hidden = on;
    if (!on) return;
    this.shapes.clear();
    this.frameShown.fill(-1);
    this.runs.forEach((run) => run.forgetRows());
    this.ask();
  }

  // What is looked at

  private choose(chosen: Partial<Chosen>): void {
    const before = { ...this.chosen };
    Object.assign(this.chosen, chosen);
    if (this.chosen.beside === this.chosen.run || this.chosen.run <= 0) this.chosen.beside = null;
    if (before.run !== this.chosen.run) {
      this.at = null;
      this.time.follow();
      this.runs[0].forgetRows();
      this.frameShown[0] = -1;
    }
    if (before.beside !== this.chosen.beside) {
      this.runs[1].forgetRows();
      this.runs[1].shown = null;
      this.frameShown[1] = -1;
    }
    // A region's cells were selected to be painted; in a run, only cells to act on are.
    if (this.chosen.run > 0 && this.tools?.target.value) {
      this.tools.target.value = "";
      this.select(new Set());
    }
    if (before.run <= 0 && this.chosen.run > 0 && this.state.now.field.name === "region") this.colour("area-ratio");
    if (this.chosen.run <= 0 && before.run > 0) this.colour("region");
    history.replaceState(null, "", location.pathname + location.search +
      (this.chosen.run > 0 ? `#run-${this.chosen.run}` : ""));
    this.showCandidate();
    this.state.set({ shown: new Set(this.chosen.beside === null ? [0] : [0, 1]) });
    this.nameRuns();
    this.panel.refresh();
    this.showTime();
    this.ask();
  }

  private showCandidate(): void {
    const isChosen = this.chosen.run === candidateRun;
    this.candidate.show(this.candidateState, isChosen);
    document.body.classList.toggle("looking", isChosen);
    byId("canvases").classList.toggle("unread", isChosen && !this.candidateState?.cells);
  }

  private nameRuns(): void {
    for (const [slot, run] of this.runs.entries()) {
      const wanted = this.wanted(slot) ?? 0;
      const label = this.panel.run(wanted)?.title ?? (wanted === candidateRun ? "Not used yet" : "At rest");
      if (label === run.label) continue;
      run.label = label;
      this.views?.refresh();
    }
  }

  private wanted(slot: number): number | null {
    return slot === 0 ? this.chosen.run : this.chosen.beside;
  }

  private ask(): void {
    this.wants.fill(true);
  }

  private draw(): void {
    const begun = performance.now();
    this.views?.draw();
    const now = performance.now();
    this.framesAt = Math.max(this.framesAt, now + (now - begun) * (1 / picturesShare - 1));
  }

  // One request a slot and refresh of the screen, so that frames come no faster than they are drawn; of a run under way,
  // they leave most of the processor to the solver where drawing is slow.
  private askNow(): void {
    if (this.state.now.playing && performance.now() < this.framesAt) return;
    for (const slot of [0, 1]) {
      const run = this.wanted(slot);
      if (!this.wants[slot] || run === null) continue;
      this.wants[slot] = false;
      const at = slot === 1 ? (this.runs[0].shown ? this.runs[0].time : null) : this.at;
      this.connection.look({
        slot, run, field: this.state.now.field.name, at_s: at, known: this.frameShown[slot],
        rows: this.runs[slot].series.rows.length, shapes: [...this.shapes.keys()],
      });
    }
  }

  private colour(name: string): void {
    const select = document.getElementById("field") as HTMLSelectElement | null;
    if (select) select.value = name;
    this.state.set({ field: this.page.fields.find((field) => field.name === name)! });
  }

  private fieldChanged(): void {
    if (this.state.now.field.name === this.lastField) return;
    this.lastField = this.state.now.field.name;
    this.frameShown.fill(-1);
    this.ask();
  }

  private updateRange(head: Frame): void {
    const field = this.state.now.field;
    let { low, high } = field;
    if (field.name === difference.name) high = niceAbove(this.runs[0].shown?.largestDifference ?? 1);
    else if (head.field === field.name && head.range && field.scale !== "steps") ({ low, high } = rangeOf(head.range));
    // A new object, so that everything that shows the field is drawn again.
    this.state.set({ field: { ...field, low, high } });
  }

  // Selection and painting

  private takeStroke(stroke: Stroke): void {
    const cells = new Set(stroke.cells);
    if (this.tools.mirror.checked) for (const cell of stroke.cells) cells.add(this.runs[0].shown!.mirrorOf(cell));
    const next = new Set(this.selection);
    for (const cell of cells)
      if (stroke.erases) next.delete(cell);
      else next.add(cell);
    this.select(next);
    if (stroke.done && this.tools.target.value !== "") void this.paint(this.tools.target.value);
  }

  private select(cells: Set<number>): void {
    this.selection = cells;
    this.tools.showCount(cells.size);
    this.markSelection();
    this.views!.refresh();
  }

  private markSelection(): void {
    const marked = [...this.selection];
    for (const run of this.runs) run.marked = run.shown && run.shown.cells === this.runs[0].shown?.cells ? marked : [];
  }

  private async makeRegion(name: string): Promise<boolean> {
    if (this.chosen.run !== 0)
      this.tell("Regions belong to the tissue at rest; choose At rest under Runs, or act on the selected cells.");
    else if (this.selection.size === 0) this.tell("No cells are selected; drag over some with the brush or the lasso.");
    else if (name === "") this.tell("The region has no name; type one beside Make region.");
    else if (await this.paint(name)) {
      this.forms.addTo(name);
      return true;
    }
    return false;
  }

  private async paint(region: string): Promise<boolean> {
    const begun = performance.now();
    const done = await this.order("paint", { region, ids: [...this.selection] });
    if (!done) return false;
    const run = this.runs[0];
    run.shown!.setRegion(region, this.selection);
    run.data.coloured_regions = run.shown!.colouredRegions;
    this.views!.refresh();
    document.body.dataset.strokeMs = String(Math.round(performance.now() - begun));
    if (this.tools.target.value === region) return true;
    this.tools.showRegions(run.shown!.regionNames);
    this.tools.target.value = region;
    return true;
  }

  // The rest of the page

  private showTime(): void {
    const run = this.panel.run(this.chosen.run);
    const shown = this.chosen.run <= 0 ? 0 : this.runs[0].time;
    this.time.show(run, shown);
    this.state.set({ playing: run?.running === true && this.at === null });
    this.tools?.showActs(run ? timeText(Number(shown.toPrecision(4))) : null, run?.lasting ?? []);
    const failed = byId("failure");
    failed.hidden = run?.status !== "failed" || run.number === this.failureRead;
    if (failed.hidden || !run) return;
    failed.replaceChildren(element("p", {}, element("strong", {},
      `Run ${run.number} failed at ${timeText(run.time_s)}: `), run.failure),
      closing(failed, () => (this.failureRead = run.number)));
    if (run.failed_cell === null) return;
    const cell = run.failed_cell;
    const show = element("button", { type: "button", "data-cell": String(cell) }, `Show cell ${cell}`);
    show.addEventListener("click", () => void this.views?.lookAtCell(this.runs[0], cell));
    failed.append(show);
  }

  private updateCharts(): void {
    const runs = this.chosen.beside === null ? [this.runs[0]] : this.runs;
    const rows = runs.map(({ series, label }) => `${label} ${series.rows.length}`).join();
    if (rows === this.chartRows || document.hidden) return;
    this.chartRows = rows;
    const begun = performance.now();
    const contents = this.chosen.run <= 0 ? [] : seriesCharts(runs.filter(({ series }) => series.rows.length > 1),
      this.looks);
    if (contents.length !== this.charts.length || !contents.every((content, i) => this.charts[i].take(content))) {
      for (const chart of this.charts) chart.destroy();
      this.charts = contents.map((content) => new TimeChart(content, this.state));
      byId("plots").replaceChildren(...this.charts.map(({ box }) => box));
    }
    const now = performance.now();
    this.chartsAt = now + Math.max(chartsApart, (now - begun) / chartsShare);
  }

  private listen(): void {
    const on = (id: string, act: () => void) => byId(id).addEventListener("click", act);
    on("open", () => void this.start.open());
    on("undo", () => void this.order("undo"));
    on("redo", () => void this.order("redo"));
    on("save-picture", async () => this.views && save("plica.png", await this.views.picture()));
    on("save-movie", () => void this.saveMovie());
    document.addEventListener("keydown", (event) => this.key(event));
    followTheme(() => {
      this.views?.refresh();
      for (const chart of this.charts) chart.rebuild();
    });
  }

  /** Save a GIF of the shown run as it is replayed, with time, scale and legend. */
  private async saveMovie(): Promise<void> {
    const run = this.panel.run(this.chosen.run);
    if (!run || !this.views) return this.tell("A movie shows a run; choose one under Runs.");
    const button = byId("save-movie") as HTMLButtonElement;
    button.disabled = this.isRecording = true;
    await this.shownAt(null);
    const { width, height } = await this.views.drawing(1);
    const scale = Math.min(movieWidth / width, 1);
    const movie = new Encoder({ width: Math.round(scale * width), height: Math.round(scale * height) });
    const last = Math.max(Math.min(this.frameCount, mostPictures) - 1, 1);
    const shownFor = Math.max(10 * Math.round(movieLength / last / 10), 40);
    for (let i = 0; i <= last && this.chosen.run === run.number; ++i) {
      await this.shownAt((i / last) * run.time_s);
      await movie.encode({ data: await this.views.drawing(1), delay: i === last ? 2000 : shownFor });
      button.textContent = `Movie ${Math.round((100 * i) / last)} %`;
    }
    save("plica.gif", await movie.flush("blob"));
    this.at = null;
    this.ask();
    button.textContent = "Movie";
    button.disabled = this.isRecording = false;
  }

  /** Look at a time, null: the newest frame, and wait until it is shown in every slot. */
  private shownAt(time: number | null): Promise<void> {
    this.at = time;
    this.frameShown.fill(-1);
    this.wants[0] = true; // the slot beside it follows
    return new Promise((resolve) => (this.isShown = resolve));
  }

  private key(event: KeyboardEvent): void {
    const target = event.target as HTMLElement;
    if ((event.ctrlKey || event.metaKey) && event.key.toLowerCase() === "z" &&
      !/^(INPUT|TEXTAREA)$/.test(target.tagName)) {
      event.preventDefault();
      return void this.order(event.shiftKey ? "redo" : "undo");
    }
    const isField = /^(INPUT|SELECT|TEXTAREA)$/.test(target.tagName) && (target as HTMLInputElement).type !== "radio";
    if (event.ctrlKey || event.metaKey || event.altKey || isField || document.querySelector("dialog[open]")) return;
    if (event.key === " " && /^(BUTTON|SUMMARY)$/.test(target.tagName)) return;
    if (this.time.key(event) || this.tools?.key(event.key)) event.preventDefault();
    const view = this.page.views[Number(event.key) - 1];
    if (view) byId(`view-${view.name}`).click();
  }
}

function hasSameSize(a: LiveTopology, b: LiveTopology): boolean {
  const [ends, others] = [a, b].map(({ shape }) => [...shape.box.low, ...shape.box.high]);
  const size = Math.max(...ends) - Math.min(...ends);
  return ends.every((end, i) => Math.abs(end - others[i]) < 0.05 * size);
}

function closing(notice: HTMLElement, closed = () => {}): HTMLElement {
  const close = element("button", { type: "button", class: "close", "aria-label": "Close" }, "×");
  close.addEventListener("click", () => {
    notice.hidden = true;
    closed();
  });
  return close;
}

function niceAbove(value: number): number {
  if (!(value > 0)) return 1;
  const power = 10 ** Math.floor(Math.log10(value));
  return [1, 2, 5, 10].map((factor) => factor * power).find((candidate) => candidate >= value)!;
}

new Studio();
