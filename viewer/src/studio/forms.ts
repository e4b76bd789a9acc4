// Forms of all tables of the scenario, made from the server's schema: a field a key, with unit, meaning and check.
import { element } from "../dom";
import { lastOf, words } from "../text";
import { type Connection, type DraftState, type KeyRow, Problem, type SchemaTable, type Table,
  type Value } from "./connection";
import { curveOf } from "./curve";
import type { Shape } from "./messages";
import { type Bounds, boundsOf, sliders } from "./slider";

const checkAfter = 150; // ms without typing

interface Place {
  name: string; // "cortex.apical"
  schema: SchemaTable;
  values: Table;
}

function isTable(value: Value | undefined): value is Table {
  return typeof value === "object" && value !== null && !Array.isArray(value);
}

/** Value at a dotted key of nested tables. */
export function valueAt(table: Table | null | undefined, key: string): Value | undefined {
  let value: Value | undefined = table ?? undefined;
  for (const part of key.split(".").filter((part) => part !== "")) value = isTable(value) ? value[part] : undefined;
  return value;
}

function textOf(value: Value | undefined): string {
  if (value === undefined || value === null) return "";
  return Array.isArray(value) ? value.join(", ") : String(value);
}

/** Remove the marks of Markdown. */
function plain(meaning: string): string {
  return meaning.replace(/\[([^\]]*)\]\([^)]*\)/g, "$1").replaceAll("`", "");
}

export class Forms {
  private schema: SchemaTable[] = [];
  private draft: DraftState | null = null;
  private readonly inMinutes = new Map<KeyRow, KeyRow>(); // keys in s that may be given in min, with that key
  private readonly opened = new Set<string>();
  private readonly pending = new Map<string, string | number | boolean>(); // refused so far, by key
  private shape: Shape | null = null; // of the tissue at rest
  private regionSizes = new Map<string, number>();
  private drags = 0;
  private isDragging = false;
  private readonly list = element("div", { id: "tables" });
  private readonly arrays = element("datalist", { id: "array-names" });
  private readonly region = element("select", { id: "add-region", "aria-label": "Region" }, element("option", {}, "all"));
  private readonly filter = element("input", { type: "search", id: "find-key", placeholder: "Find a key",
    "aria-label": "Find a key" });

  constructor(holder: HTMLElement, private readonly connection: Connection) {
    holder.append(this.filter, this.adding(), this.list, this.arrays);
    this.filter.addEventListener("input", () => this.applyFilter());
  }

  takeSchema(tables: SchemaTable[]): void {
    this.schema = tables.filter(({ path }) => path !== "expect.*");
    for (const { rows } of this.schema)
      for (const row of rows) {
        const other = rows.find((one) => one.instead_of === row.key && one.key === row.key.replace(/_s$/, "_min"));
        if (other && row.type === "number") this.inMinutes.set(row, other);
      }
    const kind = document.getElementById("add-kind") as HTMLSelectElement;
    kind.replaceChildren(...this.schema.filter(({ path }) => path.endsWith(".*"))
      .map(({ path, meaning }) => element("option", { value: path, title: plain(meaning) }, path.replace(".*", ""))));
    if (this.draft) this.show(this.draft);
  }

  /** Make the forms again where the scenario has changed, so that a text is not lost as it is typed. */
  show(draft: DraftState): void {
    const isSame = this.draft?.revision === draft.revision && this.list.childElementCount > 0;
    this.draft = draft;
    this.showRegions();
    if (this.schema.length > 0 && !isSame && !this.isDragging) this.build();
  }

  /** Propose a region for the next table. */
  addTo(region: string): void {
    if (![...this.region.options].some(({ value }) => value === region))
      this.region.append(element("option", { value: region }, region));
    this.region.value = region;
  }

  private showRegions(): void {
    const before = this.region.value;
    const named = Object.keys((this.draft?.table?.region as Table | undefined) ?? {});
    const names = [...new Set(["all", ...this.regionSizes.keys(), ...named])];
    this.region.replaceChildren(...names.map((name) => element("option", { value: name }, name)));
    this.region.value = names.includes(before) ? before : "all";
  }

  /** Take the bounds of sliders from a tissue. */
  fit(shape: Shape, regionSizes: Map<string, number>): void {
    this.regionSizes = regionSizes;
    this.showSizes();
    this.showRegions();
    if (JSON.stringify([shape.box, shape.own_fields]) === JSON.stringify([this.shape?.box, this.shape?.own_fields])) return;
    this.shape = shape;
    this.arrays.replaceChildren(...Object.keys(shape.own_fields).map((name) => element("option", { value: name })));
    if (this.draft && this.schema.length > 0 && !this.isDragging) this.build();
  }

