"""Figure of claim C3.11: what forms of one prior earn, episode by episode, and softmaxes of several scales."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from lifelore.experiments.chapter3.reward_curves import draw_reward_curves
from lifelore.figures.heat_grid import draw_heat_grid
from lifelore.figures.style import BLUE, GREEN, GREY, ORANGE, PURPLE, SKY, VERMILION, house_style, new_figure

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def draw(result: Mapping):
    return draw_form_curves(result)


_COLOURS = {
    "uniform": GREY,
    "proportion": BLUE,
    "dirichlet": GREEN,
    "softmax of counts": VERMILION,
    "softmax of counts a policy": ORANGE,
    "softmax of proportions": PURPLE,
    "softmax of 10 × proportions": SKY,
}
_BANDED = ("uniform", "proportion", "softmax of counts")
"""Whose deviation is shaded; the Dirichlet's would hide that of the proportions."""
_COMPARED = tuple(_COLOURS)[2:]


def draw_form_curves(result: Mapping) -> "Figure":
    """The figure from the result of C3.11."""
    schedules = result["settings"]["schedules"]
    with house_style():
        figure = new_figure(11.6, 9.8)
        upper, lower = figure.subfigures(2, 1, squeeze=False, height_ratios=[0.85, 1.0], hspace=0.02)[:, 0]
        panels = upper.subplots(1, len(schedules), squeeze=False, sharey=True)[0]
        for axes, schedule in zip(panels, schedules, strict=True):
            draw_reward_curves(axes, result, schedule, _COLOURS, {}, banded=_BANDED, dashed=("dirichlet",))
        panels[0].set_ylabel("reward of an episode")
        upper.legend(*panels[0].get_legend_handles_labels(), loc="outside upper left", ncols=8)
        _draw_grids(lower.subplots(1, 2, sharey=True), result)
        runs, tasks = result["settings"]["runs"], result["settings"]["test_tasks"]
        lower.supxlabel(
            f"Shaded: one standard deviation across the {tasks} tasks of a run (mean over {runs} runs). Bold: the "
            "95 % interval over runs excludes 0, or 1. Framed: the default, the softmax as printed.",
            fontsize=8, color=GREY,
        )  # fmt: skip
    return figure


def _draw_grids(panels, result: Mapping) -> None:
    default = result["settings"]["default"]
    cells = [row for row in result["rows"] if "features" in row]
    sides = [_in_words(row, default) for row in cells]
    heads = [
        form.replace(" of ", "\nof ").replace("a policy", "\na policy").replace("× ", "×\n") for form in _COMPARED
    ]
    keys = [form.replace("10 × ", "ten_").replace(" ", "_") for form in _COMPARED]
    # Blue where the form does well beside proportions, as everywhere else.
    largest = max(abs(row[f"early_difference_{key}"]["value"] or 0.0) for row in cells for key in keys)
    looks = {
        "early_difference": {"neutral": 0.0, "spread": largest or 1.0, "good": "low", "words": _signed},
        "early_spread_ratio": {"neutral": 1.0, "spread": 4.0, "ratio": True, "good": "low", "words": _ratio},
    }
    framed = (next(i for i, row in enumerate(cells) if _is_default(row, default)), 1)
    for axes, (name, look) in zip(panels, looks.items(), strict=True):
        numbers = [[row[f"{name}_{key}"] for key in keys] for row in cells]
        values = [[np.nan if n["value"] is None else n["value"] for n in row] for row in numbers]
        certain = [[_excludes(n["ci95"], look["neutral"]) for n in row] for row in numbers]
        draw_heat_grid(axes, values, certain, sides, heads, outlined=framed, **look)
    early = result["settings"]["early"]
    panels[0].set_title(f"First {early} episodes: proportions earn more by")
    panels[1].set_title("Deviation across tasks, as a ratio to proportions'")


def _is_default(row: Mapping, default: Mapping) -> bool:
    return all(row[key] == value for key, value in default.items())


def _in_words(row: Mapping, default: Mapping) -> str:
    """What a row of the grid is: features, ε and ties, or what else in it differs from the default."""
    others = {"alpha0": "α⁰ {:g}", "max_steps": "cap of {} steps", "policies": "from {} policies"}
    for key, words in others.items():
        if row[key] != default[key]:
            return words.format(row[key])
    first, decay, _ = row["schedule"]
    epsilon = f"ε {first:g}" if decay == 1 else f"ε {first:g} × {decay:g}"
    return f"{row['features'].replace('phi', 'φ')}, {epsilon}, ties {row['ties']}"


def _signed(value: float) -> str:
    return f"{value:+,.0f}".replace("-", "−")


def _ratio(value: float) -> str:
    return f"{value:.2f}"


def _excludes(interval: Sequence[float] | None, neutral: float) -> bool:
    return bool(interval) and not interval[0] <= neutral <= interval[1]
