// Activity time course as a curve: points are dragged, added by a double click and removed by the key Delete.
import { element } from "../dom";
import { number } from "../text";

const [width, height, pad] = [280, 96, 14];
const svg = "http://www.w3.org/2000/svg";

function make(tag: string, attributes: Record<string, string | number>): SVGElement {
  const made = document.createElementNS(svg, tag);
  for (const [name, value] of Object.entries(attributes)) made.setAttribute(name, String(value));
  return made;
}

/** Curve of `activity` over `times` (s), drawn to `end`; `tell` receives both after each change. */
export function curveOf(times: number[], activity: number[], end: number, tell: (times: number[], activity: number[]) =>
  void): HTMLElement {
  const points = times.map((time, i) => ({ time, value: activity[i] }));
  const last = Math.max(end, ...times, 1);
  const top = Math.max(1, ...activity) * 1.1;
  const x = (time: number) => pad + (time / last) * (width - 2 * pad);
  const y = (value: number) => height - pad - (value / top) * (height - 2 * pad);
  const drawing = make("svg", { viewBox: `0 0 ${width} ${height}`, class: "curve", role: "group",
    "aria-label": "Activity over time" });
  const readout = element("output", { class: "note" }, "Drag points; double-click adds one, Delete removes it.");
  const line = make("polyline", {});
  const say = () => tell(points.map((p) => p.time), points.map((p) => p.value));

  const draw = () => {
    line.setAttribute("points", [[0, points[0]?.value ?? 1], ...points.map((p) => [p.time, p.value]), [last,
      points.at(-1)?.value ?? 1]]
      .map(([time, value]) => `${x(time)},${y(value)}`).join(" "));
    drawing.replaceChildren(make("line", { x1: pad, x2: width - pad, y1: y(0), y2: y(0), class: "axis" }), line,
      ...points.map((_, i) => handle(i)));
  };
  const set = (i: number, time: number, value: number) => {
    const least = points[i - 1]?.time ?? 0;
    const most = points[i + 1]?.time ?? Infinity;
    points[i] = { time: Math.round(Math.min(Math.max(time, least), most)),
      value: Number(Math.max(value, 0).toPrecision(3)) };
    readout.textContent = `${number(points[i].time / 60)} min: ${number(points[i].value)}`;
  };
  const handle = (i: number): SVGElement => {
    const circle = make("circle", { cx: x(points[i].time), cy: y(points[i].value), r: 6, tabindex: 0, role: "slider",
      "aria-label": `Point ${i + 1}`, "aria-valuenow": points[i].value,
      "aria-valuetext": `${number(points[i].time)} s: ${number(points[i].value)}` });
    circle.addEventListener("pointerdown", (event) => drag(event as PointerEvent, i));
    circle.addEventListener("keydown", (event) => byKey(event as KeyboardEvent, i));
    return circle;
  };
  const drag = (event: PointerEvent, i: number) => {
    event.preventDefault();
    const box = drawing.getBoundingClientRect();
    const scale = width / box.width;
    const move = (now: PointerEvent) => {
      const time = (((now.clientX - box.left) * scale - pad) / (width - 2 * pad)) * last;
      const value = ((height - pad - (now.clientY - box.top) * scale) / (height - 2 * pad)) * top;
      set(i, time, value);
      draw();
    };
    const end = () => {
      window.removeEventListener("pointermove", move);
      say();
    };
    window.addEventListener("pointermove", move);
    window.addEventListener("pointerup", end, { once: true });
  };
  const byKey = (event: KeyboardEvent, i: number) => {
    const steps: Record<string, [number, number]> = {
      ArrowLeft: [-last / 60, 0], ArrowRight: [last / 60, 0], ArrowUp: [0, top / 40], ArrowDown: [0, -top / 40],
    };
    if (event.key === "Delete" && points.length > 1) points.splice(i, 1);
    else if (steps[event.key]) set(i, points[i].time + steps[event.key][0], points[i].value + steps[event.key][1]);
    else return;
    event.preventDefault();
    event.stopPropagation();
    draw();
    (drawing.querySelectorAll("circle")[Math.min(i, points.length - 1)] as SVGElement).focus();
    say();
  };
  drawing.addEventListener("dblclick", (event) => {
    const box = drawing.getBoundingClientRect();
    const scale = width / box.width;
    const time = (((event.clientX - box.left) * scale - pad) / (width - 2 * pad)) * last;
    const place = points.findIndex((p) => p.time > time);
    points.splice(place < 0 ? points.length : place, 0, { time: 0, value: 0 });
    const i = place < 0 ? points.length - 1 : place;
    set(i, time, ((height - pad - (event.clientY - box.top) * scale) / (height - 2 * pad)) * top);
    draw();
    say();
  });
  draw();
  return element("div", {}, drawing as unknown as HTMLElement, readout);
}
