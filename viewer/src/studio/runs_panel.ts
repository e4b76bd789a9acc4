// Runs of the session as a list: which is shown, which is beside it, how each ended; and acts on selected cells.
import { byId, element } from "../dom";
import { time as timeText } from "../text";
import type { Connection, RunState, RunsState } from "./connection";

export interface Chosen {
  run: number; // 0: the draft at rest
  beside: number | null;
}

const endings: Record<string, string> = {
  equilibrium: "at equilibrium", end_time: "ended", failed: "failed", paused: "paused", running: "running",
};

function timeOf(run: RunState): string {
  const now = timeText(Number(run.time_s.toPrecision(4)));
  return run.running ? `${now} of ${timeText(run.end_s)}` : `${endings[run.status]}, ${now}`;
}

export class RunsPanel {
  private state: RunsState = { runs: [], jobs: {} };
  private shape = "";
  private readonly list = element("ul", { id: "run-list" });
  private readonly jobs = element("p", { id: "jobs", class: "note", role: "status" });

  constructor(
    holder: HTMLElement, private readonly chosen: Chosen, private readonly connection: Connection,
    private readonly token: string, private readonly show: (chosen: Partial<Chosen>) => void,
    private readonly tell: (problem: unknown) => void,
  ) {
    holder.append(element("h2", {}, "Runs"), this.list, this.jobs);
  }

  /** Show new states: times in place, so that a click during a run is not lost; all else by new elements. */
  take(state: RunsState): void {
    const shape = JSON.stringify([state.runs.map((run) => ({ ...run, time_s: 0, steps: 0 })), this.chosen]);
    this.state = state;
    this.jobs.textContent = Object.entries(state.jobs).map(([name, what]) => `${name}: ${what}`).join("\n");
    if (shape === this.shape)
      for (const run of state.runs)
        this.list.querySelector(`[data-run="${run.number}"] .note`)!.textContent = timeOf(run);
    else this.rebuild();
    this.shape = shape;
  }

  private rebuild(): void {
    const { state } = this;
    const focused = (document.activeElement as HTMLElement | null)?.id;
    this.list.replaceChildren(this.restItem(), ...state.runs.map((run) => this.item(run)));
    if (focused && this.list.querySelector(`#${CSS.escape(focused)}`)) byId(focused).focus();
  }

  refresh(): void {
    this.take(this.state);
  }

  run(number: number): RunState | undefined {
    return this.state.runs.find((run) => run.number === number);
  }

  private choice(number: number, text: string, note: string): HTMLElement {
    const radio = element("input", { type: "radio", name: "run", id: `show-${number}`, value: String(number) });
    radio.checked = this.chosen.run === number;
    radio.addEventListener("change", () => this.show({ run: number, beside: this.chosen.beside === number ? null
      : this.chosen.beside }));
    return element("label", {}, radio, element("span", { class: "run-title" }, text),
      element("span", { class: "note" }, note));
  }

  private restItem(): HTMLElement {
    return element("li", {}, this.choice(0, "At rest", "the scenario as edited"));
  }

  private item(run: RunState): HTMLElement {
    const depth = this.depth(run);
    const item = element("li", { "data-run": String(run.number), "data-status": run.status,
      style: `margin-left: ${Math.min(depth, 4) * 12}px` },
      this.choice(run.number, `${run.number} ${run.title}`, timeOf(run)));
    const more = element("div", { class: "group" });
    const beside = element("input", { type: "checkbox", id: `beside-${run.number}` });
    beside.checked = this.chosen.beside === run.number;
    beside.disabled = this.chosen.run === run.number;
    beside.addEventListener("change", () => this.show({ beside: beside.checked ? run.number : null }));
    more.append(element("label", {}, beside, " beside"), this.file(run.number, "scenario.toml", "TOML"),
      this.file(run.number, "run.py", "Python"),
      this.order(`results-${run.number}`, "Results…", () => this.results(run.number)),
      this.order(`remove-${run.number}`, "Remove", () => {
        if (this.chosen.run === run.number) this.show({ run: 0 });
        if (this.chosen.beside === run.number) this.show({ beside: null });
        this.connection.order("remove", { run: run.number }).catch(this.tell);
      }));
    item.append(more);
    if (run.failure !== "") item.append(element("p", { class: "fault" }, run.failure));
    for (const note of run.notes) item.append(element("p", { class: "note" }, note));
    return item;
  }

  private depth(run: RunState): number {
    const parent = run.parent === null ? undefined : this.run(run.parent);
    return parent ? 1 + this.depth(parent) : 0;
  }

  private order(id: string, text: string, act: () => void): HTMLElement {
    const button = element("button", { type: "button", class: "small", id }, text);
    button.addEventListener("click", act);
    return button;
  }

  private file(run: number, name: string, text: string): HTMLElement {
    return element("a", { href: `/take/${run}/${name}?token=${encodeURIComponent(this.token)}`, download: name,
      class: "small" }, text);
  }

  private results(run: number): void {
    const name = prompt("Directory for the results, in the start folder. The scenario is run again from rest.",
      `results-${run}`);
    if (name) this.connection.order("results", { run, name }).catch(this.tell);
  }
}
