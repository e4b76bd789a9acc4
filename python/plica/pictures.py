"""Pictures and movies of simulations, by PyVista."""
from __future__ import annotations

import contextlib
import os
from collections.abc import Sequence
from pathlib import Path
from typing import Any, Optional, Union

import numpy as np

from .arguments import number, pair_of, path_of, texts_of, told
from .errors import FileError, needed
from .results import Frame, Run, open_run
from .scene import Image, Scene, Source
from .simulation import Simulation

__all__ = ["render", "movie"]

PathOrRun = Union[Run, str, "os.PathLike[str]"]


def render(
    what: Union[PathOrRun, Frame, Simulation],
    path: Optional[Union[str, os.PathLike[str]]] = None,
    *,
    color: str = "displacement",
    view: Union[str, Sequence[str], None] = None,
    time_min: Union[float, Sequence[float], None] = None,
    at_x_um: Union[float, Sequence[float], None] = None,
    sections: bool = False,
    strip: bool = False,
    limits: Optional[tuple[float, float]] = None,
    size: Optional[tuple[int, int]] = None,
    edges: bool = True,
    shell: bool = False,
    bar: bool = True,
) -> Image:
    """Draw a tissue, off screen, as ``plica render`` does: one row per view, one column per time. Requires PyVista.

    Parameters
    ----------
    what : Run, path, Frame or Simulation
        Source of the mesh.
    path : str or path, optional
        PNG file to write.
    color : str
        Quantity that colours the cells: displacement, speed, area-ratio, pressure, volume-error, volume, contraction,
        strength, generation, region or self-intersections. Also an array of the cells, such as gene expression, for a
        snapshot, and a name in ``Simulation.cell_data`` for a simulation.
    view : str or sequence of str, optional
        antero-ventral, ventral, side, cross-section, sagittal-section or apical (apical surface from outside). By default
        antero-ventral, for an open sheet apical.
    time_min : float or sequence of float, optional
        Times of a run, minutes: the nearest snapshots; by default the last.
    at_x_um : float or sequence of float, optional
        Places of cross-sections along x, µm, in the reference state.
    sections : bool
        Whether to draw cross-sections at 25, 50 and 75 % of the length, at the times of a strip or `time_min`.
    strip : bool
        Whether to draw five times, evenly spaced in displacement, from outside and in cross-section; `time_min` and `view`
        override these.
    limits : (float, float), optional
        Values at the ends of the colour scale, to compare pictures; by default from the data shown.
    size : (int, int), optional
        Width and height, pixels, 100 to 6000 each; by default wide enough for all columns.
    edges : bool
        Whether to draw the outlines of the elements.
    shell : bool
        Whether to draw the vitelline membrane of a run or simulation.
    bar : bool
        Whether to draw the colour bar and the scale bar.

    Returns
    -------
    ndarray of uint8, shape (height, width, 3)
        RGB image.

    Raises
    ------
    ValueError
        If a colour, view, time or place does not exist, or an option requires a run.
    FileError
        If the file cannot be written.
    PlicaError
        If neither a display nor off-screen OpenGL is available.

    Examples
    --------
    >>> import plica
    >>> run = plica.open("results/drosophila")                                           # doctest: +SKIP
    >>> image = plica.render(run, "fold.png", time_min=[1, 5, 15], view=["ventral", "cross-section"])  # doctest: +SKIP
    """
    file = None if path is None else Path(path_of(path, "path"))
    if file is not None and file.suffix.lower() != ".png":
        raise ValueError(f"path: {file.name}; the file's name must end in .png")
    source = Source(what)
    times = _times(source, time_min, strip or sections)
    rows = _rows(view, at_x_um, sections, [None, "cross-section"] if strip else [None])
    scene = Scene(source, color, *rows, sections, size, edges, shell, bar)
    image = scene.draw([source.moment(time) for time in times], None if limits is None else _limits(limits))
    if file is not None:
        _write(file, lambda target: needed("matplotlib.image", "render").imsave(target, image, format="png"))
    return image


