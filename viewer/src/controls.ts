// Controls of the report: its look, time and playback, saved pictures and tables, keys.
import { download, element } from "./dom";
import { LookControls, button } from "./look_controls";
import type { PageData } from "./page_data";
import type { Run } from "./run";
import type { State } from "./state";
import { time as timeText } from "./text";

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
  private readonly looks: LookControls;

  constructor(
    holder: HTMLElement, timeline: HTMLElement, private readonly runs: Run[], private readonly page: PageData,
    private readonly state: State, actions: Actions,
  ) {
    this.times = frameTimes(runs);
    this.looks = new LookControls(runs, page, state, () => actions.sight());
    this.slider = element("input", {
      type: "range", id: "time", min: "0", max: String(Math.max(this.times.length - 1, 0)), step: "1", "aria-label": "Time",
    });
    if (runs.some((run) => run.hasFrames)) {
      holder.append(...this.looks.all());
      holder.append(button("save-picture", "Save PNG", () => actions.savePicture?.()));
    }
    timeline.append(...this.timeControls());
    timeline.append(button("save-table", "Save CSV", () => actions.saveTable()));
    document.addEventListener("keydown", (event) => this.key(event));
  }

  private timeControls(): HTMLElement[] {
    const play = button("play", "Play", () => this.togglePlay());
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
    else if (view && this.runs.some((run) => run.hasFrames)) this.looks.lookFrom(view.name);
    else return;
    event.preventDefault();
  }
}

export function save(name: string, content: Blob): void {
  download(name.replace(/[^\w.-]+/g, "_").slice(0, 80), content);
}
