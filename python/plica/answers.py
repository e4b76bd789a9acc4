"""Figures of a study: curves over one key and phase diagrams over two; verdict on a furrow."""
from __future__ import annotations

import difflib
import tomllib
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Optional, Union

import numpy as np
from numpy.typing import NDArray

from .arguments import mapping_of, number, text_of, told, whole
from .errors import PlicaError, needed
from .names import label as _label
from .pictures import render
from .results import open_run
from .scenario import Scenario, _items
from .study_table import StudyTable

if TYPE_CHECKING:
    import pandas


__all__ = ["verdict"]

FINISHED = ("equilibrium", "end_time")  # statuses of runs with results
VERDICT_COLUMNS = ("self_intersections", "lips_closed_time_s", "furrow_depth_below_lips_um", "furrow_depth_um")
FURROWED_UM = 1.0  # depth below the lips (docs/reference/measures.md)
DEEP_UM = 15.0  # depth below the reference state: also furrowed, since the lips have invaginated as well
NO_RESULT = ("failed", "refused", "not run", "no verdict")
DRAWN_KINDS = ("sobol", "latin-hypercube", "sobol-indices", "one-at-a-time")  # none has a point for each pair of values
LETTERS = "abcdefghijklmnopqrstuvwxyz"
COLOURS = {"closed": "#009E73", "furrowed": "#0072B2", "flattened": "#F0E442", "passes through itself": "#D55E00",
           "failed": "#555555", "refused": "#999999", "no verdict": "#CCCCCC", "not run": "#E5E5E5", "replicates differ": "#D9D9D9"}
VERDICTS = {"closed": "closed: its lips have met",
            "furrowed": f"furrowed: floor {FURROWED_UM:g} µm or more below its lips,\nor {DEEP_UM:g} µm or more deep",
            "flattened": "flattened: less", "passes through itself": "passes through itself"}
OTHER_COLOURS = ("#56B4E9", "#E69F00", "#CC79A7", "#8C6D31", "#6A51A3", "#31A354", "#843C39", "#17BECF")


def verdict(row: Any) -> str:
    """Classify the result of a run in one word.

    The first word that applies: "not run", "refused" (invalid scenario), "failed", "passes through itself"
    (``self_intersections`` > 0), "closed" (``lips_closed_time_s`` has a value), "no verdict" (neither depth has a value),
    "furrowed" (``furrow_depth_below_lips_um`` >= 1 µm, or ``furrow_depth_um`` >= 15 µm, since the lips may invaginate too),
    "flattened".

    Parameters
    ----------
    row : pandas.Series or mapping
        Row of `Study.table` with these four output variables.

    Returns
    -------
    str

    Raises
    ------
    ValueError
        If an output variable is missing in the row.

    Examples
    --------
    >>> import plica
    >>> plica.verdict({"status": "end_time", "self_intersections": 0, "lips_closed_time_s": None,
    ...                "furrow_depth_below_lips_um": 12.0, "furrow_depth_um": 40.0})
    'furrowed'
    """
    if not hasattr(row, "keys"):
        raise TypeError(f"row: {told(row)}; give a row of Study.table, or a mapping")
    missing = [name for name in (*VERDICT_COLUMNS, "status") if name not in row.keys()]
    if missing:
        raise ValueError(f"a verdict requires {', '.join(missing)}; add it to keep.measures, or colour by an output variable that is kept")
    status = text_of(row["status"], "status")
    if status in ("not_run", "refused"):
        return status.replace("_", " ")
    if status not in FINISHED:
        return "failed"
    intersections, closed_s, below_lips_um, depth_um = (_number(row[name], name) for name in VERDICT_COLUMNS)
    if intersections > 0:
        return "passes through itself"
    if np.isfinite(closed_s):
        return "closed"
    if np.isnan(below_lips_um) and np.isnan(depth_um):
        return "no verdict"
    return "furrowed" if below_lips_um >= FURROWED_UM or depth_um >= DEEP_UM else "flattened"


