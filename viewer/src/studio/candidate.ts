// A tissue file before it is used: how it was read, what the reader remarked, and what it asks. The picture shows it meanwhile.
import { element } from "../dom";
import type { Candidate, Connection } from "./connection";

export const candidateRun = -1; // number of its frames, beside those of runs

export class CandidatePanel {
  private file = "";
  private asked = ""; // number and kind of the reading that the fields are of
  private readonly questions = element("div", { class: "group" });
  private readonly remarks = element("ul", { id: "remarks" });
  private readonly fault = element("p", { class: "fault", role: "alert" });
  private readonly title = element("h2", { role: "status" });
  private readonly use = element("button", { type: "button", id: "use" }, "Use this tissue");

  constructor(private readonly holder: HTMLElement, private readonly connection: Connection,
    private readonly tell: (problem: unknown) => void, leave: () => void) {
    const back = element("button", { type: "button", id: "leave" }, "Do not use it");
    holder.append(element("div", { class: "group" }, this.title, this.use, back), this.questions, this.remarks, this.fault);
    back.addEventListener("click", leave);
    this.use.addEventListener("click", () => void connection.order("use").catch(tell));
  }

  /** Show what the server knows of the file, while it is chosen. */
  show(candidate: Candidate | null, isChosen: boolean): void {
    this.holder.hidden = !isChosen || candidate === null;
    if (!candidate) return;
    if (candidate.file !== this.file) this.questions.replaceChildren();
    this.file = candidate.file;
    const isRead = candidate.cells > 0;
    this.title.textContent = isRead ? `${candidate.file}: ${candidate.cells} cells, not used yet`
      : candidate.problem === "" ? `${candidate.file} is being read…` : `${candidate.file} cannot be used so far`;
    this.use.disabled = candidate.problem !== ""; // the server waits for a reading that is under way
    this.fault.textContent = candidate.problem;
    const remarks = candidate.remarks.map((line) => element("li", {}, line));
    this.remarks.replaceChildren(...(isRead && remarks.length === 0 ? [element("li", {}, "No remarks.")] : remarks));
    if ((isRead || candidate.problem !== "") && `${candidate.asked} ${candidate.kind}` !== this.asked) this.fill(candidate);
  }

  private fill(candidate: Candidate): void {
    this.asked = `${candidate.asked} ${candidate.kind}`;
    const answers: Record<string, string> = Object.fromEntries(candidate.options.map(({ name, value }) => [name, value]));
    const ask = (options: object) => void this.connection.order("look_at", { source: candidate.file, options })
      .catch(this.tell);
    const field = (name: string, label: string, value: string, words: string[], changed: (value: string) => void) => {
      const input = words.length > 0
        ? element("select", {}, ...words.map((word) => element("option", { value: word }, word || "from the bend")))
        : element("input", { type: "text", inputmode: "decimal" });
      input.id = `ask-${name}`;
      input.value = value;
      input.addEventListener("change", () => changed(input.value));
      return element("label", {}, `${label} `, input);
    };
    this.questions.replaceChildren(
      ...(candidate.kinds.length > 1 ? [field("kind", "read as", candidate.kind, candidate.kinds, (kind) => ask({ kind }))]
        : []),
      ...candidate.options.map(({ name, label, value, words }) => field(name, label, value, words, (text) => {
        answers[name] = text;
        ask({ ...answers, kind: candidate.kind });
      })));
  }
}
