// Time of the shown run: start, pause, one step, to a time; a slider back to any frame; replay.
import { element } from "../dom";
import { button } from "../look_controls";
import { time as timeText } from "../text";
import type { RunState } from "./connection";

export interface TimeActions {
  run(untilS: number | null): void;
  pause(): void;
  step(): void;
  /** Look at a time; null: at the newest frame. */
  lookAt(timeS: number | null): void;
}

const replayS = 8; // seconds that a replay takes

export class TimeBar {
  private readonly go = button("go", "Run", () => this.toggle());
  private readonly stepButton = button("step", "Step", () => this.actions.step());
  private readonly slider = element("input", { type: "range", id: "time", min: "0", max: "1", step: "any", value: "0",
    "aria-label": "Time" });
  private readonly text = element("output", { id: "time-text", for: "time" });
  private readonly until = element("input", { type: "number", id: "until", min: "0", step: "any",
    "aria-label": "Run to, minutes", class: "strength" });
  private readonly replay = button("replay", "Replay", () => this.play());
  private state: RunState | undefined;
  private at: number | null = null;
  private playingSince: number | null = null;

  constructor(holder: HTMLElement, private readonly actions: TimeActions) {
    const to = button("go-to", "Run to", () =>
      this.actions.run(this.until.value === "" ? null : 60 * Number(this.until.value)));
    holder.append(this.go, this.stepButton, to, this.until, element("span", {}, "min"), this.slider, this.text,
      this.replay);
    this.slider.addEventListener("input", () => {
      this.playingSince = null;
      const value = Number(this.slider.value);
      this.look(value >= Number(this.slider.max) ? null : value);
    });
  }

  private look(time: number | null): void {
    this.at = time;
    this.actions.lookAt(time);
  }

  /** Follow another run, or its newest frame. */
  follow(): void {
    this.at = this.playingSince = null;
  }

  show(state: RunState | undefined, shownS: number): void {
    this.state = state;
    this.go.textContent = state?.running ? "Pause" : "Run";
    const over = state !== undefined && !["running", "paused"].includes(state.status);
    this.go.disabled = this.stepButton.disabled = over;
    this.slider.max = String(state?.time_s ?? 0);
    this.slider.disabled = this.replay.disabled = !state;
    if (document.activeElement !== this.slider || this.at === null)
      this.slider.value = String(this.at ?? state?.time_s ?? 0);
    this.text.textContent = timeText(Number(shownS.toPrecision(4)));
    this.slider.setAttribute("aria-valuetext", this.text.textContent);
  }

  toggle(): void {
    if (this.state?.running) this.actions.pause();
    else if (!this.go.disabled) this.actions.run(null);
  }

  key(event: KeyboardEvent): boolean {
    const here = this.at ?? this.state?.time_s ?? 0;
    const apart = (this.state?.time_s ?? 0) / 60;
    if (event.key === " ") this.toggle();
    else if (event.key === "s" && !this.stepButton.disabled) this.actions.step();
    else if (event.key === "Home") this.look(0);
    else if (event.key === "End") this.look(null);
    else if (event.key === ",") this.look(Math.max(here - apart, 0));
    else if (event.key === ".") this.look(here + apart >= (this.state?.time_s ?? 0) ? null : here + apart);
    else return false;
    return true;
  }

  play(): void {
    this.playingSince = this.playingSince === null ? performance.now() : null;
  }

  /** Called before each refresh of the screen. */
  tick(now: number): void {
    if (this.playingSince === null || !this.state) return;
    const part = (now - this.playingSince) / 1000 / replayS;
    if (part >= 1) this.playingSince = null;
    this.look(part >= 1 ? null : part * this.state.time_s);
  }
}
