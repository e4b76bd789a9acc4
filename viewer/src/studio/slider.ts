// Sliders of the selectors of a region: the tissue shows while one is dragged which cells the region has.
import { element } from "../dom";
import type { Value } from "./connection";
import type { Shape } from "./messages";

/** Ends of the sliders of a selector, and whether it has two, from and to. */
export interface Bounds {
  low: number;
  high: number;
  step: number;
  hasTwo: boolean;
}

/** Bounds of a selector of a tissue; none where no slider serves. */
export function boundsOf(key: string, array: Value | undefined, shape: Shape | null): Bounds | null {
  if (key === "angle_deg") return { low: -180, high: 180, step: 1, hasTwo: true };
  if (key === "length_percent") return { low: 0, high: 100, step: 1, hasTwo: true };
  if (key === "rows") return { low: 1, high: 40, step: 1, hasTwo: false };
  if (key === "rings") return { low: 1, high: 12, step: 1, hasTwo: false };
  const axis = ["x_um", "y_um", "z_um"].indexOf(key);
  if (axis >= 0 && shape) {
    const [low, high] = [Math.floor(shape.box.low[axis]), Math.ceil(shape.box.high[axis])];
    return { low, high, step: 1, hasTwo: true };
  }
  const range = typeof array === "string" ? shape?.own_fields[array] : undefined;
  if ((key !== "above" && key !== "below") || !range || !(range[1] > range[0])) return null;
  return { low: range[0], high: range[1], step: Number(((range[1] - range[0]) / 200).toPrecision(2)), hasTwo: false };
}

/** Sliders of the field `key`; `drag` receives each value on the way, `drop` is called at its end. */
export function sliders(key: string, value: Value | undefined, bounds: Bounds, drag: (value: Value) => void,
  drop: () => void): HTMLElement {
  const { low, high, step, hasTwo } = bounds;
  const unset = key.endsWith("below") ? high : low;
  const now = hasTwo ? (Array.isArray(value) ? value.map(Number) : [low, high]) : [Number(value ?? unset)];
  const ends = now.map((end, i) => {
    const what = hasTwo ? `${key}, ${i === 0 ? "from" : "to"}` : key;
    const input = element("input", { type: "range", min: String(Math.min(low, end)), max: String(Math.max(high, end)),
      step: String(step), "data-key": `${key}/${i}`, "aria-label": what });
    input.value = String(end);
    input.addEventListener("input", () => {
      const given = ends.map((one) => Number(one.value));
      // The end that is dragged pushes the other one.
      if (hasTwo && given[0] > given[1]) ends[1 - i].value = String((given[1 - i] = given[i]));
      drag(hasTwo ? given : given[0]);
    });
    input.addEventListener("change", drop);
    return input;
  });
  return element("div", { class: "sliders" }, ...ends);
}
