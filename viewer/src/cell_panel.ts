// Panel of the picked cell: values at the time of the page, and their history.
import { Chart, type Curve } from "./charts";
import { lineColours } from "./colour";
import { element } from "./dom";
import { nameOfStep, type PageData, titleOf } from "./page_data";
import type { Run } from "./run";
import type { State } from "./state";
import { number, time as timeText } from "./text";

export class CellPanel {
  private chart: Chart | null = null;
  private chartOf = "";
  private readonly content = element("div");
  private readonly input = element("input", { type: "number", min: "0", step: "1", id: "cell-id" });

  constructor(
    private readonly holder: HTMLElement, private readonly runs: Run[], private readonly page: PageData,
    private readonly state: State,
  ) {
    const form = element(
      "form", {}, element("label", { for: "cell-id" }, "Cell "), this.input, element("button", { type: "submit" }, "Pick"),
    );
    form.addEventListener("submit", (event) => {
      event.preventDefault();
      const run = state.now.picked?.run ?? this.runs.find((candidate) => candidate.hasFrames)?.number ?? 0;
      void this.pick(run, Number(this.input.value));
    });
    this.holder.append(element("h2", {}, "Picked cell"), form, this.content);
    state.on(["picked", "time", "field", "shown"], () => this.update());
    this.update();
  }

  /** Curves of the picked cell, for saved tables. */
  get curves(): Curve[] {
    return this.chart?.content.curves ?? [];
  }

  rebuild(): void {
    this.chart?.rebuild();
  }

  private async pick(run: number, id: number): Promise<void> {
    await this.runs[run].load();
    const known = this.runs[run].topologies.some((topology) => topology.cellWith(id) >= 0);
    this.input.setCustomValidity(known ? "" : "no cell has this number");
    this.input.reportValidity();
    if (known) this.state.set({ picked: { run, id } });
  }

  private update(): void {
    const { picked, time, shown } = this.state.now;
    if (!picked || !shown.has(picked.run)) {
      this.content.replaceChildren(element("p", { class: "note" }, "Click a cell to see its values here."));
      this.chart?.destroy();
      this.chart = null;
      this.chartOf = "";
      return;
    }
    const run = this.runs[picked.run];
    const { topology, moment, time: frameTime } = run.frames[run.frameAt(time)];
    const cell = run.ancestorAt(picked.id, topology);
    const list = element("dl");
    const row = (name: string, value: string, data: Record<string, string> = {}) =>
      list.append(element("dt", {}, name), element("dd", data, value));
    if (this.runs.length > 1) row("run", run.name);
    if (cell >= 0) {
      const id = topology.cellIds[cell];
      row("cell", String(id), { "data-value": "cell_id" });
      if (id !== picked.id) row("", `becomes cell ${picked.id} later`);
      const mother = topology.motherOf(cell);
      if (mother !== null) row("mother", String(mother));
      row("regions", topology.regionsOf(cell).join(", ") || "–");
      row("snapshot at", timeText(frameTime));
      for (const field of this.page.fields) {
        const value = topology.valueOfCell(field, moment, cell);
        row(titleOf(field) + (field.on_nodes ? " (mean of its nodes)" : ""),
          nameOfStep(field, Math.round(value), this.page) ?? number(value), { "data-value": field.name });
      }
    } else row("cell", `${picked.id}, divided`);
    const daughters = run.daughtersOf(picked.id);
    const buttons = daughters.map((id) => {
      const button = element("button", { type: "button" }, `daughter ${id}`);
      button.addEventListener("click", () => void this.pick(picked.run, id));
      return button;
    });
    this.showHistory(run, picked.id);
    this.content.replaceChildren(list, ...buttons, this.chart!.box);
  }

  private showHistory(run: Run, id: number): void {
    const { field } = this.state.now;
    const wanted = `${run.number} ${id} ${field.name}`;
    if (this.chart && this.chartOf === wanted) return;
    const curve: Curve = {
      name: `cell ${id}`, column: `cell_${id}.${field.name}`, run, points: run.history(field, id),
      look: () => ({ colour: lineColours[3], dash: [] }),
    };
    this.chart?.destroy();
    this.chart = new Chart({ title: field.label, unit: field.unit, curves: [curve] }, this.state);
    this.chartOf = wanted;
  }
}
