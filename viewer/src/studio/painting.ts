// Brush and lasso: the cells that are visible at each pixel, drawn once a stroke as numbers, so that only what is seen
// is painted, and a stroke costs no search.
import * as three from "three";
import type { RunView } from "../run_view";

export type Tool = "rotate" | "brush" | "lasso";

const ratio = 0.5; // pixels of the drawing of numbers / CSS pixel

/** Drawing of a view in which each pixel is the number of the cell seen there. */
class CellPixels {
  private renderer: three.WebGLRenderer | null = null; // made with the first stroke
  private readonly material = new three.ShaderMaterial({
    clipping: true, side: three.DoubleSide,
    vertexShader: `#include <clipping_planes_pars_vertex>
      attribute float number; varying float cell;
      void main() {
        cell = number;
        vec4 mvPosition = modelViewMatrix * vec4(position, 1.0);
        #include <clipping_planes_vertex>
        gl_Position = projectionMatrix * mvPosition;
      }`,
    fragmentShader: `#include <clipping_planes_pars_fragment>
      varying float cell;
      void main() {
        #include <clipping_planes_fragment>
        float n = floor(cell + 0.5);
        gl_FragColor = vec4(mod(n, 256.0), mod(floor(n / 256.0), 256.0), floor(n / 65536.0), 255.0) / 255.0;
      }`,
  });
  private pixels = new Uint8Array(0);
  private width = 0;
  private height = 0;

  draw(view: RunView): void {
    const { boundary, cellOfFacet, facets, plane } = view.drawn!.ids;
    const numbers = new Float32Array(5 * facets);
    for (let f = 0; f < facets; ++f) numbers.fill(cellOfFacet(f) + 1, 5 * f, 5 * f + 5);
    const geometry = new three.BufferGeometry();
    geometry.setAttribute("position", boundary.geometry.getAttribute("position").clone());
    geometry.setAttribute("number", new three.BufferAttribute(numbers, 1));
    geometry.setIndex(boundary.geometry.getIndex());
    const mesh = new three.Mesh(geometry, this.material);
    mesh.frustumCulled = false;
    const scene = new three.Scene();
    scene.add(mesh);
    this.material.clippingPlanes = plane ? [plane] : null;
    this.width = Math.max(Math.round(view.size.width * ratio), 1);
    this.height = Math.max(Math.round(view.size.height * ratio), 1);
    const renderer = (this.renderer ??= new three.WebGLRenderer({ antialias: false, preserveDrawingBuffer: true }));
    renderer.localClippingEnabled = true;
    renderer.setSize(this.width, this.height, false);
    renderer.setClearColor(0, 0);
    renderer.outputColorSpace = three.LinearSRGBColorSpace;
    renderer.render(scene, view.camera);
    this.pixels = new Uint8Array(4 * this.width * this.height);
    const gl = renderer.getContext();
    gl.readPixels(0, 0, this.width, this.height, gl.RGBA, gl.UNSIGNED_BYTE, this.pixels);
    geometry.dispose();
  }

  /** Add the cells at the pixels of a box for which `inside` holds; CSS pixels from the upper left. */
  collect(left: number, top: number, right: number, bottom: number, inside: (x: number, y: number) => boolean,
    into: Set<number>): void {
    for (let row = Math.max(Math.floor(top * ratio), 0); row <= Math.min(Math.ceil(bottom * ratio),
      this.height - 1); ++row)
      for (let column = Math.max(Math.floor(left * ratio), 0); column <= Math.min(Math.ceil(right * ratio),
        this.width - 1); ++column) {
        const at = 4 * ((this.height - 1 - row) * this.width + column);
        const cell = this.pixels[at] + 256 * this.pixels[at + 1] + 65536 * this.pixels[at + 2] - 1;
        if (cell >= 0 && inside((column + 0.5) / ratio, (row + 0.5) / ratio)) into.add(cell);
      }
  }
}

export interface Stroke {
  cells: Set<number>;
  erases: boolean;
  done: boolean;
}

