// Choice of one or several columns.
import { element } from "../dom";
import type { Column } from "./column";

const groupNames: [string, (column: Column) => boolean][] = [
  ["keys", ({ role }) => role === "key"],
  ["measures", ({ role }) => role === "measure"],
  ["the run", ({ role }) => role !== "key" && role !== "measure"],
];

/** List for choosing one column. */
export function columnSelect(id: string, columns: Column[], first: Column, chosen: (column: Column) => void): HTMLSelectElement {
  const select = element("select", { id });
  for (const [name, belongs] of groupNames) {
    const options = columns.filter(belongs).map((column) => element("option", { value: column.name }, column.title));
    if (options.length > 0) select.append(element("optgroup", { label: name }, ...options));
  }
  select.value = first.name;
  select.addEventListener("change", () => chosen(columns.find(({ name }) => name === select.value)!));
  return select;
}

/** Tick boxes for several columns, in order; `chosen` is called with two or more. */
export function columnTicks(id: string, columns: Column[], first: Column[], chosen: (columns: Column[]) => void): HTMLElement {
  const list = element("div", { class: "ticks" });
  const boxes = columns.map((column) => {
    const box = element("input", { type: "checkbox", value: column.name });
    box.checked = first.includes(column);
    list.append(element("label", { title: column.name }, box, ` ${column.title}`));
    return box;
  });
  list.addEventListener("change", () => {
    const wanted = columns.filter((_, i) => boxes[i].checked);
    if (wanted.length >= 2) chosen(wanted);
  });
  return element("details", { id }, element("summary", {}, "Choose axes"), list);
}
