"""Figure of claim C3.12: learning with priors demonstrated by simulated people, and with self-trained priors."""

from collections.abc import Mapping, Sequence
from itertools import product
from statistics import mean

from lifelore.figures.heat_grid import draw_estimate_grid, frame_cells
from lifelore.figures.style import BLUE, GREEN, GREY, Axes, Figure, house_style, new_figure, two_rows
from reproduction.chapter3.c3_12_demonstrated_priors.run import VARIED, WITHOUT_PRIOR
from reproduction.chapter3.figures.reward_curves import draw_reward_curves
from reproduction.chapter3.learning.schedules import schedule_in_brief
from reproduction.engine.results_table import ResultsTable

COLOURS = {"uniform": GREY, "self-trained": BLUE, "shown": GREEN}
LOOK = {"neutral": 0.0, "spread": 80.0}


@house_style()
def draw(result: Mapping) -> Figure:
    """Learning curves by schedule above; the grid of open choices and the groups of people below."""
    settings = result["settings"]
    labels = {"shown": f"shown by one person ({settings['default']['people']}, simulated)"}
    figure = new_figure(12.4, 7.6)
    upper, lower = two_rows(figure, (1.0, 1.05))
    draw_reward_curves(upper, result, COLOURS, labels, banded=COLOURS)
    grid, people = lower.subplots(1, 2, width_ratios=[1.1, 1.0])
    _draw_grid(grid, result)
    _draw_people(people, result)
    lower.supxlabel(
        "Below: mean reward of an episode minus that with the self-trained prior, as a multiple of the optimal "
        "reward's size; the verdict asks for ±0.05 of it.\nIn brackets: the same in % of the distance from no "
        "prior to the optimum. Bold: the 95 % interval excludes 0. Framed: what the verdict reads.\nShaded: one "
        f"standard deviation across the {settings['test_tasks']} tasks of a run. People are simulated.",
        fontsize=8, color=GREY,
    )  # fmt: skip
    return figure


def _draw_grid(axes: Axes, result: Mapping) -> None:
    settings, default = result["settings"], result["settings"]["default"]
    keys = ("features", "schedule", "ties", "alpha0", "trajectories")
    table = ResultsTable((row for row in result["rows"] if "features" in row), keys)
    columns = list(product(settings["schedules"], settings["ties"]))
    lines = [("features", name, name.replace("phi", "φ")) for name in settings["features"]]
    lines += [("alpha0", n, f"α⁰ {n:g}") for n in settings["alpha0"] if n != default["alpha0"]]
    others = (n for n in settings["trajectories"] if n != default["trajectories"])
    lines += [("trajectories", n, f"{n} trajectories") for n in others]

    def number(key: str, value, schedule, ties: str) -> Mapping | None:
        cell = {name: default[name] for name in keys} | {"schedule": schedule, "ties": ties, key: value}
        found = table.select(**cell).records
        return found[0]["of_distance"] if found else None

    numbers = [[number(key, value, *column) for column in columns] for key, value, _ in lines]
    multiples = [_multiple_of_optimum(result, schedule) for schedule, _ in columns]
    framed = settings["features"].index(default["features"]), columns.index((default["schedule"], default["ties"]))
    heads = [f"{schedule_in_brief(schedule)},\nties {ties}" for schedule, ties in columns]
    _draw_both(axes, numbers, multiples, [words for *_, words in lines], heads)
    frame_cells(axes, framed)
    axes.set_title("The default person, by choices left open")


def _draw_people(axes: Axes, result: Mapping) -> None:
    table = ResultsTable((row for row in result["rows"] if "weight" in row), ("people", "weight"))
    people, weights = table.distinct("people"), table.distinct("weight")
    numbers = [[table.record(people=group, weight=w)["of_distance"] for w in weights] for group in people]
    skills = [", ".join(f"{skill:g}" for skill in table.record(people=group)["skills"]) for group in people]
    sides = [f"{group}\n({skill})" for group, skill in zip(people, skills, strict=True)]
    default = result["settings"]["default"]
    _draw_both(axes, numbers, [_multiple_of_optimum(result, default["schedule"])] * len(weights), sides, weights)
    for group in (default["people"], VARIED):
        if group in people:
            frame_cells(axes, (people.index(group), 0))
    axes.set_title("People (skills) by weights")


def _draw_both(
    axes: Axes,
    numbers: Sequence[Sequence[Mapping | None]],
    multiples: Sequence[float],
    rows: Sequence[str],
    columns: Sequence[str],
) -> None:
    """A table of shares of the distance, written as multiples of the optimum's size with the share below.

    `multiples` are the factors from one to the other, by column.
    """
    scaled = [
        [n and {"value": n["value"] * m, "ci95": n["ci95"]} for n, m in zip(row, multiples, strict=True)]
        for row in numbers
    ]
    shares = iter([n["value"] for row in numbers for n in row if n])
    draw_estimate_grid(
        axes, scaled, rows, columns, words=lambda value: f"{value:+.1f} ×\n({100 * next(shares):+.1f} %)", **LOOK
    )


def _multiple_of_optimum(result: Mapping, schedule: Sequence[float]) -> float:
    """The mean distance from no prior to the optimum under a schedule, over the optimal reward's mean size."""
    measured, default = result["measured"], result["settings"]["default"]["schedule"]
    at_default = (
        measured["shown_minus_self_of_optimal"]["value"] / measured["shown_minus_self_of_distance"]["value"]
    )
    distance = {
        tuple(row["schedule"]): measured["optimal_reward"]["value"] - mean(row["mean"])
        for row in result["rows"]
        if row.get("curve_of") == WITHOUT_PRIOR
    }
    return at_default * distance[tuple(schedule)] / distance[tuple(default)]
