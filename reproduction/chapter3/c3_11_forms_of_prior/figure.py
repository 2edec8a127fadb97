"""Figure of claim C3.11: what forms of one prior earn, episode by episode, and softmaxes of several scales."""

from collections.abc import Mapping

from lifelore.figures import style
from lifelore.figures.heat_grid import draw_estimate_grid
from lifelore.figures.style import Figure, house_style, new_figure, two_rows
from reproduction.chapter3.c3_11_forms_of_prior.measure import key_of
from reproduction.chapter3.figures.choice_grid import RATIO, other_choice, place_of_default
from reproduction.chapter3.figures.reward_curves import draw_reward_curves
from reproduction.chapter3.learning.schedules import schedule_in_brief

COLOURS = {
    "uniform": style.GREY,
    "proportion": style.BLUE,
    "dirichlet": style.GREEN,
    "softmax of counts": style.VERMILION,
    "softmax of counts a policy": style.ORANGE,
    "softmax of proportions": style.PURPLE,
    "softmax of 10 × proportions": style.SKY,
}
BANDED = ("uniform", "proportion", "softmax of counts")
"""Forms whose deviation is shaded; that of the Dirichlet would hide that of the proportions."""
HEADS = ("dirichlet", "softmax\nof counts", "softmax\nof counts\na policy", "softmax\nof proportions")
HEADS += ("softmax\nof 10 ×\nproportions",)


@house_style()
def draw(result: Mapping) -> Figure:
    """Learning curves by schedule above, the grid of open choices below."""
    settings = result["settings"]
    figure = new_figure(11.6, 9.8)
    upper, lower = two_rows(figure, (0.85, 1.0))
    draw_reward_curves(upper, result, COLOURS, {}, banded=BANDED, dashed=("dirichlet",))
    _draw_grids(lower.subplots(1, 2, sharey=True), result)
    lower.supxlabel(
        f"Shaded: one standard deviation across the {settings['test_tasks']} tasks of a run (mean over "
        f"{settings['runs']} runs). Bold: the 95 % interval over runs excludes 0, or 1. Framed: the default, "
        "the softmax as printed.",
        fontsize=8, color=style.GREY,
    )  # fmt: skip
    return figure


def _draw_grids(panels, result: Mapping) -> None:
    default = result["settings"]["default"]
    cells = [row for row in result["rows"] if "features" in row]
    sides = [_in_words(row, default) for row in cells]
    keys = [key_of(form) for form in list(COLOURS)[2:]]
    framed = place_of_default(cells, result["settings"]), 1

    def draw(axes, name: str, **look) -> None:
        numbers = [[row[f"{name}_{key}"] for key in keys] for row in cells]
        draw_estimate_grid(axes, numbers, sides, HEADS, outlined=framed, **look)

    largest = max(abs(row[f"early_difference_{key}"]["value"] or 0.0) for row in cells for key in keys) or 1.0
    draw(panels[0], "early_difference", neutral=0.0, spread=largest, good="low", words="{:+,.0f}".format)
    draw(panels[1], "early_spread_ratio", **RATIO)
    panels[0].set_title(f"First {result['settings']['early']} episodes: proportions earn more by")
    panels[1].set_title("Deviation across tasks, as a ratio to proportions'")


def _in_words(row: Mapping, default: Mapping) -> str:
    """A row of the grid: features, ε and ties, or the other choice in which it differs from the default."""
    others = {"alpha0": "α⁰ {:g}", "max_steps": "cap of {} steps", "policies": "from {} policies"}
    plain = f"{row['features'].replace('phi', 'φ')}, {schedule_in_brief(row['schedule'])}, ties {row['ties']}"
    return other_choice(row, default, others) or plain
