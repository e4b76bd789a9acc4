// Choice of a scenario: built-in ones, and scenarios and tissues of the start folder.
import { byId, element } from "../dom";
import type { Connection, Problem } from "./connection";

export class Start {
  private readonly dialog = byId("start") as HTMLDialogElement;
  private readonly fault = element("p", { class: "fault", role: "alert" });
  private readonly cards = element("div", { id: "cards" });
  private readonly scenarios = element("div", { class: "files" });
  private readonly tissues = element("div", { class: "files" });
  private readonly filter = element("input", { type: "search", id: "find-file", placeholder: "Find a file",
    "aria-label": "Find a file" });

  constructor(private readonly connection: Connection, private readonly token: string,
    private readonly lookAt: () => void) {
    const close = element("button", { type: "button", id: "close-start" }, "Close");
    close.addEventListener("click", () => this.dialog.close());
    this.dialog.append(element("header", {}, element("h2", {}, "Open a scenario or a tissue"), close), this.fault,
      this.cards,
      element("h2", {}, "A tissue of mine"),
      element("p", { class: "note" }, "Label images (.tif, .png, .npy), polygons (.obj, .off, .ply, .vtp, .geojson, " +
        "tyssue's .hf5), meshes (.vtu) and cell centres (.csv) of this folder. You see it, and what plica remarks, first."),
      this.filter, this.tissues, element("h2", {}, "Scenarios of this folder"), this.scenarios);
    this.filter.addEventListener("input", () => {
      for (const file of [...this.tissues.children, ...this.scenarios.children])
        (file as HTMLElement).hidden = !file.textContent!.includes(this.filter.value.trim());
    });
  }

  async open(): Promise<void> {
    if (!this.dialog.open) this.dialog.showModal();
    const { scenarios, files, folder } = (await this.connection.order("gallery")) as unknown as {
      scenarios: Record<string, string>; files: string[]; folder: string };
    this.cards.replaceChildren(...Object.entries(scenarios).map(([name, title]) => this.card(name, title)));
    for (const [list, isScenario] of [[this.scenarios, true], [this.tissues, false]] as const) {
      const own = files.filter((name) => name.endsWith(".toml") === isScenario);
      list.replaceChildren(...own.map((name) => this.choice("file", name, name)));
      if (own.length === 0) list.textContent = `None in ${folder}.`;
    }
  }

  private card(name: string, title: string): HTMLElement {
    const card = this.choice("card", name, "");
    const picture = element("img", { src: `/card/${name}?token=${encodeURIComponent(this.token)}`, alt: "" });
    card.append(picture, element("strong", {}, name), element("span", {}, title));
    return card;
  }

  private choice(kind: string, source: string, text: string): HTMLElement {
    const button = element("button", { type: "button", class: kind, "data-source": source }, text);
    button.addEventListener("click", () => {
      this.fault.textContent = "";
      const isTissue = kind === "file" && !source.endsWith(".toml");
      this.connection.order(isTissue ? "look_at" : "open", { source }).then(() => {
        this.dialog.close();
        if (isTissue) this.lookAt();
      }, (problem: Problem) => {
        this.fault.textContent = problem.message;
        this.fault.scrollIntoView();
      });
    });
    return button;
  }
}
