// Controls: view, colour, cut, visible parts; time and playback; saved pictures and tables; keys.
import { download, element } from "./dom";
import type { PageData } from "./page_data";
import type { Run } from "./run";
import type { Cut, State } from "./state";
import { time as timeText } from "./text";

const axes = ["x", "y", "z"];

export interface Actions {
  savePicture: (() => void) | null;
  saveTable: () => void;
  sight: () => number[];
}

/** Sorted distinct times of the snapshots of all runs. */
export function frameTimes(runs: Run[]): number[] {
  const times = new Set(runs.flatMap((run) => run.frames.map((frame) => frame.time)));
  if (times.size === 0) for (const run of runs) for (const row of run.series.rows) times.add(row[0]!);
  return [...times].sort((a, b) => a - b);
}

export class Controls {
  private readonly times: number[];
  private readonly slider: HTMLInputElement;
  private readonly cutAt = element("input", { type: "range", step: "0.5", id: "cut-at", "aria-label": "Position of the cut, µm" });
  private readonly cutText = element("output", { id: "cut-text" });

  constructor(
    holder: HTMLElement, timeline: HTMLElement, private readonly runs: Run[], private readonly page: PageData,
    private readonly state: State, private readonly actions: Actions,
  ) {
    this.times = frameTimes(runs);
    this.slider = element("input", {
      type: "range", id: "time", min: "0", max: String(Math.max(this.times.length - 1, 0)), step: "1", "aria-label": "Time",
    });
    if (runs.some((run) => run.hasFrames)) {
      holder.append(this.viewButtons(), this.fieldChoice(), this.cutChoice(), this.switches());
      holder.append(this.button("save-picture", "Save PNG", () => actions.savePicture?.()));
    }
    timeline.append(...this.timeControls());
    timeline.append(this.button("save-table", "Save CSV", () => actions.saveTable()));
    document.addEventListener("keydown", (event) => this.key(event));
  }

  private button(id: string, text: string, act: () => void): HTMLButtonElement {
    const button = element("button", { type: "button", id }, text);
    button.addEventListener("click", act);
    return button;
  }

  private viewButtons(): HTMLElement {
    const group = element("div", { class: "group", role: "group", "aria-label": "View" });
    for (const view of this.page.views) {
      const button = this.button(`view-${view.name}`, view.title.replace("-", " "), () => this.lookFrom(view.name));
      button.title = view.label;
      group.append(button);
    }
    return group;
  }

  private lookFrom(name: string): void {
    const view = this.page.views.find((candidate) => candidate.name === name)!;
    const cut: Cut | null =
      view.cut_axis === null ? null
        : { axis: view.cut_axis, at: this.page.view_cut_um, keep: view.sight[view.cut_axis] > 0 ? 1 : -1 };
    this.state.set({ view: { ...view }, cut });
  }

  private fieldChoice(): HTMLElement {
    const select = element("select", { id: "field" });
    for (const field of this.page.fields) select.append(element("option", { value: field.name }, field.label));
    select.value = this.state.now.field.name;
    select.addEventListener("change", () =>
      this.state.set({ field: this.page.fields.find((field) => field.name === select.value)! }));
    return element("label", {}, "Colour ", select);
  }

  private cutChoice(): HTMLElement {
    const select = element("select", { id: "cut" }, element("option", { value: "" }, "none"));
    axes.forEach((axis) => select.append(element("option", { value: axis }, `across ${axis}`)));
    select.addEventListener("change", () => {
      const axis = axes.indexOf(select.value);
      const keep = this.actions.sight()[axis] >= 0 ? 1 : -1;
      this.state.set({ cut: axis < 0 ? null : { axis, at: this.page.view_cut_um, keep } });
    });
    this.cutAt.addEventListener("input", () => {
      const { cut } = this.state.now;
      if (cut) this.state.set({ cut: { ...cut, at: Number(this.cutAt.value) } });
    });
    const showCut = () => {
      const { cut } = this.state.now;
      select.value = cut ? axes[cut.axis] : "";
      this.cutAt.hidden = this.cutText.hidden = !cut;
      if (!cut) return;
      const ends = this.runs.map(({ data }) => [data.box.low[cut.axis], data.box.high[cut.axis]]);
      this.cutAt.min = String(Math.floor(Math.min(...ends.map(([low]) => low))));
      this.cutAt.max = String(Math.ceil(Math.max(...ends.map(([, high]) => high))));
      this.cutAt.value = String(cut.at);
      this.cutText.textContent = `${axes[cut.axis]} = ${Math.round(cut.at)} µm`;
    };
    this.state.on(["cut"], showCut);
    showCut();
    return element("label", { class: "group" }, "Cut ", select, this.cutAt, this.cutText);
  }

