// Two canvases: one drawn rarely, and above it one that follows the pointer.
import { element } from "../dom";

export class Layers {
  readonly box = element("div", { class: "layers" });
  readonly base: CanvasRenderingContext2D;
  readonly over: CanvasRenderingContext2D;
  width = 0; // CSS pixels
  height = 0;

  /** `draw`: called at each change of size. */
  constructor(label: string, draw: () => void) {
    const [below, above] = [element("canvas", { role: "img", "aria-label": label }), element("canvas", { "aria-hidden": "true" })];
    this.box.append(below, above);
    [this.base, this.over] = [below.getContext("2d")!, above.getContext("2d")!];
    new ResizeObserver(() => {
      if (this.fit()) draw();
    }).observe(this.box);
  }

  /** Whether the size has changed. */
  private fit(): boolean {
    const { clientWidth: width, clientHeight: height } = this.box;
    if (width === this.width && height === this.height) return false;
    [this.width, this.height] = [width, height];
    const scale = Math.min(devicePixelRatio || 1, 2);
    for (const context of [this.base, this.over]) {
      context.canvas.width = Math.round(width * scale);
      context.canvas.height = Math.round(height * scale);
      context.setTransform(scale, 0, 0, scale, 0, 0);
    }
    return width > 0 && height > 0;
  }

  clear(context: CanvasRenderingContext2D): void {
    context.clearRect(0, 0, this.width, this.height);
  }

  /** Position of the pointer, in CSS pixels of the canvases. */
  place(event: MouseEvent): { x: number; y: number } {
    const { left, top } = this.box.getBoundingClientRect();
    return { x: event.clientX - left, y: event.clientY - top };
  }
}

/** Clip a text with "…" to a width. */
export function clipped(context: CanvasRenderingContext2D, text: string, width: number): string {
  if (context.measureText(text).width <= width) return text;
  let length = text.length;
  while (length > 1 && context.measureText(`${text.slice(0, length)}…`).width > width) --length;
  return `${text.slice(0, length).trimEnd()}…`;
}

/** Break words into at most `most` lines, the last one clipped. */
export function wrapped(context: CanvasRenderingContext2D, text: string, width: number, most: number): string[] {
  const lines: string[] = [];
  for (const word of text.split(" ")) {
    const longer = `${lines.at(-1)} ${word}`;
    if (lines.length > 0 && (lines.length === most || context.measureText(longer).width <= width)) lines[lines.length - 1] = longer;
    else lines.push(word);
  }
  return lines.map((line) => clipped(context, line, width));
}
