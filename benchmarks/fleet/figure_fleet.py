"""Figure of `bench fleet`: refused moves by round for fleets of several sizes, and rounds to competence."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from lifelore.core.metrics import mean_estimate
from lifelore.figures.curves import draw_curves
from lifelore.figures.style import BLUE, GREEN, GREY, LIGHT, ORANGE, VERMILION, house_style, new_figure

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_COLOURS = (GREY, BLUE, GREEN, VERMILION)


def draw_fleet(
    curves: Mapping[int, Sequence[NDArray[np.float64]]],
    needed: Mapping[int, Sequence[int]],
    competent: float,
    title: str = "A fleet learns a building",
    measure: str = "refused moves a task",
) -> "Figure":
    """The figure: curves on the left, rounds to competence on the right, with 95 % intervals over buildings.

    Parameters
    ----------
    curves : mapping of number of robots to (rounds, 2) arrays
        Mean refused moves a task by round, of the fleet and of robots that know nothing, one array a building.
    needed : mapping of number of robots to rounds to competence, one a building
    competent : float
        Share of the measure of a robot that knows nothing at which a fleet is competent.
    title, measure : str
        Of the left panel: what is learnt, and what the curves show.
    """
    with house_style():
        figure = new_figure(9.8, 3.9)
        left, right = figure.subplots(1, 2)
        series, looks = {}, {}
        for colour, (robots, each) in zip(_COLOURS, curves.items(), strict=False):
            label = f"{robots} robots" if robots > 1 else "1 robot"
            own = np.stack([curve[:, 0] for curve in each])
            series[label] = {"mean": own.mean(axis=0), "error": 1.96 * own.std(axis=0) / np.sqrt(len(each))}
            looks[label] = {"color": colour}
        nothing = float(np.mean([curve[:, 1].mean() for each in curves.values() for curve in each]))
        draw_curves(
            left, None, series, looks=looks, title=title, xlabel="task of each robot",
            ylabel=measure,
            level=(competent * nothing, f"{competent:.0%} of a robot that knows nothing"),
        )  # fmt: skip
        sizes = list(needed)
        estimates = [mean_estimate(each) for each in needed.values()]
        means = [estimate.value for estimate in estimates]
        ends = np.array([estimate.ci95 or (estimate.value, estimate.value) for estimate in estimates])
        errors = np.abs(ends.T - means)
        right.errorbar(sizes, means, errors, color=BLUE, marker="o", markersize=5, capsize=3, label="measured")
        right.plot(
            sizes, [means[0] * sizes[0] / size for size in sizes], color=ORANGE, linestyle=(0, (2, 2)),
            label="the work shared without loss",
        )  # fmt: skip
        right.set_xscale("log", base=2)
        right.set_xticks(sizes, [str(size) for size in sizes])
        right.set(title="Time to competence", xlabel="robots", ylabel="tasks of each robot")
        right.set_ylim(bottom=0)
        right.grid(color=LIGHT)
        right.legend()
    return figure
