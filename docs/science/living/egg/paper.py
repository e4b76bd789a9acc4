"""Write the tables of docs/developers/four-hypotheses.md and draw its figures, from the tables of this folder.

Usage: paper.py [--check]. Tables stand below their marks on the page. --check writes nothing, and fails if the page has others.
Reads fits and held-out tests of each round (first-*.csv; second: fits.csv, held-out.csv; third: early-*.csv; compare.py), targets of
hypotheses.toml, criteria of experiments.toml, length.csv and axis.csv (closing.py), jump.csv (jump.py). Figures: docs/images/living/held-out.png, jump.png, trade-off.png.
"""
import csv
import re
import sys
import tomllib
from pathlib import Path

HERE = Path(__file__).resolve().parent
DOCS = HERE.parents[2]
sys.path[:0] = [str(HERE.parent), str(DOCS / "pictures")]
from drawing import few_colours  # noqa: E402
from style import APICAL, BASAL, FORCE, LATERAL, LETTERS, TEXT, VITELLINE, plt  # noqa: E402

AGREES = "#b7dfc9"
PAGE = DOCS / "developers/four-hypotheses.md"
ROUNDS = {"first": "first-", "second": "", "third": "early-"}
TITLES = {"autonomous": "autonomous", "cables": "cables", "push": "push", "feedback": "feedback", "cables-push": "cables + push"}
TARGETS = {  # outcome: (name, format, source)
    "furrow_depth_um@8.9": ("depth at 8.9 min, µm", ".1f", "Guo 2022"),
    "furrow_depth_um@20": ("depth at 20 min, µm", ".1f", "Guo 2022, simulated 61 µm"),
    "height@8.9": ("height of midline cells at 8.9 min, µm", ".1f", "from memory"),
    "flank@20": ("lateral ectoderm, section at 20 min", ".2f", "Guo 2022"),
    "inner.area_ratio@5": ("apical area of inner rows at 5 min", ".2f", "Guo 2022, figure by eye"),
    "inner.area_ratio@9": ("apical area of inner rows at 9 min", ".2f", "Guo 2022, figure by eye"),
    "outer.area_ratio@9": ("apical area of outer rows at 9 min", ".2f", "Guo 2022, figure by eye"),
    "light-5.furrow_depth_um@14": ("light from 5 min: depth at 14 min, µm", ".1f", "our reading: relaxes (Guo 2022)"),
    "light-6.5.furrow_depth_um@11": ("light from 6.5 min: depth at 11 min, µm", ".1f", "our reading: pauses (Guo 2022)"),
    "light-8.furrow_depth_um@14": ("light from 8 min: depth at 14 min, µm", ".1f", "our reading: continues (Guo 2022)"),
    "light-8.furrow_depth_um@11": ("light from 8 min: depth at 11 min, µm", ".1f", "our reading: continues (Guo 2022)"),
}
OUTCOMES = {  # (experiment, outcome): (name, observed, source)
    ("no-snail", "flanks-move"): ("no *sna*: lateral ectoderm moves, µm", "moves ventrally", "Guo 2022"),
    ("no-snail", "no-furrow"): ("no *sna*: depth, µm", "no furrow", "Guo 2022"),
    ("wound", "elongation"): ("wound: length over width, relative", "opens along the axis", "Martin 2010, memory"),
    ("rounder", "elongation"): ("rounder embryo: length over width, × reference", "about 1", "Chanet 2017, not read"),
    ("cut-out", "middle"): ("apical cuts in front and behind: relative depth", "as without, 10 of 10", "Gracia 2019"),
    ("walls-cut", "middle"): ("lateral faces of the middle cut: relative depth", "slight delay, n = 12", "Gracia 2019"),
    ("uniform", "curvature"): ("uniform myosin: curvature of the middle, relative", "flat", "Heer 2017, abstract"),
    ("block", "rest"): ("middle blocked: relative depth beside it", "all stops", "Guglielmi 2015, abstract"),
    ("back", "elongation"): ("dorsal myosin: length over width, × reference", "about 1", "Rich 2020"),
    ("reference", "depth"): ("depth at 20 min, µm", "about 60", "Guo 2022"),
    ("reference", "closing"): ("closure, min", "16–20", "derived here"),
    ("reference", "elongation"): ("length over width at 9 min, × reference", "about 1.5", "Martin 2010, memory"),
    ("reference", "flanks-move"): ("lateral ectoderm moves, µm", "moves ventrally", "Guo 2022"),
    ("floor-kept", "depth"): ("basal cortex kept stiff: relative depth", "no fold", "Krueger 2018, memory"),
}
LENGTH = {
    "egg": "none", "bricks": "hexagonal cells in staggered rows on the ventral side", "shape": "the same cells on the shape of the measured embryo",
    "graded": "*graded*: Gaussian of 15° that fades from 90 to 220 µm", "twi": "*twi*: tension by *twi* where *sna* is expressed",
    "twi-profile": "tension by *twi* in the egg's own 18 rows", "graded-fibres": "*graded*, tension along the axis × 2",
    "short-fibres": "*short*: fades from 50 to 150 µm, tension along the axis × 2",
}
AXIS = {
    "egg": "none", "tension-along": "tension along the axis × 2", "tension-across": "tension across × 2", "walls": "passive tension of lateral faces × 4",
    "walls-stiff": "lateral faces × 10 as stiff", "apical-stiff": "passive apical cortex × 4 as stiff", "basal-soft": "basal cortex a quarter as stiff",
    "stiff": "interiors of 50 Pa", "uniform": "uniform tension across", "wide": "Gaussian of 6 cells", "drag": "a quarter of the drag",
    "drag-fibres": "a quarter of the drag, tension along × 2", "no-membrane": "no vitelline membrane", "short": "*short*: tension fades from 50 to 150 µm",
    "short-wide": "*short*, Gaussian of 6 cells", "short-fibres": "*short*, tension along × 2",
}


