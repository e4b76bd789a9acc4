// State of the page. Its parts change it and are notified of changes.
import type { Field, View } from "./page_data";

export interface Cut {
  axis: number; // 0 x, 1 y, 2 z
  at: number; // um
  keep: 1 | -1; // visible side: 1 for greater coordinates
}

export interface Picked {
  run: number;
  id: number; // of the cell
}

export interface PageState {
  time: number; // s
  playing: boolean;
  speed: number; // simulated s per second
  field: Field;
  view: View;
  cut: Cut | null;
  edges: boolean;
  shell: boolean;
  marks: boolean;
  picked: Picked | null;
  shown: ReadonlySet<number>; // numbers of visible runs
  order: readonly number[]; // of the runs' numbers
  pointed: number | null; // highlighted run
  colourBy: string; // key that colours the runs, or ""
}

export type Key = keyof PageState;

export class State {
  private readonly listeners: { keys: Key[]; tell: () => void }[] = [];

  constructor(private readonly values: PageState) {}

  get now(): Readonly<PageState> {
    return this.values;
  }

  set(changes: Partial<PageState>): void {
    const changed = (Object.keys(changes) as Key[]).filter((key) => this.values[key] !== changes[key]);
    Object.assign(this.values, changes);
    for (const { keys, tell } of this.listeners) if (keys.some((key) => changed.includes(key))) tell();
  }

  /** Call `tell` at each change of one of these values; returns a function that ends this. */
  on(keys: Key[], tell: () => void): () => void {
    const listener = { keys, tell };
    this.listeners.push(listener);
    return () => void this.listeners.splice(this.listeners.indexOf(listener), 1);
  }
}

/** Highlight a run while the mouse is over `box`, or after a tap until the next. */
export function pointWith(box: HTMLElement, run: number | ((event: MouseEvent) => number | null), state: State): void {
  let byFinger = false;
  const point = (event: MouseEvent) => state.set({ pointed: typeof run === "number" ? run : run(event) });
  for (const kind of ["pointerenter", "pointermove", "pointerdown"] as const)
    box.addEventListener(kind, (event) => {
      byFinger = event.pointerType === "touch"; // may scroll the page
      if (!byFinger) point(event);
    });
  box.addEventListener("pointerleave", () => !byFinger && state.set({ pointed: null }));
  box.addEventListener("click", (event) => byFinger && point(event));
}
