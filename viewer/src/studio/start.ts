// Choice of a scenario: built-in ones, and files of the start folder.
import { byId, element } from "../dom";
import type { Connection, Problem } from "./connection";

export class Start {
  private readonly dialog = byId("start") as HTMLDialogElement;
  private readonly fault = element("p", { class: "fault", role: "alert" });
  private readonly cards = element("div", { id: "cards" });
  private readonly files = element("div", { id: "files" });
  private readonly filter = element("input", { type: "search", id: "find-file", placeholder: "Find a file",
    "aria-label": "Find a file" });

  constructor(private readonly connection: Connection, private readonly token: string) {
    const close = element("button", { type: "button", id: "close-start" }, "Close");
    close.addEventListener("click", () => this.dialog.close());
    this.dialog.append(element("header", {}, element("h2", {}, "Open a scenario or a tissue"), close), this.fault,
      this.cards,
      element("h2", {}, "Files of this folder"), this.filter, this.files);
    this.filter.addEventListener("input", () => {
      for (const file of this.files.children)
        (file as HTMLElement).hidden = !file.textContent!.includes(this.filter.value.trim());
    });
  }

  async open(): Promise<void> {
    if (!this.dialog.open) this.dialog.showModal();
    const { scenarios, files } = (await this.connection.order("gallery")) as unknown as { scenarios: Record<string,
      string>; files: string[] };
    this.cards.replaceChildren(...Object.entries(scenarios).map(([name, title]) => this.card(name, title)));
    this.files.replaceChildren(...files.map((name) => this.choice("file", name, name)));
    if (files.length === 0)
      this.files.textContent = "None. Scenarios (.toml), meshes (.vtu), polygons (.obj, .off, .ply, .vtp) " +
        "and points (.csv) appear here.";
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
      this.connection.order("open", { source }).then(() => this.dialog.close(), (problem: Problem) => {
        this.fault.textContent = problem.message;
        this.fault.scrollIntoView();
      });
    });
    return button;
  }
}
