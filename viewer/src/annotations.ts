// Annotations of a picture: scale bar, letters of the axes, time, colour legend. Drawn on a 2D canvas, so that the page and
// saved pictures agree.
import * as three from "three";
import { colourAt, css } from "./colour";
import { styleColour } from "./dom";
import { colouredRegions, type Field, nameOfStep, type PageData, titleOf, type Vec3 } from "./page_data";
import { number } from "./text";

const font = "system-ui, sans-serif";
const letterSpacing = 30; // pixels; of two letters that are closer, the one across the line of sight is drawn

export interface Frame {
  width: number; // CSS pixels
  height: number;
  camera: three.OrthographicCamera;
  centre: Vec3;
  /** Extent of the tissue from its centre in a direction of the picture (right, up), um. */
  reach: (right: three.Vector3, up: three.Vector3, along: three.Vector2) => number;
  title: string; // "": none
  time: string; // "": none
  letters: [string, string][] | null; // at the low and high ends of x, y, z
  isSmall: boolean; // time in small letters; length of the scale beside its bar, not above it
}

export function annotate(context: CanvasRenderingContext2D, frame: Frame): void {
  context.textBaseline = "middle";
  context.fillStyle = context.strokeStyle = styleColour("ink");
  if (frame.letters) drawMarks(context, frame, frame.letters);
  drawScaleBar(context, frame);
  context.textAlign = "left";
  context.textBaseline = "top";
  context.font = frame.isSmall ? `11px ${font}` : `600 15px ${font}`;
  context.fillText(frame.time, frame.isSmall ? 8 : 10, frame.isSmall ? 3 : 10);
  if (frame.title !== "") {
    context.font = `13px ${font}`;
    context.fillText(shortened(context, frame.title, frame.width - 20), 10, 30);
  }
}

function shortened(context: CanvasRenderingContext2D, text: string, width: number): string {
  let short = text.slice(0, 300);
  while (short.length > 1 && context.measureText(short).width > width) short = `${short.slice(0, -2).trimEnd()}…`;
  return short;
}

// A letter lies outside the tissue in the projected direction of its axis; faint if it points away from the viewer; none
// along the line of sight.
function drawMarks(context: CanvasRenderingContext2D, frame: Frame, letters: [string, string][]): void {
  const { camera, centre, width, height, reach } = frame;
  const pixelsPerUm = (width * camera.zoom) / (camera.right - camera.left);
  const right = new three.Vector3().setFromMatrixColumn(camera.matrixWorld, 0);
  const up = new three.Vector3().setFromMatrixColumn(camera.matrixWorld, 1);
  const sight = camera.getWorldDirection(new three.Vector3());
  const middle = new three.Vector3(...centre).project(camera);
  context.font = `600 14px ${font}`;
  context.textAlign = "center";
  const marks = letters.flatMap(([low, high], axis) => [low, high].map((text, end) => {
    const sign = end === 0 ? -1 : 1;
    const along = new three.Vector2(right.getComponent(axis), up.getComponent(axis)).multiplyScalar(sign);
    return { text, along, isBehind: sign * sight.getComponent(axis) > 0.3, length: along.length() };
  }));
  const taken: [number, number][] = [];
  for (const { text, along, isBehind, length } of marks.sort((a, b) => b.length - a.length)) {
    if (length < 0.3) continue;
    along.normalize();
    const distance = pixelsPerUm * reach(right, up, along) + 7 + context.measureText(text).width / 2;
    const x = ((middle.x + 1) / 2) * width + along.x * distance;
    const y = ((1 - middle.y) / 2) * height - along.y * distance;
    if (taken.some(([a, b]) => Math.hypot(a - x, b - y) < letterSpacing)) continue;
    taken.push([x, y]);
    context.fillStyle = styleColour(isBehind ? "faint" : "ink");
    context.fillText(text, x, y);
  }
  context.fillStyle = styleColour("ink");
}

