"""Figure of claim C3.12: learning with priors that simulated people showed, and with self-trained ones."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from lifelore.experiments.chapter3.reward_curves import draw_reward_curves
from lifelore.figures.heat_grid import draw_heat_grid
from lifelore.figures.style import BLUE, GREEN, GREY, house_style, new_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


def draw(result: Mapping):
    return draw_shown_priors(result)


_COLOURS = {"uniform": GREY, "self-trained": BLUE, "shown": GREEN}


def draw_shown_priors(result: Mapping) -> "Figure":
    """The figure from the result of C3.12."""
    settings = result["settings"]
    labels = {"shown": f"shown by one person ({settings['default']['people']}, simulated)"}
    with house_style():
        figure = new_figure(12.4, 7.6)
        upper, lower = figure.subfigures(2, 1, squeeze=False, height_ratios=[1.0, 1.05], hspace=0.02)[:, 0]
        panels = upper.subplots(1, len(settings["schedules"]), squeeze=False, sharey=True)[0]
        for axes, schedule in zip(panels, settings["schedules"], strict=True):
            draw_reward_curves(axes, result, schedule, _COLOURS, labels, banded=_COLOURS)
        panels[0].set_ylabel("reward of an episode")
        upper.legend(*panels[0].get_legend_handles_labels(), loc="outside upper left", ncols=8)
        grid, people = lower.subplots(1, 2, width_ratios=[1.1, 1.0])
        _draw_grid(grid, result)
        _draw_people(people, result)
        lower.supxlabel(
            "Below: mean reward of an episode minus that with the self-trained prior, in % of the distance from "
            "no prior to the optimum.\nBold: the 95 % interval excludes 0. Framed: the default. Shaded: one "
            f"standard deviation across the {settings['test_tasks']} tasks of a run. People are simulated.",
            fontsize=8, color=GREY,
        )  # fmt: skip
    return figure


def _draw_grid(axes: "Axes", result: Mapping) -> None:
    settings, default = result["settings"], result["settings"]["default"]
    cells = [row for row in result["rows"] if "features" in row]
    columns = [(s, t) for s in settings["schedules"] for t in settings["ties"]]
    lines = [("features", name) for name in settings["features"]]
    lines += [(key, n) for key in ("alpha0", "trajectories") for n in settings[key] if n != default[key]]
    numbers = [[_cell(cells, default, key, value, column) for column in columns] for key, value in lines]
    words = {"features": "{}", "alpha0": "α⁰ {:g}", "trajectories": "{} trajectories"}
    heads = [f"ε {_epsilon(schedule)},\nties {ties}" for schedule, ties in columns]
    sides = [words[key].format(value).replace("phi", "φ") for key, value in lines]
    framed = (
        settings["features"].index(default["features"]),
        columns.index((default["schedule"], default["ties"])),
    )
    _draw_numbers(axes, numbers, sides, heads, framed)
    axes.set_title("The default person, by choices left open")


def _cell(cells, default: Mapping, key: str, value, column: tuple) -> Mapping | None:
    wanted = {**default, "schedule": column[0], "ties": column[1], key: value}
    wanted.pop("people")
    return next((r["of_distance"] for r in cells if all(r[k] == v for k, v in wanted.items())), None)


def _draw_people(axes: "Axes", result: Mapping) -> None:
    told = [row for row in result["rows"] if "weight" in row]
    people = list(dict.fromkeys(row["people"] for row in told))
    weights = list(dict.fromkeys(row["weight"] for row in told))
    numbers = [[r["of_distance"] for r in told if r["people"] == one] for one in people]
    skills = {row["people"]: ", ".join(f"{skill:g}" for skill in row["skills"]) for row in told}
    framed = (people.index(result["settings"]["default"]["people"]), 0)
    _draw_numbers(axes, numbers, [f"{one}\n({skills[one]})" for one in people], weights, framed)
    axes.set_title("People (skills) by weights")


def _draw_numbers(axes: "Axes", numbers, sides, heads, framed: tuple[int, int]) -> None:
    values = [[100 * n["value"] if n and n["value"] is not None else np.nan for n in row] for row in numbers]
    certain = [[bool(n and n["ci95"] and not n["ci95"][0] <= 0 <= n["ci95"][1]) for n in row] for row in numbers]
    draw_heat_grid(
        axes, values, certain, sides, heads, neutral=0.0, spread=20.0, words=_signed, outlined=framed
    )  # fmt: skip


def _signed(value: float) -> str:
    return f"{value:+.1f}".replace("-", "−")


def _epsilon(schedule: Sequence[float]) -> str:
    first, decay, _ = schedule
    return f"{first:g}" if decay == 1 else f"{first:g} × {decay:g}"
