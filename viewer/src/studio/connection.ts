// Connection to the server: orders and their answers, what is looked at, and states that it sends. Reconnects
// by itself.
import { type Frame, type Message, type Shape, unpack } from "./messages";

export type Value = string | number | boolean | null | Value[] | { [key: string]: Value };
export type Table = { [key: string]: Value };

export interface KeyRow {
  key: string;
  type: string;
  allowed: string;
  words: string[];
  meaning: string;
  required: boolean;
  shapes: string[];
  instead_of: string;
}

export interface SchemaTable {
  path: string;
  meaning: string;
  group: string;
  rows: KeyRow[];
}

/** Tissue file that is looked at before it is used. */
export interface Candidate {
  file: string;
  kind: string;
  kinds: string[];
  options: { name: string; label: string; value: string; words: string[] }[];
  remarks: string[];
  problem: string;
  cells: number;
  asked: number;
}

export interface DraftState {
  revision: number;
  folder: string;
  rest: number;
  problem: string;
  advice: string[];
  candidate: Candidate | null;
  table?: Table;
  base?: string;
  base_table?: Table | null;
  text?: string;
  defaults?: string[]; // keys of named tables that have their default values
  undo?: boolean;
  redo?: boolean;
}

export interface RunState {
  number: number;
  title: string;
  status: string;
  running: boolean;
  time_s: number;
  end_s: number;
  steps: number;
  failure: string;
  failed_cell: number | null;
  parent: number | null;
  act_s: number;
  from_s: number;
  notes: string[];
  lasting: string[];
}

export interface RunsState {
  runs: RunState[];
  jobs: Record<string, string>;
}

/** Order that the server refused; by key where the scenario has the fault. */
export class Problem extends Error {
  constructor(text: string, readonly byKey: { key: string; text: string }[]) {
    super(text);
  }
}

export interface Look {
  slot: number;
  run: number;
  field: string;
  at_s: number | null;
  known: number;
  rows: number;
  shapes: string[];
}

export interface Listener {
  schema(tables: SchemaTable[]): void;
  draft(state: DraftState): void;
  runs(state: RunsState): void;
  shape(message: Message<Shape>): void;
  frame(message: Message<Frame>): void;
  connected(on: boolean): void;
  /** The scenario was changed by this page. */
  edited(): void;
}

const editing = ["open", "use", "set", "add", "paint", "undo", "redo"];

const patience = 800; // ms before another attempt

export class Connection {
  private socket: WebSocket | null = null;
  private next = 1;
  private readonly waiting = new Map<number, { done: (answer: Table) => void; fail: (problem: Problem) => void }>();

  constructor(private readonly token: string, private readonly listener: Listener) {
    this.connect();
  }

  /** Carry out an order; fails with a Problem. */
  order(name: string, given: object = {}): Promise<Table> {
    const id = this.next++;
    return new Promise((done, fail) => {
      if (this.socket?.readyState !== WebSocket.OPEN) {
        fail(new Problem("The server does not answer; start plica studio again.", []));
        return;
      }
      const after = (answer: Table) => {
        done(answer);
        if (editing.includes(name)) this.listener.edited();
      };
      this.waiting.set(id, { done: after, fail });
      this.socket.send(JSON.stringify({ id, do: name, with: given }));
    });
  }

  look(look: Look): void {
    if (this.socket?.readyState === WebSocket.OPEN) this.socket.send(JSON.stringify({ do: "look", with: look }));
  }

  private connect(): void {
    const socket = new WebSocket(`ws://${location.host}/ws?token=${encodeURIComponent(this.token)}`);
    this.socket = socket;
    socket.binaryType = "arraybuffer";
    socket.addEventListener("open", () => this.listener.connected(true));
    socket.addEventListener("message", (event) => this.take(event.data as string | ArrayBuffer));
    socket.addEventListener("close", () => {
      this.listener.connected(false);
      for (const { fail } of this.waiting.values()) fail(new Problem("The server ended before it answered.", []));
      this.waiting.clear();
      setTimeout(() => this.connect(), patience);
    });
  }

  private take(data: string | ArrayBuffer): void {
    if (typeof data !== "string") {
      const message = unpack(data);
      if (message.head.kind === "shape") this.listener.shape(message as Message<Shape>);
      else this.listener.frame(message as Message<Frame>);
      return;
    }
    const message = JSON.parse(data);
    if (message.schema) this.listener.schema(message.schema);
    if (message.draft) this.listener.draft(message.draft);
    if (message.runs) this.listener.runs(message.runs);
    const waiting = this.waiting.get(message.id);
    if (!waiting) return;
    this.waiting.delete(message.id);
    if (message.problem) waiting.fail(new Problem(message.problem.text, message.problem.by_key));
    else waiting.done(message.ok);
  }
}
