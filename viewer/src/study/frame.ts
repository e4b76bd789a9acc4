// Frame of a plot of one column over another: position on its canvas, axes, ticks and titles.
import { styleColour } from "../dom";
import { plotFont } from "../fonts";
import type { Axis, Tick } from "./axis";
import { clipped, type Layers } from "./layers";

export interface Frame {
  left: number;
  right: number;
  top: number;
  bottom: number;
}

const mostLabel = 96; // pixels of a tick's text at the left

/** Compute the left margin from the ticks. */
export function frameOf(layers: Layers, leftTexts: string[]): Frame {
  layers.base.font = plotFont;
  const widest = Math.max(20, ...leftTexts.map((text) => layers.base.measureText(text).width));
  return { left: Math.min(widest, mostLabel) + 32, right: layers.width - 14, top: 10, bottom: layers.height - 44 };
}

export function drawFrame(layers: Layers, frame: Frame, x: Axis, y: Axis): void {
  const ticksX = x.ticks(Math.max((frame.right - frame.left) / 90, 2));
  const ticksY = y.ticks(Math.max((frame.bottom - frame.top) / 55, 2));
  if (x.hasLane) ticksX.push({ at: x.lane, text: "none" });
  if (y.hasLane) ticksY.push({ at: y.lane, text: "none" });
  drawTicks(layers, frame, ticksX, ticksY);
  drawTitles(layers, frame, x.column.title, y.column.title);
}

export function drawTicks(layers: Layers, frame: Frame, ticksX: Tick[], ticksY: Tick[], hasLines = true): void {
  const { base } = layers;
  base.font = plotFont;
  base.lineWidth = 1;
  base.strokeStyle = styleColour("grid");
  if (hasLines) {
    base.beginPath();
    for (const { at } of ticksX) base.moveTo(at, frame.top), base.lineTo(at, frame.bottom);
    for (const { at } of ticksY) base.moveTo(frame.left, at), base.lineTo(frame.right, at);
    base.stroke();
  }
  base.fillStyle = styleColour("ink");
  base.textBaseline = "middle";
  base.textAlign = "right";
  let last = Infinity;
  for (const { at, text } of [...ticksY].sort((a, b) => b.at - a.at)) {
    if (last - at < 13) continue;
    base.fillText(clipped(base, text, mostLabel), frame.left - 6, at);
    last = at;
  }
  base.textBaseline = "top";
  base.textAlign = "center";
  last = -Infinity; // right end of the previous text: texts do not overlap
  const spacing = ticksX.length > 1 ? Math.abs(ticksX[1].at - ticksX[0].at) : Infinity;
  for (const { at, text } of [...ticksX].sort((a, b) => a.at - b.at)) {
    const fitted = clipped(base, text, Math.max(spacing - 6, 44));
    const half = base.measureText(fitted).width / 2;
    const middle = Math.min(at, layers.width - half - 1);
    if (middle - half < last + 5) continue;
    base.fillText(fitted, middle, frame.bottom + 6);
    last = middle + half;
  }
}

export function drawTitles(layers: Layers, frame: Frame, titleX: string, titleY: string): void {
  const { base } = layers;
  base.font = plotFont;
  base.fillStyle = styleColour("faint");
  base.textAlign = "center";
  base.textBaseline = "bottom";
  base.fillText(clipped(base, titleX, frame.right - frame.left), (frame.left + frame.right) / 2, layers.height - 4);
  base.save();
  base.translate(4, (frame.top + frame.bottom) / 2);
  base.rotate(-Math.PI / 2);
  base.textBaseline = "top";
  base.fillText(clipped(base, titleY, frame.bottom - frame.top), 0, 0);
  base.restore();
}
