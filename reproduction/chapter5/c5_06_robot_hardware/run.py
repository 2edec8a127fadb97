"""C5.6: how many tasks a trial of the whole agent on a robot needs; the trial itself was not made. Thesis: §5.2.

``docs/robot_trial.md`` is the protocol; the statements are filed for it and name measures that only a robot gives.
"""

from collections.abc import Mapping, Sequence

import numpy as np
from scipy.stats import nct, t

from lifelore.core.metrics import Estimate
from lifelore.figures.style import BLUE, INK, SKY, Axes
from reproduction.figures.panels import panels


def cells(settings: Mapping) -> list[dict]:
    """One for each size of the effect."""
    return [{"effect": effect} for effect in settings["effects"]]


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """The power of a trial by its number of tasks; nothing is random."""
    return {**cell, "power": [power(cell["effect"], n) for n in settings["tasks"]]}


def power(effect: float, tasks: int) -> float:
    """Probability that the 95 % interval of a mean of paired differences lies above 0.

    Parameters
    ----------
    effect : float
        True mean of the differences in their standard deviations; the differences are Gaussian.
    tasks : int
        Number of pairs, at least 2.
    """
    bound = t.ppf(0.975, tasks - 1)
    return float(nct.sf(bound, tasks - 1, effect * np.sqrt(tasks)))


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """Nothing: no robot was at hand."""
    return {}


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """The curves of power."""
    return [dict(result) for result in results]


@panels(5.2, 3.2)
def draw(result: Mapping, axes: Axes) -> None:
    """Power of a trial on a robot by its number of tasks.

    The figure from the result: a curve for each size of the effect.
    """
    for row, colour in zip(result["rows"], (SKY, BLUE, INK), strict=False):
        label = f"{row['effect']:g} standard deviations"
        axes.plot(result["settings"]["tasks"], row["power"], "o-", ms=3.5, color=colour, label=label)
    axes.set(xlabel="tasks, each with every agent", ylabel="power", ylim=(0, 1.02), title="Length of a trial")
    axes.legend(loc="lower right", title="true difference")
