// Scatter plot of any column over any other.
import { element } from "../dom";
import { columnSelect } from "./column_choice";
import { Points } from "./points";
import type { Selection } from "./selection";
import type { Column } from "./column";

export function makeScatter(box: HTMLElement, selection: Selection, x: Column, y: Column): Points {
  const columns = selection.study.plottable;
  const points = new Points(selection, x, y, "Scatter plot of the runs");
  const logarithm = (axis: "x" | "y") => {
    const tick = element("input", { type: "checkbox", id: `log-${axis}` });
    const label = element("label", {}, tick, " log");
    const mayBe = () => (label.hidden = points[axis].words !== null || !(points[axis].low > 0) || points[axis].isLogarithmic);
    tick.addEventListener("change", () => {
      points.isLogarithmic[axis] = tick.checked;
      points.draw();
    });
    mayBe();
    return { label, mayBe };
  };
  const [logX, logY] = [logarithm("x"), logarithm("y")];
  const choice = (axis: "x" | "y", first: Column) =>
    columnSelect(`scatter-${axis}`, columns, first, (column) => {
      points[axis] = column;
      logX.mayBe();
      logY.mayBe();
      points.draw();
    });
  box.append(
    element("h2", {}, "Scatter plot"),
    element("div", { class: "group choices" },
      element("span", { class: "choice" }, element("label", {}, "Up ", choice("y", y)), logY.label),
      element("span", { class: "choice" }, element("label", {}, "Across ", choice("x", x)), logX.label)),
    points.layers.box,
  );
  const { runs } = selection.study;
  const failed = Array.from({ length: runs }, (_, row) => row).some((row) => !selection.study.hasResult(row));
  if (failed) box.append(element("p", { class: "note" }, "×: run that failed, without a result."));
  return points;
}
