// Panel of the picked run: values, command to repeat it, and kept files.
import { element } from "../dom";
import { colourOfStatus, swatch } from "./colours";
import type { Selection } from "./selection";
import type { Column } from "./column";
import type { Study } from "./study_data";

/** Shell command `plica run` with all overrides of the run. */
export function commandOf(study: Study, row: number): string {
  const { page } = study;
  const seeds = study.the("seeds").exact(row);
  const overrides = [
    ...page.set, ...(seeds === "" ? [] : seeds.split(" ")), ...study.of("key").map((key) => `${key.name}=${key.exact(row)}`),
  ];
  const replicate = study.the("replicate");
  const out = `run-${study.the("point").exact(row)}${replicate.varies ? `-${replicate.exact(row)}` : ""}`;
  return [`plica run ${quoted(page.scenario_argument)}`, ...overrides.map((override) => `--set ${quoted(override)}`), `--out ${out}`].join(" \\\n  ");
}

/** Quote an argument for a shell. */
export function quoted(argument: string): string {
  return /^[\w.,:=/+@%-]+$/.test(argument) ? argument : `'${argument.replaceAll("'", `'\\''`)}'`;
}

export class RunPanel {
  constructor(private readonly box: HTMLElement, private readonly selection: Selection) {
    selection.on("picked", () => this.show());
    this.show();
  }

  /** Update after a change of colours. */
  show(): void {
    const { picked, study } = this.selection;
    document.body.classList.toggle("with-run", picked !== null);
    if (picked === null) return this.box.replaceChildren();
    const close = element("button", { type: "button", class: "close", "aria-label": "Close" }, "×");
    close.addEventListener("click", () => this.selection.pick(null));
    const replicate = study.the("replicate");
    const name = `Point ${study.the("point").text(picked)}${replicate.varies ? `, replicate ${replicate.text(picked)}` : ""}`;
    const [status, reason] = [study.the("status"), study.the("reason")];
    this.box.replaceChildren(
      element("div", { class: "title" }, element("h2", {}, name), close),
      element("p", {}, swatch(colourOfStatus(status.exact(picked))), status.text(picked)),
      ...(reason.has(picked) ? [element("p", { class: "notice" }, reason.text(picked))] : []),
      ...this.links(picked),
      this.values(study.of("key"), picked),
      ...this.command(picked),
      element("h3", {}, "Results"),
      this.values([...study.of("verdict"), ...study.of("measure"), study.the("steps"), study.the("wall_s")], picked),
    );
  }

  private values(columns: Column[], row: number): HTMLElement {
    const list = element("dl");
    for (const column of columns)
      list.append(
        element("dt", { title: column.name }, column.title),
        element("dd", { "data-key": column.name, class: column.has(row) ? "" : "none" }, column.text(row)));
    return list;
  }

  private links(row: number): HTMLElement[] {
    const { study } = this.selection;
    const kept = study.the("kept").exact(row);
    if (kept === "") return [];
    const href = [...study.page.points.split("/"), ...kept.split("/")].map(encodeURIComponent).join("/");
    const text = kept.endsWith(".html") ? "Report of this run" : "summary.json of this run";
    return [element("p", {}, element("a", { href, target: "_blank", rel: "noopener", id: "kept" }, text))];
  }

  private command(row: number): HTMLElement[] {
    const text = commandOf(this.selection.study, row);
    const copy = element("button", { type: "button" }, "Copy");
    copy.addEventListener("click", () => {
      navigator.clipboard.writeText(text).then(() => (copy.textContent = "Copied"), () => (copy.textContent = "Not allowed here"));
    });
    return [
      element("div", { class: "title" }, element("h3", {}, "Command to repeat this run"), copy),
      element("pre", { id: "command", tabindex: "0" }, text),
    ];
  }
}