  private switches(): HTMLElement {
    const group = element("div", { class: "group" });
    const add = (key: "edges" | "shell" | "marks", text: string) => {
      const box = element("input", { type: "checkbox", id: key });
      box.checked = this.state.now[key];
      box.addEventListener("change", () => this.state.set({ [key]: box.checked }));
      group.append(element("label", {}, box, ` ${text}`));
    };
    add("edges", "cell edges");
    if (this.runs.some((run) => run.data.shell)) add("shell", "vitelline membrane");
    add("marks", "axes");
    return group;
  }

  private timeControls(): HTMLElement[] {
    const play = this.button("play", "Play", () => this.togglePlay());
    const text = element("output", { id: "time-text", for: "time" });
    const speed = element("select", { id: "speed", "aria-label": "Speed" });
    const usual = this.state.now.speed;
    for (const factor of [0.1, 0.25, 0.5, 1, 2, 4])
      speed.append(element("option", { value: String(factor * usual) }, `${timeText(factor * usual)} a second`));
    speed.value = String(usual);
    speed.addEventListener("change", () => this.state.set({ speed: Number(speed.value) }));
    this.slider.addEventListener("input", () =>
      this.state.set({ time: this.times[Number(this.slider.value)], playing: false }));
    const show = () => {
      const { time, playing } = this.state.now;
      play.textContent = playing ? "Pause" : "Play";
      text.textContent = timeText(Number(time.toPrecision(6)));
      this.slider.value = String(this.nearest(time));
      this.slider.setAttribute("aria-valuetext", text.textContent);
    };
    this.state.on(["time", "playing"], show);
    show();
    return [play, this.slider, text, speed];
  }

  private togglePlay(): void {
    const { playing, time } = this.state.now;
    const last = this.times.at(-1) ?? 0;
    if (playing) this.state.set({ playing: false, time: this.times[this.nearest(time)] });
    else this.state.set({ playing: true, time: time >= last ? this.times[0] : time });
  }

  private nearest(time: number): number {
    let best = 0;
    this.times.forEach((candidate, i) => {
      if (Math.abs(candidate - time) <= Math.abs(this.times[best] - time)) best = i;
    });
    return best;
  }

  private goTo(frame: number): void {
    const index = Math.min(Math.max(frame, 0), this.times.length - 1);
    this.state.set({ time: this.times[index], playing: false });
  }

  private key(event: KeyboardEvent): void {
    const target = event.target as HTMLElement;
    if (event.ctrlKey || event.metaKey || event.altKey || /^(INPUT|SELECT|TEXTAREA)$/.test(target.tagName)) return;
    const here = this.nearest(this.state.now.time);
    const view = this.page.views[Number(event.key) - 1];
    if (event.key === " " && target.tagName !== "BUTTON" && target.tagName !== "SUMMARY") this.togglePlay();
    else if (event.key === ",") this.goTo(here - 1);
    else if (event.key === ".") this.goTo(here + 1);
    else if (event.key === "Home") this.goTo(0);
    else if (event.key === "End") this.goTo(this.times.length - 1);
    else if (view && this.runs.some((run) => run.hasFrames)) this.lookFrom(view.name);
    else return;
    event.preventDefault();
  }
}

export function save(name: string, content: Blob): void {
  download(name.replace(/[^\w.-]+/g, "_").slice(0, 80), content);
}