def movie(
    run: PathOrRun,
    path: Union[str, os.PathLike[str]],
    *,
    frames_per_s: float = 10,
    color: str = "displacement",
    view: Union[str, Sequence[str], None] = None,
    at_x_um: Union[float, Sequence[float], None] = None,
    sections: bool = False,
    limits: Optional[tuple[float, float]] = None,
    size: tuple[int, int] = (800, 600),
    edges: bool = True,
    shell: bool = False,
    bar: bool = True,
) -> None:
    """Write a movie of all snapshots of a run: GIF, or MP4 (H.264). Requires ``pip install 'plica[movie]'``, but no ffmpeg.

    Parameters
    ----------
    run : Run or path
        Run with snapshots.
    path : str or path
        File to write, ``.gif`` or ``.mp4``; an existing one is replaced.
    frames_per_s : float
        Snapshots shown per second.
    color, view, at_x_um, sections, limits, size, edges, shell, bar
        As for `render`; `limits` are by default from all snapshots. MP4 rounds the size up to even numbers of pixels.

    Raises
    ------
    ValueError
        If the file has another extension, or as for `render`.
    FileError
        If the run has no snapshot, or the file cannot be written.
    MissingExtra
        If PyVista, imageio or, for MP4, imageio-ffmpeg is not installed.

    Examples
    --------
    >>> import plica
    >>> plica.movie("results/drosophila", "fold.mp4", color="area-ratio")  # doctest: +SKIP
    """
    file = Path(path_of(path, "path"))
    kind = file.suffix.lower()
    if kind not in (".gif", ".mp4"):
        raise ValueError(f"path: {file.name}; the file's name must end in .gif or .mp4")
    rate = number(frames_per_s, "frames_per_s", "a number > 0")
    if rate <= 0:
        raise ValueError(f"frames_per_s: {told(frames_per_s)}; give a number > 0")
    writers = needed("imageio.v2", "movie")
    if kind == ".mp4":
        needed("imageio_ffmpeg", "a movie in MP4")
    source = Source(run if isinstance(run, Run) else open_run(path_of(run, "run")))
    scene = Scene(source, color, *_rows(view, at_x_um, sections, [None]), sections, size, edges, shell, bar)
    options = {"fps": rate, "macro_block_size": 1} if kind == ".mp4" else {"duration": 1000 / rate, "loop": 0}
    ends = scene.range_over(source) if limits is None else _limits(limits)

    def save(target: Path) -> None:
        with writers.get_writer(target, format="GIF" if kind == ".gif" else "FFMPEG", mode="I", **options) as writer:
            for index in range(len(source.frames)):
                image = scene.draw([source.moment(index)], ends)
                odd = [(0, side % 2) for side in image.shape[:2]] if kind == ".mp4" else [(0, 0), (0, 0)]
                writer.append_data(np.pad(image, [*odd, (0, 0)], constant_values=255))

    _write(file, save)


def _write(file: Path, save: Any) -> None:
    """Write a file whole or not at all."""
    beside = file.parent / f".{file.stem}.part{file.suffix}"
    try:
        save(beside)
        os.replace(beside, file)
    except OSError as error:
        raise FileError(f"{file}: cannot be written: {error.strerror or error}") from error
    finally:
        with contextlib.suppress(OSError):
            beside.unlink(missing_ok=True)


def _rows(view: Any, at_x_um: Any, sections: bool, usual: list[Optional[str]]) -> tuple[list[Optional[str]], list[float]]:
    """Return the names of the views, None for the default view, and the places of cross-sections."""
    places = [] if at_x_um is None else _numbers(at_x_um, "at_x_um")
    if view is not None:
        return [*texts_of(view, "view")], places
    return ([] if places or sections else usual), places


def _numbers(values: Any, what: str) -> list[float]:
    return [number(one, what) for one in np.atleast_1d(np.asarray(values, dtype=object)).ravel()]


def _times(source: Source, time_min: Any, telling: bool) -> list[int]:
    """Return the numbers of the snapshots to draw."""
    if source.single is not None:
        if time_min is not None or telling:
            raise ValueError("time_min, strip and sections require a run, which has several times; give a run, or draw at_x_um")
        return [0]
    if time_min is None:
        return source.telling() if telling else [len(source.frames) - 1]
    minutes = _numbers(time_min, "time_min")
    if not minutes:
        raise ValueError("time_min: is empty; give a time in minutes, or several")
    return [min(range(len(source.times_s)), key=lambda i: abs(source.times_s[i] - 60 * one)) for one in minutes]


def _limits(limits: Any) -> tuple[float, float]:
    low, high = pair_of(limits, "limits", "two numbers, the lower one first")
    if not low < high:
        raise ValueError(f"limits {limits!r}: give two numbers, the lower one first")
    return low, high
