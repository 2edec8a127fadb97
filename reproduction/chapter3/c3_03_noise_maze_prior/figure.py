"""Figure of claim C3.3: learning curves in noise mazes under each schedule of ε, and the grid of open choices."""

from collections.abc import Mapping, Sequence

from lifelore.figures.style import GREY, Figure, SubFigure, colour_of, house_style, new_figure, two_rows
from reproduction.chapter3.figures.choice_grid import RATIO, draw_choice_grid, other_choice
from reproduction.chapter3.figures.reward_curves import MethodCurve, draw_return_curves

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


@house_style()
def draw(result: Mapping) -> Figure:
    """The figure from the result."""
    figure = new_figure(12.4, 10.2)
    upper, lower = two_rows(figure, (0.95, 1.1))
    draw_return_curves(upper, result, lambda schedule: _methods(result, schedule), bars=0.34, ncols=6)
    _draw_grids(lower, result)
    lower.supxlabel(
        f"Shaded and thin lines: 95 % interval over {result['settings']['runs']} runs. Dashed, pale: trained "
        "where the other prior was. Columns: ε, and how ties are broken.\n"
        "Bold: the interval excludes 0, or 1. Framed: the default. Bars and ratios: runs that never "
        "arrive count as the cap.",
        fontsize=8, color=GREY,
    )  # fmt: skip
    return figure


def _methods(result: Mapping, schedule: Sequence[float]) -> list[MethodCurve]:
    rows = [row for row in result["rows"] if "curve_of" in row and row["schedule"] == schedule]
    looks = [(*LABELS[row["curve_of"]], row["curve_of"] in TRAINED_ALIKE) for row in rows]
    return [
        MethodCurve(label, colour_of(style), row, row["to_80"], is_aside)
        for row, (label, style, is_aside) in zip(rows, looks, strict=True)
    ]


def _draw_grids(figure: SubFigure, result: Mapping) -> None:
    settings, side = result["settings"], ("form", "alpha0", "max_steps", "training_tasks")
    others = {"max_steps": "cap of {} steps", "training_tasks": "{} training tasks"}
    cells = [row for row in result["rows"] if "form" in row]

    def name(*values) -> str:
        row = dict(zip(side, values, strict=True))
        plain = row["form"] if row["alpha0"] is None else f"{row['form']}, α⁰ {row['alpha0']:g}"
        return other_choice(row, settings["default"], others) or plain

    panels = figure.subplots(2, len(PAIRS), sharex=True, sharey=True)
    look = {"neutral": 0.0, "spread": 60.0, "words": "{:+.1f}".format}
    for (above, below), (ours, theirs, title) in zip(panels.T, PAIRS, strict=True):
        draw_choice_grid(above, settings, cells, f"first_{ours}_minus_{theirs}", side, name, **look)
        draw_choice_grid(below, settings, cells, f"to_80_ratio_{ours}_to_{theirs}", side, name, **RATIO)
        above.set_title(f"{title}:\nfirst return, difference")
        below.set_title("episodes to 80 % of optimal, ratio")
