// Tools over the picture: brush, lasso, what they paint, and the acts on the cells that they selected.
import { element } from "../dom";
import { button } from "../look_controls";
import type { Painting, Tool } from "./painting";

export interface ToolActions {
  clear(): void;
  paintInto(region: string): void; // "": the selection
  makeRegion(name: string): Promise<boolean>; // whether it was made
  act(kind: string, strength: number): void;
  end(name: string): void;
}

const tools: [Tool, string, string][] = [["rotate", "Rotate", "v"], ["brush", "Brush", "b"], ["lasso", "Lasso", "l"]];

export class ToolsBar {
  readonly target = element("select", { id: "paint-into", "aria-label": "What is painted" });
  readonly mirror = element("input", { type: "checkbox", id: "mirror" });
  private readonly purpose = element("span", {}, "paint ");
  private readonly names = element("datalist", { id: "region-names" });
  private readonly count = element("output", { id: "selected-count" });
  private readonly erase = element("input", { type: "checkbox", id: "erase" });
  private readonly size = element("input", { type: "range", id: "brush-size", min: "4", max: "160", value: "24",
    "aria-label": "Size of the brush, pixels" });
  private readonly newName = element("input", { type: "text", id: "new-region", placeholder: "new region",
    "aria-label": "Name of the new region", size: "10" });
  private readonly acts = element("div", { id: "acts", class: "group" });
  private readonly lasting = element("span", { class: "group" });
  private readonly when = element("span", { id: "act-time", class: "note" });

  constructor(private readonly holder: HTMLElement, acts: HTMLElement, private readonly paintings: Painting[],
    private readonly actions: ToolActions) {
    const choice = element("div", { class: "group", role: "radiogroup", "aria-label": "Tool" });
    for (const [tool, text, key] of tools) {
      const made = button(`tool-${tool}`, text, () => this.choose(tool));
      made.title = `key ${key}`;
      made.setAttribute("aria-pressed", String(tool === "rotate"));
      choice.append(made);
    }
    const make = button("make-region", "Make region", () => void this.makeRegion());
    this.newName.addEventListener("keydown", ({ key }) => key === "Enter" && void this.makeRegion());
    holder.append(choice, element("span", { class: "group painter" }, element("label", {}, "size ", this.size),
      element("label", {}, this.erase, " erase"),
      element("label", { title: "cells at −y get the same as those at y" }, this.mirror, " mirror"),
      element("label", { title: "In a run, chooses the cells of a region" }, this.purpose, this.target), this.count, button("clear-selection", "Clear", () =>
        actions.clear()), this.newName, make), this.names);
    this.size.addEventListener("input", () => paintings.forEach((one) => (one.size = Number(this.size.value))));
    this.erase.addEventListener("change", () => paintings.forEach((one) => (one.erases = this.erase.checked)));
    this.target.addEventListener("change", () => actions.paintInto(this.target.value));
    this.showCount(0);
    this.fillActs();
    acts.append(element("h2", {}, "Act on the selected cells "), this.when, this.acts, this.lasting);
  }

  choose(tool: Tool): void {
    for (const painting of this.paintings) painting.choose(tool);
    this.holder.classList.toggle("painting", tool !== "rotate");
    for (const [name] of tools) document.getElementById(`tool-${name}`)!.setAttribute("aria-pressed",
      String(name === tool));
  }

  private async makeRegion(): Promise<void> {
    const name = this.newName.value.trim();
    if (await this.actions.makeRegion(name)) this.newName.value = "";
    else if (name === "") this.newName.focus();
  }

  key(key: string): boolean {
    const found = tools.find(([, , its]) => its === key);
    if (found) this.choose(found[0]);
    return found !== undefined;
  }

  private fillActs(): void {
    const strength = (id: string, value: string, label: string) =>
      element("input", { type: "number", id, value, step: "any", min: "0", "aria-label": label, class: "strength" });
    const light = strength("dark-strength", "0", "Residual activity, 0 to 1");
    const load = strength("pull-strength", "20", "Pull, Pa");
    this.acts.append(
      button("act-cut", "Cut", () => this.actions.act("cut", 0)),
      element("span", { class: "pair" }, button("act-darken", "Darken to", () => this.actions.act("darken",
        Number(light.value))), light),
      element("span", { class: "pair" }, button("act-pull", "Pull with", () => this.actions.act("pull",
        Number(load.value))), load, " Pa"));
  }

  showRegions(regions: string[]): void {
    const before = this.target.value;
    const names = regions.filter((name) => name !== "all");
    this.target.replaceChildren(element("option", { value: "" }, "selection"),
      ...names.map((name) => element("option", { value: name }, `region ${name}`)));
    this.target.value = names.includes(before) ? before : "";
    this.names.replaceChildren(...regions.map((name) => element("option", { value: name })));
  }

  showCount(count: number): void {
    this.holder.classList.toggle("selected", count > 0);
    this.count.textContent = `${count} cell${count === 1 ? "" : "s"}`;
  }

  /** `at`: time of an act on what is shown; null at rest, where acts are no acts. */
  showActs(at: string | null, lasting: string[]): void {
    this.when.textContent = at === null ? "Choose a run: an act on it makes another run, from the shown time on."
      : `at ${at}`;
    for (const one of this.acts.querySelectorAll<HTMLButtonElement>("button")) one.disabled = at === null;
    this.purpose.textContent = at === null ? "paint " : "select ";
    const made = at === null ? [] : lasting.map((name) => button(`end-${name}`,
      `${name.startsWith("pressure") ? "Let go" : "Light again"}: ${name.split(".")[1]}`, () =>
        this.actions.end(name)));
    if (this.lasting.textContent !== made.map((one) => one.textContent).join("")) this.lasting.replaceChildren(...made);
  }
}
