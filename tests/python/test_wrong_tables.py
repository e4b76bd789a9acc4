"""Wrong keys of the tables of tissues that change: each ends in one message with file, line, key and a remedy, and the scenario
is good once the remedy is applied: by this test where it can read the message, else as wrong_tables.txt says."""
import re
from collections import Counter
from pathlib import Path

import pytest

import plica

SHEET = {"embryo": {"shape": '"sheet"', "length_um": "20", "width_um": "20", "cell_count": "16", "cell_height_um": "8"},
         "elasticity": {"model": '"neo-hookean"'}, "exchange": {"below_um": "0.35"}}
MESSAGE = re.compile(r"(?P<file>[^:\n]+):(?P<line>\d+)?:? (?P<key>[^:\s]+): (?P<problem>.+?); (?P<remedy>.+)")
NUMBER = re.compile(r"set (\w+)(?: or \w+)? to .*?(?:a number|an integer)(?: >=? ([\d.]+)|, [\d.]+ to ([\d.]+))?(?: or .*)?$")


def parts_of(text):
    """Split at ";" outside quotes."""
    return [part.strip() for part in re.split(r";\s*(?=(?:[^\"]*\"[^\"]*\")*[^\"]*$)", text) if part.strip()]


def changed(tables, table, changes):
    """Return tables with keys set or taken away."""
    result = {name: dict(keys) for name, keys in tables.items()}
    for change in changes:
        is_gone, change = change.startswith("-"), change.removeprefix("-")
        where, change = change[1:].split("].", 1) if change.startswith("[") else (table, change)
        key, _, value = change.partition(" = ")
        if is_gone:
            result[where] = {k: v for k, v in result[where].items() if k != key and not k.startswith(key + ".")}
        else:
            result.setdefault(where, {})[key] = value
    return {name: keys for name, keys in result.items() if keys}


def written(tables):
    """Return the file's text, and the lines of keys and headers."""
    lines, places = ["format = 1"], {}
    for name, keys in tables.items():
        lines.append(f"[{name}]")
        places[name] = len(lines)
        for key, value in keys.items():
            lines.append(f"{key} = {value}")
            places[f"{name}.{key}"] = len(lines)
    return "\n".join(lines) + "\n", places


def messages(path, text):
    path.write_text(text)
    try:
        plica.Simulation(plica.Scenario(path), threads=1)
    except plica.ScenarioError as error:
        return str(error).splitlines()
    return []


def renamed(tables, table, old, new):
    """Return tables with another name of a key, or of the table inside it."""
    keys = tables[table]
    found = old if old in keys else next((k for k in keys if k.startswith(old + ".")), None)
    if found is None:  # in an inline table
        outer, _, inner = old.partition(".")
        return changed(tables, table, [f"{outer} = {keys[outer].replace(inner, new.partition('.')[2])}"])
    value = keys[found]
    return changed(changed(tables, table, [f"-{old}"]), table, [f"{new} = {value}"])


def told(tables, key, problem, remedy):
    """Return the tables after what the remedy says, or None if it is not for a machine."""
    table = next((name for name in sorted(tables, key=len, reverse=True) if key == name or key.startswith(name + ".")), None)
    if table is None:
        return None
    own = key.removeprefix(table).removeprefix(".")

    def set_to(value, of=own):
        return changed(changed(tables, table, [f"-{of}"]), table, [f"{of} = {value}"])

    def sibling(name):
        return f"{own.rpartition('.')[0]}.{name}".removeprefix(".")

    if problem.startswith("unknown key"):
        if found := re.match(r'use "([^"]+)"', remedy):
            return renamed(tables, table, own, found[1])
        return changed(tables, table, [f"-{own}"]) if re.match("use one of|move it", remedy) else None
    if found := re.search(r'(?:nearest match: |^use )"([^"]+)"', remedy):
        wrong = re.search(r'"([^"]+)"', problem)[1]
        return set_to(tables[table].get(own, '"' + wrong + '"').replace(wrong, found[1]))
    if found := re.match(r'set (\w+) to one of: (\w[\w-]*)|set (\w+) to "([^"]+)"', remedy):
        return set_to(f'"{found[2] or found[4]}"', sibling(found[1] or found[3]))
    if found := re.match(r"set it to about ([\d.]+) times below_um", remedy):
        return set_to(float(found[1]) * float(tables[table]["below_um"]))
    if found := re.match(r"set (\w+).*(?:for example to|such as) (\{.*\}|[\d.]+)", remedy):
        return set_to(found[2], sibling(found[1]) if found[1] != "it" else own)
    if found := NUMBER.match(remedy):
        key, lowest, highest = found.groups()
        return set_to(highest or int(float(lowest or 0)) + 1, sibling(key))
    if problem.startswith("region") and (found := re.match(r"use one of: (\w+)", remedy)):
        return set_to(f'"{found[1]}"')
    if re.match(r"remove (it|the table|one of them|mirror|direction)\b", remedy):
        return changed(tables, table, [f"-{own}"]) if own else {k: v for k, v in tables.items() if k != table}
    return None


def checked(path, text, places):
    """Return key, problem and remedy of each message, which names the file and a line of the key or of the table around it."""
    found = []
    for line in messages(path, text):
        message = MESSAGE.fullmatch(line)
        assert message and message["file"] == str(path), line
        key = message["key"]
        near = [number for place, number in places.items() if place in key or place.startswith(key.rpartition(".")[0] + ".")]
        assert int(message["line"] or 0) in near, (line, places)
        found.append((key, message["problem"], message["remedy"]))
    return found


def cases():
    table, good, is_case = "", {}, False
    for line in (Path(__file__).parent / "wrong_tables.txt").read_text().splitlines():
        if line.startswith("== "):
            table, good, is_case = line[3:], [], False
        elif line == "--":
            is_case = True
        elif line and not line.startswith("#"):
            if is_case:
                yield pytest.param(table, good, *(line.split(" => ") + [""])[:2], id=f"{table}: {line.split(' => ')[0]}")
            else:
                good.append(line)


@pytest.mark.parametrize("table, good, wrong, cure", cases())
def test_a_wrong_key_has_a_message_whose_remedy_works(tmp_path, table, good, wrong, cure):
    tables = changed(changed(SHEET, table, good), table, parts_of(wrong))
    text, places = written(tables)
    found = checked(tmp_path / "wrong.toml", text, places)
    assert 1 <= len(found) <= 2, found
    if cure:
        tables = changed(tables, table, parts_of(cure))
    for key, problem, remedy in [] if cure else found:
        tables = told(tables, key, problem, remedy) or tables
    assert messages(tmp_path / "cured.toml", written(tables)[0]) == [], found


def test_good_tables_are_good(tmp_path):
    assert [c.values[0] for c in cases() if messages(tmp_path / "good.toml", written(changed(SHEET, *c.values[:2]))[0])] == []


def test_each_table_has_thirty_cases():
    counts = Counter(case.values[0] for case in cases())
    assert len(counts) == 7 and min(counts.values()) >= 30, counts
