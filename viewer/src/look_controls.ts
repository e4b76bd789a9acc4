// Controls of the look of a picture: view, colour, cut, visible parts. Shared by the report and the studio.
import { element } from "./dom";
import type { PageData } from "./page_data";
import type { Run } from "./run";
import type { Cut, State } from "./state";

const axes = ["x", "y", "z"];

export function button(id: string, text: string, act: () => void): HTMLButtonElement {
  const made = element("button", { type: "button", id }, text);
  made.addEventListener("click", act);
  return made;
}

export class LookControls {
  private readonly cutAt = element("input", { type: "range", step: "0.5", id: "cut-at", "aria-label": "Position of the cut, µm" });
  private readonly cutText = element("output", { id: "cut-text" });

  /** `sight`: the present viewing direction. */
  constructor(
    private readonly runs: Run[], private readonly page: PageData, private readonly state: State,
    private readonly sight: () => number[],
  ) {}

  all(): HTMLElement[] {
    return [this.viewButtons(), this.fieldChoice(), this.cutChoice(), this.switches()];
  }

  lookFrom(name: string): void {
    const view = this.page.views.find((candidate) => candidate.name === name)!;
    const cut: Cut | null =
      view.cut_axis === null ? null
        : { axis: view.cut_axis, at: this.page.view_cut_um, keep: view.sight[view.cut_axis] > 0 ? 1 : -1 };
    this.state.set({ view: { ...view }, cut });
  }

  private viewButtons(): HTMLElement {
    const group = element("div", { class: "group", role: "group", "aria-label": "View" });
    for (const view of this.page.views) {
      const made = button(`view-${view.name}`, view.title.replace("-", " "), () => this.lookFrom(view.name));
      made.title = view.label;
      group.append(made);
    }
    return group;
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
      const keep = this.sight()[axis] >= 0 ? 1 : -1;
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
}
