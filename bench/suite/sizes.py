"""Embryos of about a given number of elements, made in two ways."""
import math
from dataclasses import dataclass

PAPERS_CELLS = 756  # of 18 x 9 x 8 squares


@dataclass(frozen=True)
class Embryo:
    """The pill `scale` times as long and wide, its cells as large as ever, each cut into across x across x layers."""
    scale: int = 1
    across: int = 1
    layers: int = 1

    @property
    def elements(self):
        return PAPERS_CELLS * self.scale**2 * self.across**2 * self.layers

    @property
    def options(self):
        """Of bench/step and bench/kernels."""
        return ["--scale", self.scale, "--elements-per-cell", self.across, self.layers]

    @property
    def refined_by(self):
        return "nothing" if self.elements == PAPERS_CELLS else "more cells" if self.scale > 1 else "more elements per cell"

    def __str__(self):
        if self.scale == self.across == self.layers == 1:
            return "the paper's"
        if self.scale > 1:
            return f"{self.scale} times as long and wide"
        return f"{self.across} × {self.across} × {self.layers} per cell"


@dataclass(frozen=True)
class Furrow:
    """A whole run with all its files: a built-in scenario, and what is set in it."""
    scenario: str
    settings: tuple = ()

    def __str__(self):
        return " ".join([f"`{self.scenario}`", *(f"`{setting}`" for setting in self.settings)])


FURROWS = [Furrow("furrow-slice"), Furrow("drosophila-living"), Furrow("drosophila-living", ('embryo.mirror=["y"]',)),
           Furrow("drosophila-living", ('embryo.mirror=["x", "y"]',)), Furrow("drosophila-egg"), Furrow("drosophila-atlas")]


def by_elements(size):
    """Cells stay; each is cut along, across and, half as often, in its height."""
    candidates = [Embryo(1, n, math.ceil(n / 2)) for n in range(1, 41)]
    return min(candidates, key=lambda embryo: abs(math.log(embryo.elements / size)))


def by_cells(size):
    """Elements are cells, and there are more of them."""
    return Embryo(max(1, round(math.sqrt(size / PAPERS_CELLS))))


def embryos(size):
    """Those of about this size, each once: more elements a cell, more cells."""
    return list(dict.fromkeys([by_elements(size), by_cells(size)]))
