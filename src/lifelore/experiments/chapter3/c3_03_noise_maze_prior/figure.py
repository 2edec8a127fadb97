"""Figure of claim C3.3: learning curves in noise mazes under each schedule of ε, and the grid of open choices."""

from collections.abc import Mapping

from lifelore.experiments.chapter3.figures.choice_grid import draw_choice_grid
from lifelore.experiments.chapter3.figures.reward_curves import MethodCurve, draw_return_curves
from lifelore.figures.style import GREY, Figure, colour_of, house_style, new_figure

LABELS = {
    "q_learning": ("Q-learning", "q-learning"),
    "qsap": ("ε-QSAP, lattice", "eps-QSAP"),
    "qpap": ("ε-QPAP, noise mazes", "eps-QPAP"),
    "qsap_noise": ("ε-QSAP, noise mazes", "eps-QSAP"),
    "qpap_lattice": ("ε-QPAP, lattice", "eps-QPAP"),
}
"""Label and style by method; each prior is named with the world that it was trained in."""
TRAINED_ALIKE = ("qsap_noise", "qpap_lattice")
PAIRS = (
    ("qpap", "q_learning", "ε-QPAP against Q-learning"),
    ("qpap", "qsap", "ε-QPAP against ε-QSAP"),
    ("qsap", "q_learning", "ε-QSAP against Q-learning"),
)


def draw(result: Mapping) -> Figure:
    """The figure from the result."""
    schedules = result["settings"]["schedules"]
    with house_style():
        figure = new_figure(12.4, 10.2)
        upper, lower = figure.subfigures(2, 1, squeeze=False, height_ratios=[0.95, 1.1], hspace=0.02)[:, 0]
        panels = upper.subplots(2, len(schedules), squeeze=False, height_ratios=[1, 0.34], sharey="row")
        for column, schedule in zip(panels.T, schedules, strict=True):
            rows = [row for row in result["rows"] if "curve_of" in row and row["schedule"] == schedule]
            draw_return_curves(column, result, schedule, [_method(row) for row in rows])
        panels[0, 0].set_ylabel("return of an episode")
        upper.legend(*panels[0, 0].get_legend_handles_labels(), loc="outside upper left", ncols=6)
        _draw_grids(lower.subplots(2, len(PAIRS), sharex=True, sharey=True), result)
        lower.supxlabel(
            f"Shaded and thin lines: 95 % interval over {result['settings']['runs']} runs. Dashed, pale: trained "
            "where the other prior was. Columns: ε, and how ties are broken.\n"
            "Bold: the interval excludes 0, or 1. Framed: the default. Bars and ratios: runs that never "
            "arrive count as the cap.",
            fontsize=8, color=GREY,
        )  # fmt: skip
    return figure


def _method(row: Mapping) -> MethodCurve:
    label, style = LABELS[row["curve_of"]]
    return MethodCurve(label, colour_of(style), row, row["to_80"], row["curve_of"] in TRAINED_ALIKE)


def _draw_grids(panels, result: Mapping) -> None:
    default = result["settings"]["default"]

    def name(form: str, alpha0: float | None, max_steps: int, training_tasks: int) -> str:
        if max_steps != default["max_steps"]:
            return f"cap of {max_steps} steps"
        if training_tasks != default["training_tasks"]:
            return f"{training_tasks} training tasks"
        return form if alpha0 is None else f"{form}, α⁰ {alpha0:g}"

    cells = [row for row in result["rows"] if "form" in row]
    side = ("form", "alpha0", "max_steps", "training_tasks")
    for (above, below), (one, other, title) in zip(panels.T, PAIRS, strict=True):
        draw_choice_grid(
            above, result["settings"], cells, f"first_{one}_minus_{other}", side, name,
            neutral=0.0, spread=60.0, words="{:+.1f}".format,
        )  # fmt: skip
        draw_choice_grid(
            below, result["settings"], cells, f"to_80_ratio_{one}_to_{other}", side, name,
            neutral=1.0, spread=4.0, ratio=True, good="low", words="{:.2f}".format,
        )  # fmt: skip
        above.set_title(f"{title}:\nfirst return, difference")
        below.set_title("episodes to 80 % of optimal, ratio")