def rows_of(name):
    path = HERE / name
    return list(csv.DictReader(path.open())) if path.exists() else []


def plan(name):
    return tomllib.loads((HERE / name).read_text())


def minus(text):
    return text.replace("-", "−") if re.match(r"-\d", text) else text


def table(columns, rows):
    """Lines of a table in Markdown."""
    return ["| " + " | ".join(row) + " |" for row in (columns, ["---"] * len(columns), *rows)]


def fits():
    """Round and row of each hypothesis' last fit."""
    return {name: last for name in TITLES
            for last in [[(which, row) for which, prefix in ROUNDS.items() for row in rows_of(prefix + "fits.csv") if row["hypothesis"] == name][-1]]}


def held_out():
    """Numbers and judgements of each hypothesis' last set: its round, and by experiment and outcome."""
    found = {}
    for which, prefix in ROUNDS.items():
        rows = rows_of(prefix + "held-out.csv")
        for name in TITLES:
            if rows and name in rows[0]:
                found[name] = which, {(row["experiment"], row["outcome"]): (float(row[name]), row[name + "_judgement"]) for row in rows}
    return found


def fits_table():
    targets = {}
    for one in plan("hypotheses.toml")["target"]:
        for target in (one, one | one.get("early", {})):
            light = f"light-{target['light_min']:g}." if "light_min" in target else ""
            targets[f"{light}{target['outcome']}@{target['at_min']:g}"] = f"{target['value']:g} ± {target['sd']:g}"
    last = fits()
    rows = [[name, f"`{outcome}`", targets[outcome], source, *(format(float(row[outcome]), form) if row.get(outcome) else "" for _, row in last.values())]
            for outcome, (name, form, source) in TARGETS.items() if any(row.get(outcome) for _, row in last.values())]
    return table(["outcome of the last set", "column", "target", "source", *(f"*{TITLES[name]}* ({which})" for name, (which, _) in last.items())], rows)


def rounds_table():
    rows = []
    for which, prefix in ROUNDS.items():
        for row in rows_of(prefix + "fits.csv"):
            converged = {"True": "converged", "False": "not converged"}.get(row.get("converged", ""), "stopped")
            rows.append([which, f"*{TITLES[row['hypothesis']]}*", row["misfit"], row["prior"], row["log_det"], minus(row["log_evidence"]),
                         f"{row['keys']}; {row['keys_used']}", row.get("promised", ""), row["runs"], converged])
    return table(["round", "hypothesis", "misfit", "prior's misfit", "log determinant", "**log evidence**", "keys; used by the data", "promised at the end",
                  "runs", "fit"], rows)


