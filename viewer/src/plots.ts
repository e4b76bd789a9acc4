// Plots over time, and kymographs of the midline.
import { Chart, type Curve, seriesCharts } from "./charts";
import { byId, element } from "./dom";
import { drawMidlineScale, Kymograph, midlineQuantities, midlineScale } from "./kymograph";
import { fewRuns, type PageData } from "./page_data";
import type { Run } from "./run";
import type { RunLooks } from "./run_looks";
import type { State } from "./state";
import { csvText } from "./table";
import { words } from "./text";

const widestBar = 340; // pixels

export class Plots {
  readonly charts: Chart[];
  private readonly kymographs: Kymograph[];
  private readonly withMidline: Run[];
  private readonly quantity = element("select", { id: "midline-quantity" });
  private readonly bar = element("canvas", { class: "bar", role: "img", "aria-label": "Colour scale of the midline" });

  constructor(runs: Run[], private readonly page: PageData, private readonly state: State, looks: RunLooks) {
    const grid = runs.length > fewRuns ? "charts many" : "charts";
    this.charts = seriesCharts(runs, looks).map((content) => new Chart(content, state));
    const logarithmic = element("input", { type: "checkbox", id: "logarithmic-time" });
    byId("plots").append(
      element("h2", {}, "Over time"),
      element("label", {}, logarithmic, " logarithmic time"),
      element("div", { class: grid }, ...this.charts.map((chart) => chart.box)),
    );
    this.withMidline = runs.filter((run) => run.depthWord !== "" && run.midline.rows.length > 0);
    this.kymographs = this.withMidline.map((run) => new Kymograph(run, this.withMidline, page, state, midlineQuantities[0]));
    if (this.withMidline.length > 0) this.showMidline(grid);
    logarithmic.addEventListener("change", () => {
      for (const plot of [...this.charts, ...this.kymographs]) plot.setLogarithmicTime(logarithmic.checked);
    });
  }

  rebuild(): void {
    for (const plot of [...this.charts, ...this.kymographs]) plot.rebuild();
    this.drawBar();
  }

  /** Table of the plotted series of the visible runs: one row per step and run, and one per snapshot for other plots. */
  table(more: Curve[]): string {
    const curves = [...this.charts.flatMap((chart) => chart.content.curves), ...more]
      .filter(({ run }) => this.state.now.shown.has(run.number));
    const columns = [...new Set(curves.map((curve) => curve.column))];
    const rows = new Map<string, string[]>();
    for (const { run, column, points } of curves)
      for (const { time, value } of points) {
        const key = `${run.number} ${time}`;
        if (!rows.has(key)) rows.set(key, [csvText(run.name), String(time), ...columns.map(() => "")]);
        rows.get(key)![2 + columns.indexOf(column)] = value === null ? "" : String(value);
      }
    const lines = [...rows.values()].map((row) => row.join(","));
    return [`run,time_s,${columns.join(",")}`, ...lines].join("\n") + "\n";
  }

  private showMidline(grid: string): void {
    for (const quantity of midlineQuantities) {
      const [name, unit] = words(quantity);
      this.quantity.append(element("option", { value: quantity }, unit === "" ? name : `${name}, ${unit}`));
    }
    this.quantity.addEventListener("change", () => {
      this.kymographs.forEach((plot) => plot.show(this.quantity.value));
      this.drawBar();
    });
    byId("midline").append(
      element("h2", {}, "Midline cells over reference position and time"),
      element("div", { class: "group" }, element("label", {}, "Colour ", this.quantity), this.bar),
      element("div", { class: grid }, ...this.kymographs.map((plot) => plot.box)),
    );
    this.drawBar();
  }

  private drawBar(): void {
    const room = byId("midline").clientWidth;
    if (this.withMidline.length > 0)
      drawMidlineScale(this.bar, Math.min(room || widestBar, widestBar), midlineScale(this.withMidline, this.quantity.value), this.page);
  }
}