/** Input of strokes on one view. */
export class Painting {
  tool: Tool = "rotate";
  size = 24; // diameter of the brush, CSS pixels
  erases = false;
  private readonly pixels = new CellPixels();
  private readonly trace = document.createElementNS("http://www.w3.org/2000/svg", "svg");
  private readonly line = document.createElementNS("http://www.w3.org/2000/svg", "polyline");
  private readonly ring = document.createElementNS("http://www.w3.org/2000/svg", "circle"); // the brush at the pointer
  private points: [number, number][] = [];
  private stroke: Stroke | null = null;

  constructor(private readonly view: RunView, private readonly tell: (stroke: Stroke) => void) {
    this.trace.classList.add("trace");
    this.trace.append(this.line, this.ring);
    this.showRing(null);
    view.box.append(this.trace);
    const { canvas } = view;
    canvas.addEventListener("pointerdown", (event) => this.begin(event), { capture: true });
    canvas.addEventListener("pointermove", (event) => this.move(event));
    canvas.addEventListener("pointerleave", () => this.showRing(null));
    for (const kind of ["pointerup", "pointercancel"] as const) canvas.addEventListener(kind, () => this.end());
  }

  choose(tool: Tool): void {
    this.tool = tool;
    this.view.controls.noRotate = tool !== "rotate";
    this.view.canvas.dataset.tool = tool;
    this.showRing(null);
  }

  private showRing(event: PointerEvent | null): void {
    const isShown = event !== null && this.tool === "brush";
    this.ring.setAttribute("r", String(isShown ? this.size / 2 : 0));
    if (!isShown) return;
    const [x, y] = this.placeOf(event);
    this.ring.setAttribute("cx", String(x));
    this.ring.setAttribute("cy", String(y + this.view.canvas.offsetTop));
  }

  // CSS pixels from the upper left of the canvas
  private placeOf(event: PointerEvent): [number, number] {
    const box = this.view.canvas.getBoundingClientRect();
    return [event.clientX - box.left, event.clientY - box.top];
  }

  private begin(event: PointerEvent): void {
    if (this.tool === "rotate" || event.button !== 0 || !this.view.drawn) return;
    this.view.canvas.setPointerCapture(event.pointerId);
    this.pixels.draw(this.view);
    this.points = [];
    this.stroke = { cells: new Set(), erases: this.erases !== (event.altKey || event.shiftKey), done: false };
    this.move(event);
  }

  private move(event: PointerEvent): void {
    this.showRing(event);
    if (!this.stroke) return;
    const here = this.placeOf(event);
    const before = this.points.at(-1) ?? here;
    this.points.push(here);
    if (this.tool === "lasso") {
      this.line.setAttribute("points", this.points.map(([x, y]) => `${x},${y + this.view.canvas.offsetTop}`).join(" "));
      return;
    }
    // Dabs close to each other, however far the pointer has moved.
    const dabs = Math.ceil(Math.hypot(here[0] - before[0], here[1] - before[1]) / (this.size / 4)) || 1;
    for (let dab = 1; dab <= dabs; ++dab)
      this.dab(before[0] + ((here[0] - before[0]) * dab) / dabs, before[1] + ((here[1] - before[1]) * dab) / dabs);
    this.tell(this.stroke);
  }

  private dab(x: number, y: number): void {
    const radius = this.size / 2;
    const inside = (a: number, b: number) => Math.hypot(a - x, b - y) <= Math.max(radius, 1);
    this.pixels.collect(x - radius, y - radius, x + radius, y + radius, inside, this.stroke!.cells);
  }

  private end(): void {
    const stroke = this.stroke;
    if (!stroke) return;
    this.stroke = null;
    this.line.setAttribute("points", "");
    if (this.tool === "lasso" && this.points.length > 2) {
      const [xs, ys] = [this.points.map(([x]) => x), this.points.map(([, y]) => y)];
      const within = (x: number, y: number) => isInside(x, y, this.points);
      this.pixels.collect(Math.min(...xs), Math.min(...ys), Math.max(...xs), Math.max(...ys), within, stroke.cells);
    }
    this.tell({ ...stroke, done: true });
  }
}

function isInside(x: number, y: number, polygon: [number, number][]): boolean {
  let inside = false;
  for (let i = 0, j = polygon.length - 1; i < polygon.length; j = i++) {
    const [[a, b], [c, d]] = [polygon[i], polygon[j]];
    if (b > y !== d > y && x < ((c - a) * (y - b)) / (d - b) + a) inside = !inside;
  }
  return inside;
}