def role_of(tests, key):
    return tests[key[0]]["outcome"][key[1]].get("role", tests[key[0]].get("role", "held out"))


def limits(outcome):
    low, high = outcome["hit"]
    if low == -float("inf"):
        return f"{minus(f'{high:g}')} or less"
    return f"{low:g} or more" if high == float("inf") else f"{low:g} to {high:g}"


def shown(key, number, judgement):
    """A number, in bold if it agrees, in italics if it is inconclusive."""
    text = minus(f"{number / 60:.1f}" if key[1] == "closing" else f"{number:.2f}" if abs(number) < 1 else f"{number:.1f}")
    return {"hit": f"**{text}**", "undecided": f"*{text}*", "miss": text}[judgement]


def outcomes_table(is_test):
    tests, sets = plan("experiments.toml")["experiment"], held_out()
    rows = []
    for key, (name, observed, source) in OUTCOMES.items():
        outcome = tests[key[0]]["outcome"][key[1]]
        if (role_of(tests, key) == "held out") == is_test:
            scaled = {"hit": [end / 60 for end in outcome["hit"]]} if key[1] == "closing" else outcome
            rows.append([name, f"`{'.'.join(key)}`", f"{observed} ({source})", limits(scaled), *(shown(key, *found[key]) for _, found in sets.values())])
    if is_test:
        counts = [sum(found[key][1] == "hit" for key in OUTCOMES if role_of(tests, key) == "held out") for _, found in sets.values()]
        rows.append([f"**agree, of {len(rows)}**", "", "", "", *(f"**{count}**" for count in counts)])
    return table(["outcome", "experiment", "observed", "agrees if", *(f"*{TITLES[name]}* ({which})" for name, (which, _) in sets.items())], rows)


def length_table():
    found = {row["variation"]: row for row in rows_of("length.csv")}
    rows = [[name, f"`{key}`", f"{float(row['closed@18']):.2f}; {float(row['closed@20']):.2f}", row["closed_min"] or "not in the middle",
             f"{float(row['depth@20']):.0f}", f"{float(row['elongation@9']):.1f}"] for key, name in LENGTH.items() for row in [found[key]]]
    return table(["variation", "name", "closed at 18; 20 min", "closure, min", "depth at 20 min, µm", "elongation at 9 min"], rows)


def axis_table():
    found = {row["variation"]: row for row in rows_of("axis.csv")}
    columns = ["elongation@9", "area@9", "length@9, 0 to 75 µm", "length@9, 125 to 200 µm", "depth@9"]
    forms = [".1f", ".2f", ".2f", ".2f", ".0f"]
    rows = [[name, f"`{key}`", *(format(float(found[key][column]), form) for column, form in zip(columns, forms))] for key, name in AXIS.items()]
    return table(["variation, at 9 min", "name", "elongation", "area", "length up to 75 µm", "length at 125–200 µm", "depth, µm"], rows)


TABLES = {"fits": fits_table, "rounds": rounds_table, "held-out": lambda: outcomes_table(True), "seen": lambda: outcomes_table(False),
          "length": length_table, "axis": axis_table}


def page():
    """The page with its tables written again."""
    text = PAGE.read_text()
    for name, rows in TABLES.items():
        text, count = re.subn(rf"(<!-- paper.py: {name} -->\n)(?:\|.*\n)*", lambda found: found[1] + "\n".join(rows()) + "\n", text)
        if count != 1:
            sys.exit(f"{PAGE}: {count} marks of the table {name}")
    return text


