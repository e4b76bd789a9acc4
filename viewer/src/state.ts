// What the page shows just now. Parts of the page change it and are told when it has changed.
import type { Field, View } from "./page_data";

export interface Cut {
  axis: number; // 0 x, 1 y, 2 z
  at: number; // um
  keep: 1 | -1; // which side stays: 1 that of greater coordinates
}

export interface Picked {
  run: number;
  id: number; // of the cell
}

export interface PageState {
  time: number; // s
  playing: boolean;
  speed: number; // s of the embryo in a second
  field: Field;
  view: View;
  cut: Cut | null;
  edges: boolean;
  shell: boolean;
  marks: boolean;
  picked: Picked | null;
  shown: ReadonlySet<number>; // numbers of the runs that are to be seen
  order: readonly number[]; // of the runs' numbers
  pointed: number | null; // the run that stands out
  colourBy: string; // what gives runs their colours: a varied key, or ""
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

  /** Calls `tell` at each change of one of these values, until what it returns is called. */
  on(keys: Key[], tell: () => void): () => void {
    const listener = { keys, tell };
    this.listeners.push(listener);
    return () => void this.listeners.splice(this.listeners.indexOf(listener), 1);
  }
}

/** What points at `box` points at a run, which then stands out: a mouse while it is there, a finger's tap until the next. */
export function pointWith(box: HTMLElement, run: number | ((event: MouseEvent) => number | null), state: State): void {
  let byFinger = false;
  const point = (event: MouseEvent) => state.set({ pointed: typeof run === "number" ? run : run(event) });
  for (const kind of ["pointerenter", "pointermove", "pointerdown"] as const)
    box.addEventListener(kind, (event) => {
      byFinger = event.pointerType === "touch"; // which may be moving the page
      if (!byFinger) point(event);
    });
  box.addEventListener("pointerleave", () => !byFinger && state.set({ pointed: null }));
  box.addEventListener("click", (event) => byFinger && point(event));
}
