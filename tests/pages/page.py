"""Runs a page of the documentation: every block as it stands, in order, in a fresh folder.

The language of a block says what is done with it:
- ```sh is run, all of a page in one shell that stops at the first failure; ```python is run by Debian's Python;
- ```toml is written to NAME.toml if its first line is "# NAME.toml"; any other is only read;
- ```text, or "output" after another language, is what the block before prints: each line stands among the printed ones,
  in their order, with the same words, and numbers within 1 %. There … stands for anything, and ... for any lines.

Notebooks (docs/notebooks) are for docs/build --run-notebooks.

Comments of the page change that. On the line before a block: <!-- not run: REASON -->, or <!-- slow: REASON --> for one
that is run only when asked. Anywhere: <!-- run first: COMMAND -->, for what another page or ./demo has left.
"""
import os
import re
import shutil
import subprocess
import tomllib
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
BLOCK = re.compile(r"^<!-- run first: (?P<first>.+?) -->$|"
                   r"^(?:<!-- (?P<mark>not run|slow): (?P<reason>.+?) -->\n)?```(?P<kind>.*)\n(?P<text>(?s:.*?))^```$",
                   re.M)
NUMBER = r"[-+]?\d+(?:\.\d+)?(?:e[-+]?\d+)?"
SEPARATOR = "==== block of the page: "
# | what | 28.9 µm | `furrow_depth_um` |, or 0.74 to 0.78.
STATED = re.compile(r"^\|[^|]+\| (?P<least>-?[\d.]+)(?: to (?P<most>-?[\d.]+))?(?: (?P<unit>\S+))? \| `(?P<key>\w+)` \|$", re.M)


# A heading that begins with a scenario's name: ## `drosophila-paper`.
SCENARIO = re.compile(r"^##? `(?P<name>[\w-]+)`", re.M)


class PageError(Exception):
    """What is wrong with the page, in a sentence."""


def scenario_sections(text):
    """Sections of a page about scenarios, by name: each from its heading to the next scenario's."""
    headings = list(SCENARIO.finditer(text))
    ends = [heading.start() for heading in headings[1:]] + [len(text)]
    return {heading["name"]: text[heading.start():end] for heading, end in zip(headings, ends)}


def mark_of_run(name, section):
    """The mark of the block that runs the scenario into results/NAME: "", "slow" or "not run"; PageError without one."""
    command = f"plica run {name} --out results/{name}\n"
    for block in BLOCK.finditer(section):
        if block["kind"] == "sh" and command in block["text"]:
            return block["mark"] or ""
    raise PageError(f"does not show the command: {command.strip()}")


def stated_numbers(text):
    """Values of keys of summary.json in a page's tables: (least, most) of each, minutes as seconds."""
    stated = {}
    for row in STATED.finditer(text):
        unit = 60 if row["unit"] == "min" else 1
        stated[row["key"]] = (float(row["least"]) * unit, float(row["most"] or row["least"]) * unit)
    return stated


def prepare(place, program):
    """Lays out the folder that a reader is in. Pages may change docs/, which is a copy."""
    (place / "build").mkdir(parents=True, exist_ok=True)
    (place / "build/release").symlink_to(program.resolve().parent)
    shutil.copytree(ROOT / "docs", place / "docs")
    shutil.copytree(ROOT / "tools", place / "tools")  # they write into the docs beside them
    for name in ("bench", "scenarios", "src", "tests"):
        (place / name).symlink_to(ROOT / name)


def same_line(shown, printed):
    """Whether the line says the same, but for numbers that differ by less than 1 %."""
    pieces = [piece for piece in re.split(rf"(…|\s+|{NUMBER})", shown.strip()) if piece]
    pattern = "".join(".*" if piece == "…" else r"\s+" if piece.isspace() else
                      f"({NUMBER})" if re.fullmatch(NUMBER, piece) else re.escape(piece) for piece in pieces)
    found = re.fullmatch(pattern, printed.strip())
    expected = re.findall(NUMBER, shown)
    return bool(found) and all(abs(float(a) - float(b)) <= 0.01 * abs(float(b)) for a, b in zip(found.groups(), expected))


def check_output(shown, printed):
    """Each shown line is found below the one before it."""
    lines = iter(printed.splitlines())
    for line in shown.splitlines():
        if line.strip() and line.strip() != "..." and not any(same_line(line, other) for other in lines):
            raise PageError(f"shows a line that is not printed (any more, or not there): {line.strip()}\n"
                            f"printed was:\n{printed}")


def script_of(blocks, place, with_slow):
    """The commands of all blocks, each after a line with its number; files are written."""
    script = "set -e\nset -o pipefail\n"
    run = 0
    for number, block in enumerate(blocks):
        kind, text = block["kind"], block["text"]
        if block["first"]:
            kind, text = "sh", block["first"] + "\n"
        elif block["mark"] == "not run" or (block["mark"] == "slow" and not with_slow):
            print(f"Not run: {block['reason']}")
            continue
        if kind in ("sh", "python"):
            run += 1
            script += f"echo '{SEPARATOR}{number}'\n"
        if kind == "sh":
            script += re.sub(r"\| head -(\d+)", r"| sed -n 1,\1p", text)  # `head` ends what writes to it: a failure
        elif kind == "python":
            (place / f"block{number}.py").write_text(text, encoding="utf-8")
            script += f"/usr/bin/python3 block{number}.py\n"
        elif kind == "toml":
            try:
                tomllib.loads(text)
            except tomllib.TOMLDecodeError as error:
                raise PageError(f"has TOML that cannot be read: {error}") from error
            name = re.match(r"# (\S+\.toml)\n", text)
            if name:
                (place / name.group(1)).write_text(text, encoding="utf-8")
        elif kind != "text" and not kind.endswith(" output"):
            raise PageError(f"has a block of an unknown kind, ```{kind}: {text[:60]}")
    return script, run


def run_page(page, program, place, with_slow=False):
    """Runs a page's blocks in a folder that is not there yet or empty. Returns how many; PageError where one fails."""
    if page.resolve().parent.name == "notebooks":
        raise PageError("is a notebook: docs/build --run-notebooks runs it")
    blocks = [found.groupdict() for found in BLOCK.finditer(page.read_text(encoding="utf-8"))]
    fences = len(re.findall(r"^```", page.read_text(encoding="utf-8"), re.M))
    if fences != 2 * sum(block["kind"] is not None for block in blocks):
        raise PageError("has a block that is not closed, or whose fence is indented")
    prepare(place, program)
    script, run = script_of(blocks, place, with_slow)
    environment = dict(os.environ, MPLBACKEND="Agg", MPLCONFIGDIR=str(place / "build"), OMP_NUM_THREADS="1",
                       PATH=f"{program.resolve().parent}:{os.environ['PATH']}")
    result = subprocess.run(["bash", "-c", script], cwd=place, env=environment, text=True, stdin=subprocess.DEVNULL,
                            stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)
    print(result.stdout)
    if result.returncode != 0:
        raise PageError("has a command that fails: the last one above")
    printed = {}
    for part in result.stdout.split(SEPARATOR)[1:]:
        number, _, output = part.partition("\n")
        printed[int(number)] = output
    source = None  # of the output that is shown: the last block that was run
    for number, block in enumerate(blocks):
        kind = block["kind"] or ""
        if kind in ("sh", "python"):
            source = printed.get(number)
        elif (kind == "text" or kind.endswith(" output")) and source is not None and not block["mark"]:
            check_output(block["text"], source)
    return run
