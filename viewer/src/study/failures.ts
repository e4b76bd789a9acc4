// Runs without a result, by reason. A click keeps only the runs with that reason.
import { element } from "../dom";
import { count as countText } from "../text";
import type { Selection } from "./selection";
import type { Column } from "./column";
import type { Study } from "./study_data";

export interface Failures {
  reason: string; // numbers that differ between its runs are "…"
  values: Set<number>; // of the column of reasons
  count: number;
  statuses: string[];
}

const mostReasons = 12; // initially

/** Runs with a reason, most common first. Reasons that differ only in numbers count as one. */
export function failuresOf(study: Study): Failures[] {
  const [reason, status] = [study.the("reason"), study.the("status")];
  const groups = new Map<string, Failures>();
  for (let row = 0; row < study.runs; ++row) {
    if (!reason.has(row)) continue;
    const pattern = patternOf(reason.text(row));
    const group = groups.get(pattern) ?? { reason: reason.text(row), values: new Set<number>(), count: 0, statuses: [] as string[] };
    groups.set(pattern, group);
    group.values.add(reason.values[row]);
    ++group.count;
    if (!group.statuses.includes(status.text(row))) group.statuses.push(status.text(row));
  }
  for (const [pattern, group] of groups) if (group.values.size > 1) group.reason = pattern;
  return [...groups.values()].sort((a, b) => b.count - a.count);
}

/** Reason with "…" for its numbers. */
export function patternOf(reason: string): string {
  return reason.replace(/(?<![A-Za-z_])-?\d+(\.\d+)?(e[-+]?\d+)?/g, "…");
}

export function showFailures(box: HTMLElement, selection: Selection): void {
  const failures = failuresOf(selection.study);
  box.hidden = failures.length === 0;
  if (failures.length === 0) return;
  const reason: Column = selection.study.the("reason");
  const rows = failures.map(({ reason: text, count, statuses, values }, i) => {
    const button = element("button", { type: "button", class: "reason", "aria-pressed": "false" }, text);
    const row = element("tr", { class: i < mostReasons ? "" : "more" }, element("td", { class: "number" }, countText(count)),
      element("td", {}, statuses.join(", ")), element("td", {}, button));
    button.addEventListener("click", () => selection.setTicks(reason, button.getAttribute("aria-pressed") === "true" ? null : values));
    selection.on("shown", () => button.setAttribute("aria-pressed", String(selection.ticks.get(reason) === values)));
    return row;
  });
  const table = element("table", {},
    element("thead", {}, element("tr", {}, ...["runs", "status", "reason"].map((text) => element("th", { scope: "col" }, text)))),
    element("tbody", {}, ...rows));
  const many = failures.reduce((sum, { count }) => sum + count, 0);
  box.append(
    element("h2", {}, `${countText(many)} ${many === 1 ? "run" : "runs"} without a result, by reason`),
    element("p", { class: "note" }, "Click a reason to show only its runs, in all plots and tables; click again to undo."),
    element("div", { class: "scroll" }, table),
  );
  if (failures.length <= mostReasons) return;
  const more = element("button", { type: "button" }, `all ${failures.length} reasons`);
  more.addEventListener("click", () => {
    table.classList.add("all");
    more.remove();
  });
  box.append(more);
}
