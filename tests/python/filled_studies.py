"""Studies that are filled with functions of which everything is known."""
import matplotlib.pyplot as plt
import numpy as np
import pytest

import plica

YOUNG, POISSON = "elasticity.young_modulus_Pa", "elasticity.poisson_ratio"
DEPTH, HEIGHT = "furrow_depth_um", "vml_height_um"
BOUNDS = {YOUNG: (400, 1200), POISSON: (0.2, 0.4)}
MATRIX, OFFSET = np.array([[10.0, 4.0], [-3.0, 8.0]]), np.array([20.0, 50.0])
TRUTH, SD = np.array([0.4, 0.6]), np.array([0.5, 0.6])
LINEAR = {DEPTH: lambda t: (unit(t, YOUNG, POISSON) @ MATRIX.T + OFFSET)[:, 0],
          HEIGHT: lambda t: (unit(t, YOUNG, POISSON) @ MATRIX.T + OFFSET)[:, 1]}
TARGETS = dict(zip((DEPTH, HEIGHT), zip(MATRIX @ TRUTH + OFFSET, SD)))


@pytest.fixture(autouse=True)
def no_figure_stays_open():
    yield
    plt.close("all")


def source(vary, kind="grid", measures=(DEPTH, HEIGHT), **design):
    return {"scenario": "furrow-slice", "vary": vary, "design": {"kind": kind, **design}, "keep": {"measures": list(measures)}}


def filled(source, **columns):
    """The study, as if its runs had come to this: numbers, or functions of the table."""
    table = plica.Study(source).table.assign(status="end_time", steps=10, wall_s=1.0, reason="")
    for name, values in columns.items():
        table[name] = values(table) if callable(values) else values
    return plica.Study._of_table(source, table)


def unit(table, *keys):
    return np.column_stack([(table[key] - BOUNDS[key][0]) / (BOUNDS[key][1] - BOUNDS[key][0]) for key in keys])


def between(key, **more):
    return {"low": BOUNDS[key][0], "high": BOUNDS[key][1], **more}


def texts_of(figure):
    return {text.get_text() for text in figure.findobj(plt.Text)}


def linear(points):
    return filled(source({YOUNG: between(YOUNG), POISSON: between(POISSON)}, "sobol", points=points), **LINEAR)