def draw_held_out(colours):
    """Held-out outcomes of each hypothesis' last set, a panel each, with the range that agrees."""
    tests, sets = plan("experiments.toml")["experiment"], held_out()
    keys = [key for key in OUTCOMES if role_of(tests, key) == "held out"]
    figure, panels = plt.subplots(len(keys), 1, figsize=(760 / 72, 780 / 72))
    figure.subplots_adjust(left=0.42, right=0.97, top=0.93, bottom=0.06, hspace=1.2)
    for key, panel in zip(keys, panels):
        hit, numbers = tests[key[0]]["outcome"][key[1]]["hit"], [found[key][0] for _, found in sets.values()]
        ends = numbers + [end for end in hit if abs(end) < float("inf")]
        margin = 0.12 * (max(ends) - min(ends))
        low, high = min(ends) - margin, max(ends) + margin
        panel.axvspan(max(hit[0], low), min(hit[1], high), color=AGREES, lw=0)
        for place, (name, number) in enumerate(zip(sets, numbers)):
            panel.plot(number, 0.8 - 0.4 * place, "o", color=colours[name], markersize=8, label=TITLES[name] if key == keys[0] else None)
        panel.set(xlim=(low, high), ylim=(-1.2, 1.2), yticks=[])
        panel.tick_params(labelsize=LETTERS - 3)
        panel.locator_params(axis="x", nbins=5)
        for text, y, colour in zip(OUTCOMES[key][0].replace("*", "").split(": "), (0.5, -0.7), (TEXT, VITELLINE)):
            panel.text(-0.02, y, text, color=colour, ha="right", va="center", transform=panel.get_yaxis_transform(), fontsize=LETTERS - 2)
        panel.spines[["left", "right", "top"]].set_visible(False)
    figure.legend(loc="upper right", ncols=5, frameon=False, handletextpad=0, columnspacing=0.8, fontsize=LETTERS - 2, borderpad=0)
    return figure


def draw_trade_off():
    """Elongation of apices and closed length of the variations of the egg."""
    figure, axes = plt.subplots(figsize=(760 / 72, 430 / 72))
    figure.subplots_adjust(left=0.1, right=0.98, top=0.97, bottom=0.16)
    axes.add_patch(plt.Rectangle((1.3, 0.7), 0.4, 0.3, color=AGREES, lw=0))
    axes.text(1.5, 0.85, "required", ha="center", va="center")
    for row in rows_of("length.csv"):
        if row["variation"] != "twi-profile":  # as twi
            place = float(row["elongation@9"]), float(row["closed@20"])
            axes.plot(*place, "o", color=BASAL, markersize=9)
            axes.annotate({"egg": "none"}.get(row["variation"], row["variation"].replace("-", " + ")), place, (9, 9 if row["variation"] == "shape" else -9),
                          textcoords="offset points", fontsize=LETTERS - 2)
    axes.set(xlim=(1.2, 2.8), ylim=(0, 1), xlabel="apical length over width at 9 min, × reference", ylabel="closed length at 20 min")
    return figure


def draw_jump():
    """Depth under light of two sets that differ little."""
    rows = rows_of("jump.csv")
    minutes = [float(row["minute"]) for row in rows]
    figure, axes = plt.subplots(figsize=(760 / 72, 400 / 72))
    figure.subplots_adjust(left=0.1, right=0.98, top=0.97, bottom=0.17)
    for name, colour in (("before", BASAL), ("after", APICAL)):
        axes.plot(minutes, [float(row[name]) for row in rows], "o-", color=colour, label=f"{name} the step")
    for target in (one for one in plan("hypotheses.toml")["target"] if one.get("light_min") == 8):
        for one, title in ((target, "target, rounds 1 and 2"), (target | target["early"], "target, round 3")):
            axes.errorbar(one["at_min"], one["value"], one["sd"], fmt="s", color=TEXT, capsize=5, fillstyle="none" if one is target else "full", label=title)
    axes.legend(frameon=False, loc="upper left")
    axes.set(xlabel="time, min", ylabel="depth, µm", ylim=(0, None))
    return figure


def draw():
    """Draw the figures."""
    colours = dict(zip(TITLES, (TEXT, APICAL, BASAL, LATERAL, FORCE)))
    for name, figure in (("held-out", draw_held_out(colours)), ("trade-off", draw_trade_off()), ("jump", draw_jump())):
        path = DOCS / f"images/living/{name}.png"
        figure.savefig(path, dpi=144)
        few_colours(path)


if __name__ == "__main__":
    written = page()
    if "--check" in sys.argv[1:]:
        sys.exit(0 if written == PAGE.read_text() else f"{PAGE}: its tables are not those of the results; run paper.py")
    PAGE.write_text(written)
    draw()