def curves(study: StudyTable, measure: str) -> Any:
    """Plot an output variable over each key, one panel per key, with the other keys as in the scenario.

    The values of the scenario are marked. Runs without a result are red crosses at the bottom of the panel, which interrupt
    the line. Replicates are dots; the line joins their means.

    Parameters
    ----------
    measure : str
        Column of `table`; the unit in its name labels the axis.

    Returns
    -------
    matplotlib.figure.Figure

    Raises
    ------
    ValueError
        If the study is neither of kind "one-at-a-time" nor has a single key, or has no such output variable.

    Examples
    --------
    >>> import plica
    >>> study = plica.Study({
    ...     "scenario": "division-demo", "set": {"time.end_min": 0.2},
    ...     "vary": {"elasticity.young_modulus_Pa": {"values": [500, 1000]}}, "design": {"kind": "one-at-a-time"},
    ... })
    >>> table = study.run(jobs=1)
    >>> study.curves("furrow_depth_um").savefig("curves.png")  # doctest: +SKIP
    """
    plt = needed("matplotlib.pyplot", "curves")
    one_at_a_time = study.kind == "one-at-a-time"
    if not one_at_a_time and len(study.keys) != 1:
        raise ValueError(f'curves: the study is of kind "{study.kind}" with {len(study.keys)} keys; '
                         'give one of kind "one-at-a-time", or with one key')
    table = study.table
    results, keys = _results(table, measure), study.keys
    first = table.iloc[0]  # kind one-at-a-time: the scenario itself
    own = dict(first[keys]) if one_at_a_time else _own_values(study)
    across = min(3, len(keys))
    down = -(-len(keys) // across)
    figure, axes = plt.subplots(down, across, sharey=True, squeeze=False, layout="constrained",
                                figsize=(0.6 + 3.4 * across, 0.7 + 2.9 * down))
    for spare in axes.flat[len(keys):]:
        spare.remove()
    for key, ax in zip(keys, axes.flat):
        others = [other for other in keys if other != key]
        on_curve = (table[others] == list(first[others])).all(axis=1)
        _curve(ax, table.loc[on_curve, key], results[on_curve], own.get(key))
        if study._given.get(f"vary.{key}.scale") == "log":
            _set_log(ax.xaxis)
        if table.replicate.nunique() > 1:
            _mark_replicates(ax, table.loc[on_curve, key], results[on_curve])
        ax.set_xlabel(_axis_label(study, key))
    for ax in axes[:, 0]:
        ax.set_ylabel(_label(measure))
    _legend_below(figure, axes.flat[: len(keys)])
    return figure


def _curve(ax: Any, values: pandas.Series[Any], results: pandas.Series[float], own: Any) -> None:
    is_number, (x, words) = _is_number(values), _places(values)
    means = results.groupby(x).mean()  # sorted; a missing value is NaN, which interrupts the line
    ax.plot(means.index, means, "o-" if is_number else "o", color="C0", label="result")
    lost = sorted(set(x[results.isna()]))
    if lost:
        ax.plot(lost, [0.04] * len(lost), "x", color="#D55E00", markersize=8, markeredgewidth=2, label="no result",
                transform=ax.get_xaxis_transform(), clip_on=False)
    if own is not None and (is_number or str(own) in words):
        at = float(own) if is_number else float(words.index(str(own)))
        ax.axvline(at, color="0.6", linestyle=":", zorder=0, label="the scenario's own value")
        if np.isfinite(means.get(at, np.nan)):
            ax.plot([at], [means[at]], "D", color="k", markersize=8, fillstyle="none", label="the scenario")
    if words:
        ax.set_xticks(range(len(words)), words)
        ax.margins(x=0.15)
    ax.grid(alpha=0.3)


def _mark_replicates(ax: Any, values: pandas.Series[Any], results: pandas.Series[float]) -> None:
    ax.plot(_places(values)[0], results, ".", color="C0", alpha=0.5, label="a replicate")


def _places(values: pandas.Series[Any]) -> tuple[pandas.Series[float], list[str]]:
    """Positions of values along an axis; 0, 1, 2, … with labels if they are not numbers."""
    if _is_number(values):
        return values.astype(float), []
    words = list(dict.fromkeys(map(str, values)))
    return values.map(lambda value: float(words.index(str(value)))), words


def phase_diagram(
    study: StudyTable,
    x: Optional[str] = None,
    y: Optional[str] = None,
    *,
    measure: Union[str, Callable[[pandas.Series[Any]], str]] = "verdict",
    at: Optional[Mapping[str, Any]] = None,
    thumbnails: Union[int, Sequence[int]] = 0,
    view: str = "cross-section",
) -> Any:
    """Draw a phase diagram over two keys: one cell per pair of values, coloured by the result.

    Cells have equal size, whatever the spacing of the values, which label the axes.

    Parameters
    ----------
    x, y : str, optional
        Keys along the axes; by default the first and second key that vary.
    measure : str or callable
        Quantity that colours a cell: "verdict" (see `plica.verdict`), a column of `table`, or a function that maps a row to
        a word. Replicates are averaged, or coloured as "replicates differ" if their words differ.
    at : mapping of str to value, optional
        Values of the other keys, if more than two vary.
    thumbnails : int or sequence of int
        Number of embryos shown below, along the diagonal from the first values to the last, or their points. Requires kept
        runs (``keep.each = "full"``) and PyVista.
    view : str
        View of the embryos, as in `plica.render`.

    Returns
    -------
    matplotlib.figure.Figure

    Raises
    ------
    ValueError
        If the study is not a grid over these keys, the output variable does not exist, another key requires a value, or
        runs were not kept.

    Examples
    --------
    >>> import plica
    >>> study = plica.Study("results/closing")                                   # doctest: +SKIP
    >>> study.phase_diagram(thumbnails=4).savefig("phases.png")                  # doctest: +SKIP
    """
    plt, colors = needed("matplotlib.pyplot", "phase_diagram"), needed("matplotlib.colors", "phase_diagram")
    if not callable(measure):
        text_of(measure, "measure")
    text_of(view, "view")
    table, (x, y) = study.table, _two_keys(study, x, y)
    for key, value in mapping_of({} if at is None else at, "at", "a mapping of keys to values").items():
        if key not in study.keys:
            raise ValueError(f"at: {key} does not vary in the study; keys: {', '.join(study.keys)}")
        table = table[table[key] == value]
    _check_is_plane(study, table, x, y)
    columns, rows = _in_order(table[x]), _in_order(table[y])
    if isinstance(thumbnails, Iterable):
        shown = [whole(one, "thumbnails", 0) for one in thumbnails]
    else:
        shown = _diagonal(table, x, y, columns, rows, whole(thumbnails, "thumbnails", 0))
    if len(shown) > len(LETTERS):
        raise ValueError(f"thumbnails: {len(shown)} embryos; give at most {len(LETTERS)}")
    if shown and (study._directory is None or study._given.get("keep.each") != "full"):
        raise ValueError('thumbnails: the study did not keep its runs; run it with keep.each = "full" and out')

    wide, high = 3.2 + 0.55 * len(columns), 1.6 + 0.5 * len(rows)
    is_words = callable(measure) or measure == "verdict" or not _is_number(table.get(measure, table.status))
    figure = plt.figure(figsize=(max(wide, 5.5) + (2.5 if is_words else 0), max(high, 3.6) + (1.9 if shown else 0)), layout="constrained")
    above, below = figure.subfigures(2, 1, height_ratios=[max(high, 3.6), 1.9]) if shown else (figure, None)
    ax = above.subplots()
    if is_words:
        words = _words(table, measure)
        lost = int((words.isin(NO_RESULT) | ~table.status.isin(FINISHED)).sum())
        cells = words.groupby([table[y], table[x]]).agg(_common).unstack()
        _paint_words(ax, colors, cells, rows, columns, VERDICTS if measure == "verdict" else {})
    else:
        results = _results(table, str(measure))
        lost = int(results.isna().sum())
        _paint_numbers(ax, results.groupby([table[y], table[x]]).mean().unstack(), rows, columns, str(measure))
    for axis, names, key in ((ax.xaxis, columns, x), (ax.yaxis, rows, y)):
        places = range(0, len(names), -(-len(names) // 10))
        axis.set_ticks(list(places), [_shown(names[i]) for i in places])
        axis.set_label_text(_axis_label(study, key))
    cross = " (×)" if lost and not is_words else ""
    ax.set_title(_title(study, measure, len(table), lost) + cross, loc="left", fontsize="medium")
    if shown:
        _add_thumbnails(study, table, ax, below, shown, (x, columns), (y, rows), view)
    return figure


def _two_keys(study: StudyTable, x: Optional[str], y: Optional[str]) -> tuple[str, str]:
    for key in (x, y):
        if key is not None:
            text_of(key, "phase_diagram: x and y")
    free = [key for key in study.keys if key not in (x, y)]
    x = x or (free.pop(0) if free else "")
    y = y or (free.pop(0) if free else "")
    for key in (x, y):
        if key not in study.keys:
            told = f"{key!r} does not vary in the study{_did_you_mean(key, study.keys)}" if key else "requires two keys that vary"
            raise ValueError(f"phase_diagram: {told}; keys: {', '.join(study.keys)}")
    return x, y


def _check_is_plane(study: StudyTable, table: pandas.DataFrame, x: str, y: str) -> None:
    if study.kind in DRAWN_KINDS:
        raise ValueError(f'phase_diagram: the study is of kind "{study.kind}"; use a grid over the two keys')
    others = [key for key in study.keys if key not in (x, y) and table[key].nunique() > 1]
    if others:
        values = ", ".join(map(_shown, _in_order(table[others[0]])))
        raise ValueError(f"phase_diagram: {others[0]} also varies; set at={{{others[0]!r}: …}} to one of {values}")
    pairs = table[[x, y, "replicate"]]
    if table.empty or pairs.duplicated().any() or len(pairs[[x, y]].drop_duplicates()) != table[x].nunique() * table[y].nunique():
        raise ValueError(f'phase_diagram: the study (of kind "{study.kind}") has not one point for each pair of values; '
                         "give a grid")


def _words(table: pandas.DataFrame, measure: Union[str, Callable[[pandas.Series[Any]], str]]) -> pandas.Series[str]:
    if not callable(measure) and measure != "verdict" and measure not in table:
        _results(table, measure, ["verdict"])  # reports the existing columns
    if not callable(measure) and measure in table:
        return table[measure].astype(str)
    judge = measure if callable(measure) else verdict
    return table.apply(lambda row: str(judge(row)), axis=1)


def _common(words: pandas.Series[str]) -> str:
    return str(words.iloc[0]) if words.nunique() == 1 else "replicates differ"


def _title(study: StudyTable, measure: Union[str, Callable[[pandas.Series[Any]], str]], runs: int, lost: int) -> str:
    scenario = _scenario_of(study)
    own = not any(key.startswith("time.end_") for key in study.keys)
    until = f" until {_shown(scenario['time.end_s'] / 60)} min" if scenario is not None and own else ""
    name = getattr(measure, "__name__", str(measure))
    what = "a function of the row" if name == "<lambda>" else _label(name)
    return f"{study._spec.name}: {what} of {study._core.scenario_name}{until}\n{runs} runs, {lost or 'none'} without a value"


def _paint_words(ax: Any, colors: Any, cells: pandas.DataFrame, rows: list[Any], columns: list[Any], asked: dict[str, str]) -> None:
    cells = cells.reindex(index=rows, columns=columns)
    there = set(cells.to_numpy().ravel()) | set(asked)
    words = [word for word in COLOURS if word in there] + sorted(word for word in there if word not in COLOURS)
    others: Iterator[str] = iter(OTHER_COLOURS * (1 + len(words) // len(OTHER_COLOURS)))
    colours = [COLOURS.get(word) or next(others) for word in words]
    numbers = np.array([[words.index(word) for word in row] for row in cells.to_numpy()])
    ax.imshow(numbers, origin="lower", aspect="auto", cmap=colors.ListedColormap(colours), vmin=-0.5, vmax=len(words) - 0.5)
    _separate(ax, rows, columns)
    patches = needed("matplotlib.patches", "phase_diagram")
    hatched = {"replicates differ": "////"}
    for row, column in np.argwhere((cells == "replicates differ").to_numpy()):
        ax.add_patch(patches.Rectangle((column - 0.5, row - 0.5), 1, 1, fill=False, hatch="////", edgecolor="0.3", linewidth=0))
    entries = [patches.Patch(facecolor=colour, edgecolor="0.3", hatch=hatched.get(word), label=asked.get(word, word))
               for word, colour in zip(words, colours)]
    ax.legend(handles=entries, loc="upper left", bbox_to_anchor=(1.01, 1), frameon=False, borderaxespad=0)


def _paint_numbers(ax: Any, cells: pandas.DataFrame, rows: list[Any], columns: list[Any], measure: str) -> None:
    cells = cells.reindex(index=rows, columns=columns)
    ax.set_facecolor("0.9")
    image = ax.imshow(cells.to_numpy(dtype=float), origin="lower", aspect="auto", cmap="viridis")
    _separate(ax, rows, columns)
    for row, column in np.argwhere(cells.isna().to_numpy()):
        ax.plot(column, row, "x", color="#D55E00", markersize=8, markeredgewidth=2)
    ax.figure.colorbar(image, ax=ax, label=_label(measure))


def _separate(ax: Any, rows: list[Any], columns: list[Any]) -> None:
    ax.set_xticks(np.arange(1, len(columns)) - 0.5, minor=True)
    ax.set_yticks(np.arange(1, len(rows)) - 0.5, minor=True)
    ax.grid(which="minor", color="white", linewidth=1)
    ax.tick_params(which="minor", length=0)


def _diagonal(table: pandas.DataFrame, x: str, y: str, columns: list[Any], rows: list[Any], count: int) -> list[int]:
    pairs = {(columns[round(part * (len(columns) - 1))], rows[round(part * (len(rows) - 1))]): None
             for part in np.linspace(0, 1, count)}
    points = table.groupby([x, y]).point.first()
    return [int(points[pair]) for pair in pairs]


def _add_thumbnails(study: StudyTable, table: pandas.DataFrame, ax: Any, below: Any, points: list[int], across: tuple[str, list[Any]],
                    up: tuple[str, list[Any]], view: str) -> None:
    effects = needed("matplotlib.patheffects", "thumbnails")
    images: list[NDArray[np.uint8]] = []
    for letter, point in zip(LETTERS, points):
        found = table[table.point == point]
        if found.empty:
            raise ValueError(f"thumbnails: point {point} is not in this diagram; points: {sorted(set(table.point))}")
        directory = study._run_directory(int(found.index[0]))
        try:
            images.append(render(open_run(directory), view=view, color="region", size=(500, 400), bar=False))
        except (OSError, IndexError) as error:
            raise ValueError(f"thumbnails: point {point} has no frame in {directory}; choose other points") from error
        place = (across[1].index(found[across[0]].iloc[0]), up[1].index(found[up[0]].iloc[0]))
        text = ax.text(*place, letter, color="k", ha="center", va="center", fontweight="bold")
        text.set_path_effects([effects.withStroke(linewidth=3, foreground="w")])
    drawn = np.any([(image < 250).any(axis=2) for image in images], axis=0)  # crop the margin around all embryos
    up_down, left_right = (np.flatnonzero(drawn.any(axis=axis)) for axis in (1, 0))
    for letter, image, picture in zip(LETTERS, images, below.subplots(1, len(images), squeeze=False)[0]):
        picture.imshow(image[up_down[0] : up_down[-1] + 1, left_right[0] : left_right[-1] + 1])
        picture.set_title(letter, fontsize="medium", fontweight="bold")
        picture.axis("off")


def _results(table: pandas.DataFrame, measure: str, others: Sequence[str] = ()) -> pandas.Series[float]:
    """Output variable of finished runs; NaN for others, whose last accepted state is not a result."""
    if text_of(measure, "measure") not in table or not _is_number(table[measure]):
        known = [*others, *list(table.columns)[list(table.columns).index("status") + 1 : -2]]
        raise ValueError(f"the study has no output variable {measure!r}{_did_you_mean(measure, known)}; it has {', '.join(known)}")
    return table[measure].astype(float).where(table.status.isin(FINISHED))


def _did_you_mean(word: str, known: Sequence[str]) -> str:
    near = [name for name in known if word in name] or difflib.get_close_matches(word, known)
    return f" (nearest match: {near[0]!r})" if near else ""


def _scenario_of(study: StudyTable) -> Optional[Scenario]:
    """Scenario of the study, or None if it cannot be read any more."""
    given = tomllib.loads(study._spec.text)
    try:
        if study._directory is not None:
            return Scenario(study._directory / "scenario.toml")
        file = Path(study._spec.file).parent / given["scenario"]
        scenario = Scenario(file if file.is_file() else given["scenario"])
        scenario.update(dict(_items(given.get("set", {}))))
        return scenario
    except (PlicaError, KeyError):
        return None


def _own_values(study: StudyTable) -> dict[str, Any]:
    """Values of the keys in the scenario of the study."""
    scenario = _scenario_of(study)
    try:
        return {} if scenario is None else {key: scenario[key] for key in study.keys}
    except KeyError:
        return {}


def _is_number(values: pandas.Series[Any]) -> bool:
    return values.dtype.kind in "iuf"


def _number(value: Any, what: str) -> float:
    return float("nan") if value is None else number(value, what, "a number or None", finite=False)


def _in_order(values: pandas.Series[Any]) -> list[Any]:
    distinct = list(dict.fromkeys(values))
    return sorted(distinct) if _is_number(values) else distinct


def _shown(value: Any) -> str:
    if isinstance(value, bool) or not isinstance(value, (int, float, np.number)):
        return str(value)
    return np.format_float_positional(float(value), precision=3, fractional=False, trim="-")


def _axis_label(study: StudyTable, key: str) -> str:
    return _label(key) + (", log scale" if study._given.get(f"vary.{key}.scale") == "log" else "")


def _set_log(axis: Any) -> None:
    """Make an axis logarithmic, with plain labels at 1, 2, 5, 10, …"""
    ticker = needed("matplotlib.ticker", "a logarithmic axis")
    (axis.axes.set_xscale if axis.axis_name == "x" else axis.axes.set_yscale)("log")
    axis.set_major_locator(ticker.LogLocator(subs=(1, 2, 5)))
    axis.set_major_formatter("{x:g}")
    axis.set_minor_formatter(ticker.NullFormatter())


def _legend_below(figure: Any, axes: Any) -> None:
    entries = {label: handle for ax in axes for handle, label in zip(*ax.get_legend_handles_labels())}
    figure.legend(entries.values(), entries.keys(), loc="outside lower center", ncols=5, frameon=False)
