#!/usr/bin/python3
"""The benchmark suite, run briefly: it measures everything that it says and tells it in tables. Nothing is timed.

Usage: bench_test.py ROOT BUILD
"""
import importlib.machinery
import importlib.util
import json
import subprocess
import sys
import tempfile
from pathlib import Path

root, build = Path(sys.argv[1]), Path(sys.argv[2])
sys.path.insert(0, str(root / "bench"))
from suite import sizes, tables  # noqa: E402


def bench(*arguments):
    return subprocess.run([sys.executable, root / "bench/run", *map(str, arguments)], capture_output=True, text=True)


# Two commits: ratios of medians beside what is required, and failures told.
loader = importlib.machinery.SourceFileLoader("speed", str(root / "bench/speed"))
speed = importlib.util.module_from_spec(importlib.util.spec_from_loader("speed", loader))
sys.modules["speed"] = speed
sys.dont_write_bytecode = True
loader.exec_module(speed)
work = speed.Work("some", "drosophila", must=0.5, aim=0.3)
old, new = sides = [speed.Side(commit, Path("/nowhere")) for commit in ("old", "new")]
for side, times in zip(sides, ([9, 2, 4], [1, 3, 1])):
    side.runs["some"] = [{"process_cpu_s": cpu_s, "instructions": 100 * cpu_s, "steps": 5, "refused_steps": 1} for cpu_s in times]
text, wrong = speed.page([work], old, new)
assert "| some | 4 | 1 | 0.25 | 0.5 | 0.3 |" in text and "| some | 400 | 100 | 0.25 |" in text and not wrong, text
assert "| some | old | – | 5 | 1 |" in text and "| refused steps of some, % | 20 | 20 | – | – |" in text, text
whole = speed.Side("any", Path("/nowhere"))
for each in speed.FULL:
    whole.runs[each.name] = [{"process_cpu_s": 1, "steps": 1, "refused_steps": 1}]
assert set(speed.FIGURE_LIMITS) <= {name for name, *_ in speed.figures(speed.FULL, whole, whole)}, "limits of nothing"
text, wrong = speed.page([work], new, old)
assert wrong == ["some: 4, must be 0.5 or less"] and not speed.page([work], new, old, required=False)[1]
new.runs["some"] = [{"failed": "out of luck"}]
text, wrong = speed.page([work], old, new)
assert "| some | 4 | – | – |" in text and wrong == ["some, new: out of luck"], text

# Embryos of about the sizes asked for.
for size in (756, 10_000, 25_000, 200_000, 1_000_000):
    for embryo in sizes.embryos(size):
        assert abs(embryo.elements / size - 1) < 0.4, (size, embryo, embryo.elements)
assert [embryo.elements for embryo in sizes.embryos(756)] == [756], "once"
assert sizes.by_elements(25_000) == sizes.Embryo(1, 4, 2) and sizes.by_cells(200_000) == sizes.Embryo(16)

with tempfile.TemporaryDirectory() as folder:
    file = Path(folder) / "figures.json"
    done = bench("--brief", "--build", build, "--json", file)
    print(done.stdout, done.stderr)
    assert done.returncode == 0, done.returncode
    figures = json.loads(file.read_text())
    steps, runs, furrows = figures["steps"], figures["runs"], figures["furrows"]
    assert {step["elements"] for step in steps} == {756, 3024} and len(runs) == 1
    assert [furrow["embryo"] for furrow in furrows] == ["`furrow-slice`"] and furrows[0]["lips_closed_time_s"] > 600
    for step in steps:
        assert step["converged"] and step["step_s"] > 0 and step["peak_MiB"] > 1 and step["linear_iterations"] > 0
        same = [other for other in steps if other["embryo"] == step["embryo"]]
        assert {other["checksum"] for other in same} == {step["checksum"]}, "threads change the bits"
    assert runs[0]["status"] == "equilibrium" and 0 < runs[0]["solver_s"] < runs[0]["process_s"]
    for kernels in figures["kernels"]:
        assert kernels["multiply_add_rate"] > 0 and kernels["reading_rate"] > 0 and kernels["kernels"]
        assert all(kernel["ns_per_element"] > 0 and kernel["share"] > 0 for kernel in kernels["kernels"])
    for words in ("### One step", "### The whole Drosophila run", "### Furrows that close", "3 024", "linear iterations"):
        assert words in done.stdout, words
    assert "Positions after the step are identical" in done.stdout and "Positions differ" not in done.stdout

    # Into the document, between the marks and nowhere else, however often.
    page = Path(folder) / "page.md"
    page.write_text(f"before\n{tables.BEGIN}old\n{tables.END}after\n")
    for _ in range(2):
        tables.put_into(page, tables.page(figures, " --brief"))
    text = page.read_text()
    assert text.startswith("before\n") and text.endswith("after\n") and "old" not in text and text.count("### One step") == 1
    # The document has the tables, and keeps them when nothing is measured.
    copy = Path(folder) / tables.DOCUMENT
    copy.parent.mkdir(parents=True, exist_ok=True)
    copy.write_text((root / tables.DOCUMENT).read_text())  # which must have the marks
    tables.update(folder, figures, " --brief")
    results = copy.read_text()
    assert "### One step" in results and "### The whole Drosophila run" in results
    assert "### Kernels" in results or not figures["kernels"]
    tables.update(folder, figures | {"steps": [], "runs": [], "kernels": [], "furrows": []}, " --only nothing")
    assert results == copy.read_text()
    # How the cost grows, what more threads gain, and whether they change anything.
    grown = [steps[0] | {"elements": 756 * k * k, "step_s": 0.001 * k**3, "embryo": f"{k}", "refined_by": "more cells"} for k in (4, 16)]
    text = tables.page(figures | {"steps": grown}, "")
    assert "- More cells: the time per element is 4.00 times as long with 193 536 elements as with 12 096, on one thread." in text, text
    two = grown[0] | {"threads": 2, "step_s": grown[0]["step_s"] / 1.6, "checksum": "another"}
    text = tables.page(figures | {"steps": [grown[0], two]}, "")
    assert "| 1.60 |" in text and "Positions differ from those of one thread: 4, 2 threads." in text, text
    # Kernels, and what could not be measured.
    example = {"elements": 756, "threads": 1, "multiply_add_rate": 7e10, "reading_rate": 2e10, "embryo": "the paper's",
               "kernels": [{"kernel": "tangent product", "ns_per_element": 21.5, "ceiling": "arithmetic", "share": 0.65}]}
    lost = {"what": "step", "embryo": "36 times as long", "threads": 1, "failed": "more than 3600 s"}
    text = tables.page(figures | {"kernels": [example], "steps": [lost]}, "")
    assert "| tangent product | 756 | 1 | 21.5 | 65 % of arithmetic | – |" in text, text
    assert "- Not measured: step, 36 times as long, 1 threads: more than 3600 s." in text

    # What is missing is said.
    refused = bench("--brief", "--build", folder)
    assert refused.returncode == 1 and "is missing; build it: cmake --preset release" in refused.stderr, refused.stderr
refused = bench("--sizes", "3")
assert refused.returncode == 2 and "756" in refused.stderr
late = bench("--only", "steps", "--sizes", "756", "--threads", "1", "--timeout", "0.001", "--build", build)
assert late.returncode == 1 and "Not measured: step, the paper's, 1 threads: more than 0.001 s" in late.stdout, late.stdout
print("Benchmark suite: 4 runs")
