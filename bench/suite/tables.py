"""What was measured, as tables in Markdown."""
import math
from pathlib import Path

BEGIN, END = "<!-- Below: the output of bench/run. -->\n", "<!-- Above: the output of bench/run. -->\n"
DOCUMENT = "docs/developers/performance-benchmarks.md"  # has the tables between these marks


def number(value, digits=3):
    """Three digits that count; spaces between thousands."""
    if value is None:
        return "–"
    if isinstance(value, int) or value >= 100:
        return f"{round(value):,}".replace(",", " ")
    return f"{value:.{digits}g}"


def seconds(value):
    if value is None:
        return "–"
    for unit, size in (("s", 1), ("ms", 1e-3), ("µs", 1e-6)):
        if value >= size:
            return f"{number(value / size)} {unit}"
    return f"{number(value / 1e-9)} ns"


def table(header, rows):
    lines = [header, ["---"] * len(header), *rows]
    return "".join("| " + " | ".join(map(str, line)) + " |\n" for line in lines) + "\n"


def machine_text(machine, arguments):
    return (f"`bench/run{arguments}`, {machine['date']}: {machine['cpu']}, {machine['cores']} cores, load {machine['load']:.1f} "
            f"when it began; {machine['program']}.\n\n")


def kernels_text(results):
    """A share: the time that the nearer ceiling would take over the time taken."""
    text = ""
    done = [result for result in results if "failed" not in result]
    if done:
        rows = [[number(r["elements"]), r["threads"], f"{r['multiply_add_rate'] / 1e9:.1f}", f"{r['reading_rate'] / 1e9:.1f}"]
                for r in done]
        text += "Rates of this machine, measured between the rounds of the kernels:\n\n"
        text += table(["elements", "threads", "multiply-adds, GFlop/s", "reading as many bytes, GB/s"], rows)
        rows = [[k["kernel"], number(r["elements"]), r["threads"], f"{k['ns_per_element']:.3g}",
                 f"{100 * k['share']:.0f} % of {k['ceiling']}", number(k.get("yardsticks"))]
                for r in done for k in r["kernels"]]
        rows.sort(key=lambda row: row[0])
        text += table(["kernel", "elements", "threads", "ns per element", "share of the nearer ceiling", "yardsticks"], rows)
    return text + failures(results)


def steps_text(results):
    done = [result for result in results if "failed" not in result]
    rows = [[number(r["elements"]), r["embryo"], r["threads"], seconds(r["model_s"]), seconds(r["step_s"]), speed_up(r, done),
             number(1e6 * r["step_s"] / r["elements"]), r["newton_iterations"], r["linear_iterations"], r["factorisations"],
             number(round(r["peak_MiB"])), number(r.get("instructions"))] for r in done]
    header = ["elements", "embryo", "threads", "model built in", "first step", "speed-up", "µs per element",
              "Newton iterations", "linear iterations", "factorisations", "peak memory, MiB", "instructions"]
    notes = growth_text(done) + threads_text(done)
    return drop_empty(table, header, rows) + notes + ("\n" if notes else "") + failures(results)


def on_one_thread(result, done):
    return next((r for r in done if r["embryo"] == result["embryo"] and r["threads"] == 1), None)


def speed_up(result, done):
    """How many times as fast as on one thread."""
    one = on_one_thread(result, done)
    return "–" if one in (None, result) else f"{one['step_s'] / result['step_s']:.2f}"


def growth_text(done, small=10_000, large=200_000):
    """Whether the cost grows with the number of elements: an element's on the large mesh over one's on the small."""
    text = ""
    for refined_by in ("more elements per cell", "more cells"):
        alike = [r for r in done if r["threads"] == 1 and r["refined_by"] == refined_by]
        ends = [min(alike, key=lambda r: abs(math.log(r["elements"] / size)), default=None) for size in (small, large)]
        if None in ends or not all(0.5 < r["elements"] / size < 2 for r, size in zip(ends, (small, large))):
            continue
        ratio = (ends[1]["step_s"] / ends[1]["elements"]) / (ends[0]["step_s"] / ends[0]["elements"])
        text += (f"- {refined_by.capitalize()}: the time per element is {ratio:.2f} times as long with "
                 f"{number(ends[1]['elements'])} elements as with {number(ends[0]['elements'])}, on one thread.\n")
    return text


def threads_text(done):
    """Whether positions depend on the number of threads."""
    pairs = [(r, on_one_thread(r, done)) for r in done if r["threads"] > 1]
    pairs = [(many, one) for many, one in pairs if one is not None]
    differing = [f"{many['embryo']}, {many['threads']} threads" for many, one in pairs if many["checksum"] != one["checksum"]]
    if differing:
        return f"- **Positions differ from those of one thread: {'; '.join(differing)}.**\n"
    return "- Positions after the step are identical for every number of threads.\n" if pairs else ""


def runs_text(results):
    rows = []
    for r in results:
        if "failed" in r:
            continue
        rows.append([number(r["elements"]), r["embryo"], r["threads"], seconds(r["process_s"]), seconds(r["solver_s"]),
                     r["steps"], r["newton_iterations"], r["linear_iterations"], number(round(r["process_peak_MiB"])),
                     number(r.get("instructions"))])
    header = ["elements", "embryo", "threads", "start to end", "solver", "steps", "Newton iterations", "linear iterations",
              "peak memory, MiB", "instructions"]
    return drop_empty(table, header, rows) + failures(results)


def furrows_text(results):
    rows = [[r["embryo"], number(r["cells"]), r["threads"], seconds(r["process_s"]), seconds(r["solver_s"]), r["steps"],
             r["refused_steps"], number(r["newton_iterations"]), number(r["linear_iterations"]),
             number(round(r["process_peak_MiB"]))] for r in results if "failed" not in r]
    header = ["scenario", "cells", "threads", "start to end", "solver", "steps", "refused", "Newton iterations",
              "linear iterations", "peak memory, MiB"]
    return table(header, rows) + failures(results)


def drop_empty(make, header, rows):
    """The table without columns in which nothing was measured."""
    kept = [i for i in range(len(header)) if any(row[i] != "–" for row in rows)]
    return make([header[i] for i in kept], [[row[i] for i in kept] for row in rows])


def failures(results):
    lines = [f"- Not measured: {r['what']}, {r['embryo']}, {r['threads']} threads: {r['failed']}.\n"
             for r in results if "failed" in r]
    return "".join(lines) + ("\n" if lines else "")


TEXTS = {"runs": ("The whole Drosophila run", runs_text), "furrows": ("Furrows that close, and embryos of polygons", furrows_text),
         "steps": ("One step", steps_text), "kernels": ("Kernels", kernels_text)}


def page(measured, arguments):
    text = machine_text(measured["machine"], arguments)
    for part, (heading, text_of) in TEXTS.items():
        if measured[part]:
            text += f"### {heading}\n\n" + text_of(measured[part])
    return text


def update(root, measured, arguments):
    """The document gets the tables, unless nothing was measured."""
    if any(measured[part] for part in TEXTS):
        put_into(Path(root) / DOCUMENT, page(measured, arguments))


def put_into(document, text):
    """Replaces what stands between the two marks of the document."""
    document = Path(document)
    before = document.read_text(encoding="utf-8")
    if BEGIN not in before or END not in before:
        raise ValueError(f"{document} lacks the marks between which the tables stand")
    head, rest = before.split(BEGIN, 1)
    document.write_text(head + BEGIN + "\n" + text + END + rest.split(END, 1)[1], encoding="utf-8")
