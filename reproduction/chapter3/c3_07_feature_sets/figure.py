"""Figure of claim C3.7: rewards with priors over features, over states and without a prior; the grid."""

from collections.abc import Mapping

from lifelore.figures.heat_grid import draw_estimate_grid
from lifelore.figures.style import GREY, VERMILION, Axes, Figure, colour_of, house_style, new_figure, two_rows
from reproduction.chapter3.figures.choice_grid import other_choice, place_of_default
from reproduction.chapter3.figures.reward_curves import draw_reward_curves
from reproduction.chapter3.learning.schedules import schedule_in_brief

LABELS = {
    "uniform": "no prior",
    "state": "states",
    "phi1": "φ1, own cell and Items",
    "phi2": "φ2, N S E W",
    "phi3": "φ3, φ1 and φ2",
    "phi4": "φ4, 3×3 cells and Items",
}
COLOURS = {"uniform": GREY, "state": VERMILION, **{phi: colour_of(phi) for phi in LABELS if "phi" in phi}}
BANDED = ("uniform", "state", "phi3")
"""Methods whose deviation is shaded; six bands would hide one another."""


@house_style()
def draw(result: Mapping) -> Figure:
    """The figure from the result."""
    settings = result["settings"]
    figure = new_figure(10.6, 9.8)
    upper, lower = two_rows(figure, (1.0, 1.15))
    draw_reward_curves(upper, result, COLOURS, LABELS, banded=BANDED, dashed=("phi2",))
    _draw_grid(lower.subplots(), result)
    lower.supxlabel(
        f"{settings['runs']} runs of {settings['test_tasks']} tasks. Shaded: one standard deviation between "
        "runs, of three methods. Bold: the 95 % interval over runs excludes 0. Framed, at φ3: the default.\n"
        "Walls: the least and the most inner walls of a zone. Sets of features do not read the code of states.",
        fontsize=8, color=GREY,
    )  # fmt: skip
    return figure


def _draw_grid(axes: Axes, result: Mapping) -> None:
    settings, methods = result["settings"], list(LABELS)[1:]
    cells = [row for row in result["rows"] if "closed_phi1" in row]
    draw_estimate_grid(
        axes,
        [[row[f"closed_{method}"] for method in methods] for row in cells],
        [_name(row, settings["default"]) for row in cells],
        [LABELS[method] for method in methods],
        neutral=0.0, scale=100.0, spread=100.0, words="{:z.0f}".format,
        outlined=(place_of_default(cells, settings), methods.index("phi3")),
    )  # fmt: skip
    axes.set_title("Distance from no prior to the optimum that is closed, all episodes (%)")


def _name(row: Mapping, default: Mapping) -> str:
    """A row's walls, ε and ties, or the other choice in which it differs from the default."""
    others = {
        "encoding": "states coded '{}'", "alpha0": "α⁰ {:g}", "max_steps": "cap of {:,} steps",
        "policies": "from {} policies",
    }  # fmt: skip
    least, most = row["walls"]
    crossed = f"{least} to {most} walls, {schedule_in_brief(row['schedule'])}, ties {row['ties']}"
    return other_choice(row, default, others) or crossed