  private showSizes(): void {
    for (const size of this.list.querySelectorAll<HTMLElement>(".size")) {
      const count = this.regionSizes.get(size.dataset.region!);
      size.textContent = count === undefined ? "" : ` ${count} cell${count === 1 ? "" : "s"}`;
    }
  }

  private build(): void {
    const focused = (document.activeElement as HTMLElement | null)?.dataset.key;
    this.list.replaceChildren(...this.places().map((place) => this.formOf(place)));
    if (focused) this.list.querySelector<HTMLElement>(`[data-key="${CSS.escape(focused)}"]`)?.focus();
    this.applyFilter();
    this.showSizes();
  }

  private places(): Place[] {
    const table = this.draft?.table ?? {};
    return this.schema.flatMap((schema) => {
      if (!schema.path.endsWith(".*")) {
        const values = schema.path === "" ? table : (table[schema.path] as Table | undefined) ?? {};
        return [{ name: schema.path, schema, values }];
      }
      const stem = schema.path.slice(0, -2);
      return Object.entries((table[stem] as Table | undefined) ?? {})
        .filter(([, values]) => isTable(values))
        .map(([name, values]) => ({ name: `${stem}.${name}`, schema, values: values as Table }));
    }).filter(({ name, schema }) => !this.isPartOfNamed(name, schema));
  }

  // [elasticity] holds both its own keys and named tables.
  private isPartOfNamed(name: string, schema: SchemaTable): boolean {
    return schema.path.endsWith(".*") && this.schema.some(({ path, rows }) =>
      path === schema.path.slice(0, -2) && rows.some(({ key }) => `${path}.${key.split(".")[0]}` === name));
  }

  private formOf({ name, schema, values }: Place): HTMLElement {
    const base = this.draft?.base_table;
    const details = this.rememberOpen(name, element("details", { class: "table", "data-table": name }));
    const prefix = name === "" ? "" : `${name}.`;
    const shape = String(valueAt(this.draft?.table, "embryo.shape") ?? "");
    const rows = schema.rows.filter(({ key, instead_of, shapes }) =>
      key !== "base" && key !== "format" && instead_of === "" && (shapes.length === 0 || shapes.includes(shape)));
    const isShown = ({ key }: KeyRow) => valueAt(values, key) !== undefined &&
      !(key.includes(".") && this.draft?.defaults?.includes(prefix + key)); // noise, pulses and so on, where there are none
    const differs = base && rows.some(({ key }) => this.differs(prefix + key));
    details.append(element("summary", { title: plain(schema.meaning) }, name === "" ? "General" : name,
      ...(differs ? [element("span", { class: "changed", title: `differs from ${this.draft?.base}` }, " ●")] : []),
      ...(schema.path === "region.*" ? [element("span", { class: "size", "data-region": name.slice("region.".length) })] : [])));
    details.addEventListener("toggle", () => details.open && !details.dataset.filled && fill());
    const fill = () => {
      details.dataset.filled = "true";
      details.append(element("p", { class: "note" }, plain(schema.meaning)));
      details.append(...rows.filter(isShown).filter(({ key }) => !this.isCurve(key)).map((row) => this.field(prefix, row,
        values)));
      for (const inner of new Set(rows.filter(({ key }) => this.isCurve(key)).map(({ key }) => key.split(".")[0])))
        details.append(this.curve(prefix + inner, valueAt(values, inner) as Table | undefined));
      const rest = rows.filter((row) => !isShown(row) && !this.isCurve(row.key));
      if (rest.length > 0)
        details.append(this.rememberOpen(`more of ${name}`, element("details", { class: "more" },
          element("summary", {}, `${rest.length} more keys`), ...rest.map((row) => this.field(prefix, row, values)))));
      if (schema.path.endsWith(".*")) details.append(this.remove(name));
    };
    if (details.open) fill();
    return details;
  }

  /** Open what was open before the forms were made again. */
  private rememberOpen(name: string, details: HTMLDetailsElement): HTMLDetailsElement {
    details.open = this.opened.has(name);
    details.addEventListener("toggle", () => {
      if (details.open) this.opened.add(name);
      else this.opened.delete(name);
    });
    return details;
  }

  private isCurve(key: string): boolean {
    return /^(stiffness_)?program\./.test(key);
  }