function drawScaleBar(context: CanvasRenderingContext2D, frame: Frame): void {
  const { camera, width, height, isSmall } = frame;
  const umPerPixel = (camera.right - camera.left) / camera.zoom / width;
  const longest = 0.25 * width * umPerPixel;
  const power = 10 ** Math.floor(Math.log10(longest));
  const length = [5, 2, 1].map((factor) => factor * power).find((candidate) => candidate <= longest) ?? power;
  const pixels = length / umPerPixel;
  const [x, y] = isSmall ? [8, height - 11] : [12, height - 14];
  context.fillRect(x, y, pixels, 3);
  context.font = `${isSmall ? 11 : 13}px ${font}`;
  context.textAlign = "left";
  context.textBaseline = isSmall ? "middle" : "bottom";
  context.fillText(`${number(length)} µm`, isSmall ? x + pixels + 5 : x, isSmall ? y + 2 : y - 3);
}

export const legendHeight = 54;

/** Draw the colour scale with title and ticks, `legendHeight` high. */
export function drawLegend(context: CanvasRenderingContext2D, width: number, field: Field, page: PageData): void {
  const map = page.maps[field.map];
  const [left, top, high] = [Math.max(16, (width - 460) / 2), 20, 13];
  const wide = width - 2 * left;
  context.font = `13px ${font}`;
  context.textAlign = "center";
  context.textBaseline = "top";
  context.fillStyle = styleColour("ink");
  context.fillText(titleOf(field), width / 2, 2);
  const steps = field.scale === "steps";
  const names = map.map((_, step) => nameOfStep(field, step, page)).filter((name) => name !== null);
  const more = field.name === "region" ? colouredRegions(page).length + 1 - map.length : 0;
  if (more > 0) names[names.length - 1] += ` and ${more} more`;
  if (steps && names.length > 0) {
    drawNames(context, width, top, names, map);
    return;
  }
  const count = steps ? map.length : Math.round(wide);
  for (let i = 0; i < count; ++i) {
    context.fillStyle = css(colourAt(map, i / (count - 1)));
    context.fillRect(left + (wide * i) / count, top, wide / count + 0.5, high);
  }
  context.fillStyle = styleColour("ink");
  const ticks = steps ? map.length : 5;
  for (let i = 0; i < ticks; ++i) {
    const part = steps ? (i + 0.5) / ticks : i / (ticks - 1);
    const value = field.low + (i / (ticks - 1)) * (field.high - field.low);
    context.fillRect(left + wide * part - 0.5, top + high, 1, 4);
    const last = steps && i === ticks - 1 ? "+" : "";
    context.fillText(number(Math.abs(value) < 1e-12 * field.high ? 0 : value, 3) + last, left + wide * part, top + high + 6);
  }
}

// One box with a name per step, in two rows if one is too short.
function drawNames(context: CanvasRenderingContext2D, width: number, top: number, names: string[], map: string[]): void {
  const [box, gap, rowHeight] = [13, 5, 17];
  const room = names.length > 3 ? width / Math.ceil(names.length / 2) : width / names.length;
  const texts = names.map((name) => shortened(context, name, room - box - 4 * gap));
  const widths = texts.map((text) => box + gap + context.measureText(text).width + 3 * gap);
  const total = widths.reduce((sum, wide) => sum + wide, 0);
  const firstRow = total <= width ? names.length : Math.ceil(names.length / 2);
  context.textAlign = "left";
  for (const [from, to, y] of [[0, firstRow, top], [firstRow, names.length, top + rowHeight]]) {
    let x = (width - widths.slice(from, to).reduce((sum, wide) => sum + wide, 0)) / 2;
    for (let i = from; i < to; ++i) {
      context.fillStyle = map[i];
      context.fillRect(x, y, box, box);
      context.fillStyle = styleColour("ink");
      context.fillText(texts[i], x + box + gap, y);
      x += widths[i];
    }
  }
}