  private differs(key: string): boolean {
    const { table, base_table: base } = this.draft!;
    return base != null && JSON.stringify(valueAt(table, key)) !== JSON.stringify(valueAt(base, key));
  }

  private field(prefix: string, row: KeyRow, values: Table): HTMLElement {
    const key = prefix + row.key;
    const [name, unit] = words((this.inMinutes.get(row) ?? row).key);
    const input = this.input(key, row, valueAt(values, row.key));
    const fault = element("span", { class: "fault", role: "alert" });
    const box = element("div", { class: "field" },
      element("label", { title: `${key}: ${plain(row.meaning)}${row.allowed ? ` Allowed: ${row.allowed}.` : ""}` },
        element("span", { class: "name" }, name,
          ...(this.draft?.base_table && this.differs(key) ? [this.reset(key)] : [])),
        input, element("span", { class: "unit" }, unit)), fault);
    this.listen(key, row, input, fault);
    const bounds = prefix.startsWith("region.") ? boundsOf(row.key, values.array, this.shape) : null;
    if (bounds) box.append(this.sliders(key, valueAt(values, row.key), bounds, input as HTMLInputElement, fault));
    return box;
  }

  private input(key: string, row: KeyRow, value: Value | undefined): HTMLInputElement | HTMLSelectElement {
    const attributes = { "data-key": key, "aria-label": key };
    if (row.type === "true or false") {
      const box = element("input", { type: "checkbox", ...attributes });
      box.checked = value === true;
      return box;
    }
    if (row.type === "word" && row.words.length > 0) {
      const select = element("select", attributes,
        ...(value === undefined ? [element("option", { value: "" }, "–")] : []),
        ...row.words.map((word) => element("option", { value: word }, word)));
      select.value = textOf(value);
      return select;
    }
    const { allowed, type } = this.inMinutes.get(row) ?? row;
    const input = element("input", { type: "text", placeholder: allowed || type, autocomplete: "off",
      spellcheck: "false", ...attributes });
    const now = this.pending.get(key) ?? value;
    const isInMinutes = this.inMinutes.has(row) && typeof now === "number";
    input.value = textOf(isInMinutes ? Number((now / 60).toPrecision(8)) : now);
    if (this.isRegion(row.key)) input.setAttribute("list", "region-names");
    if (lastOf(row.key) === "array") input.setAttribute("list", "array-names");
    return input;
  }

  // One order at a time, so that the tissue follows the pointer; all of a drag are one step of undo.
  private sliders(key: string, value: Value | undefined, bounds: Bounds, input: HTMLInputElement,
    fault: HTMLElement): HTMLElement {
    let next: Value | undefined;
    let isBusy = false;
    const drag = `${key} ${++this.drags}`;
    const send = () => {
      if (isBusy || next === undefined) return;
      const changes = { [key]: next };
      [isBusy, next] = [true, undefined];
      this.connection.order("set", { changes, drag })
        .then(() => (fault.textContent = ""), (problem: Problem) => (fault.textContent = problem.message))
        .then(() => {
          isBusy = false;
          send();
        });
    };
    return sliders(key, value, bounds, (given) => {
      this.isDragging = true;
      input.value = textOf(given);
      next = given;
      send();
    }, () => {
      this.isDragging = false;
      if (!isBusy) this.build();
    });
  }

  private isRegion(key: string): boolean {
    return ["region", "about", "from", "neighbours_of"].includes(lastOf(key));
  }

  private listen(key: string, row: KeyRow, input: HTMLInputElement | HTMLSelectElement, fault: HTMLElement): void {
    const value = () => {
      if (input instanceof HTMLInputElement && input.type === "checkbox") return input.checked;
      const text = row.type === "number" ? input.value.trim().replace(/^([-+]?\d*),(\d+)$/, "$1.$2") : input.value;
      const minutes = this.inMinutes.has(row) && text !== "" ? Number(text) : NaN;
      return Number.isFinite(minutes) ? Number((60 * minutes).toPrecision(12)) : text;
    };
    const seconds = this.inMinutes.has(row) ? " (in seconds)" : "";
    const tell = (problem: unknown) => {
      const texts = problem instanceof Problem ? (problem.byKey.length > 0 ? problem.byKey.map((one) =>
        one.key === key || one.key === "" ? one.text + seconds : `${one.key}: ${one.text}`) : [problem.message]) : [];
      fault.textContent = texts.join("\n");
      input.setAttribute("aria-invalid", String(texts.length > 0));
    };
    let timer = 0;
    let turn = 0;
    input.addEventListener("input", () => {
      if (input instanceof HTMLSelectElement || input.type === "checkbox") return;
      clearTimeout(timer);
      const mine = ++turn;
      timer = window.setTimeout(() => {
        this.connection.order("check", { changes: { [key]: value() } })
          .then(() => mine === turn && tell(null), (problem) => mine === turn && tell(problem));
      }, checkAfter);
    });
    input.addEventListener("change", () => {
      clearTimeout(timer);
      ++turn;
      // What was refused before may be valid together with this.
      this.pending.set(key, value());
      const all = Object.fromEntries(this.pending);
      this.connection.order("set", { changes: { [key]: value() } })
        .catch(() => this.connection.order("set", { changes: all }))
        .then(() => {
          this.pending.clear();
          tell(null);
        }, tell);
    });
  }

  private reset(key: string): HTMLElement {
    const button = element("button", { type: "button", class: "reset", title: `as in ${this.draft!.base}` }, "●");
    button.addEventListener("click", (event) => {
      event.preventDefault();
      void this.connection.order("set", { changes: { [key]: valueAt(this.draft!.base_table, key) ?? null } });
    });
    return button;
  }

  private curve(key: string, program: Table | undefined): HTMLElement {
    const fault = element("span", { class: "fault", role: "alert" });
    const send = (changes: object) =>
      this.connection.order("set", { changes }).then(() => (fault.textContent = ""), (problem: Problem) =>
        (fault.textContent = problem.message));
    const title = lastOf(key).replace("_", " ");
    const times = program?.time_s as number[] | undefined;
    if (!times) {
      const button = element("button", { type: "button" }, `Add ${title}`);
      button.addEventListener("click", () => void send({ [key]: { time_s: [0, 300], activity: [0, 1] } }));
      return element("div", { class: "field" }, button, fault);
    }
    const end = Number(valueAt(this.draft?.table, "time.end_s"));
    const drawing = curveOf(times, program!.activity as number[], end, (time_s, activity) =>
      void send({ [key]: { time_s, activity } }));
    return element("div", { class: "field", "data-curve": key },
      element("span", { class: "name" }, `${title}: activity over ${Math.round(end / 60)} min`), drawing, fault);
  }

  private remove(name: string): HTMLElement {
    const button = element("button", { type: "button", class: "remove" }, `Remove ${name}`);
    const fault = element("span", { class: "fault", role: "alert" });
    button.addEventListener("click", () => {
      this.connection.order("set", { changes: { [name]: null } }).catch((problem: Problem) =>
        (fault.textContent = problem.message));
    });
    return element("div", { class: "field" }, button, fault);
  }

  // A new table, begun by the server with values that are accepted.
  private adding(): HTMLElement {
    const kind = element("select", { id: "add-kind", "aria-label": "Kind of table" });
    const name = element("input", { type: "text", id: "add-name", placeholder: "name",
      "aria-label": "Name of the table" });
    const region = this.region;
    const add = element("button", { type: "submit", id: "add" }, "Add");
    const fault = element("span", { class: "fault", role: "alert" });
    const form = element("form", { id: "adding" }, kind, name, element("label", {}, "in ", region), add, fault);
    const showRegion = () => (region.parentElement!.hidden = !this.schema.find(({ path }) =>
      path === kind.value)?.rows.some(({ key }) => key === "region"));
    kind.addEventListener("change", showRegion);
    form.addEventListener("submit", (event) => {
      event.preventDefault();
      const given = { kind: kind.value.replace(".*", ""), name: name.value.trim(), region: region.value };
      if (given.name === "") {
        fault.textContent = "It has no name; type one.";
        return name.focus();
      }
      const path = `${given.kind}.${given.name}`;
      this.opened.add(path);
      this.connection.order("add", given).then(
        () => {
          [fault.textContent, name.value] = ["", ""];
          const made = this.list.querySelector(`[data-table="${CSS.escape(path)}"]`);
          made?.scrollIntoView({ block: "nearest" });
          made?.querySelector("summary")?.focus();
        },
        (problem: Problem) => (fault.textContent = problem.message));
    });
    return form;
  }

  private applyFilter(): void {
    const text = this.filter.value.trim().toLowerCase();
    for (const details of this.list.querySelectorAll<HTMLDetailsElement>(":scope > details")) {
      const schema = this.places().find(({ name }) => name === details.dataset.table)?.schema;
      details.hidden = text !== "" &&
        !`${details.dataset.table} ${schema?.rows.map(({ key }) => key).join(" ")}`.toLowerCase().includes(text);
    }
  }
}
