"""Learning within a task: how good the learnt policy is against steps taken, early in a life and late."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.figures.learning_curve import draw_curve
from lifelore.figures.style import INK, house_style, new_figure

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_POINTS = 240


def draw_task_curves(
    panels: Mapping[str, Mapping[str, Sequence[ArrayLike]]], *, threshold: float = 0.8, title: str = ""
) -> "Figure":
    """A panel for each part of a life: mean over its tasks, with the band of the middle half of them.

    Parameters
    ----------
    panels : mapping
        Title of the panel to agent's name (a key of `style.COLOURS`) to traces, one a task: each
        (n_checks, 2), steps taken and share of the optimal return then.
    threshold : float
        Share at which a task counts as learnt; drawn as a line.
    title : str
    """
    from matplotlib.ticker import FuncFormatter, NullFormatter

    steps = step_grid([trace for agents in panels.values() for traces in agents.values() for trace in traces])
    with house_style():
        figure = new_figure(10.4, 4.4)
        row = figure.subplots(1, len(panels), squeeze=False, sharey=True)[0]
        for axes, (words, agents) in zip(row, panels.items(), strict=True):
            for name, traces in agents.items():
                shares = np.array([share_at(trace, steps) for trace in traces])
                band = np.quantile(shares, (0.25, 0.75), axis=0)
                draw_curve(axes, steps, shares.mean(axis=0), (band[0], band[1]), name)
            axes.axhline(threshold, color=INK, linestyle=(0, (1, 2)), linewidth=1.2, zorder=1)
            axes.set(
                xscale="log",
                xlim=(steps[0], steps[-1]),
                ylim=(-0.02, 1.02),
                xlabel="steps taken in the task (a run ends at the dotted line)",
            )
            axes.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:,.0f}"))
            axes.xaxis.set_minor_formatter(NullFormatter())
            axes.set_title(words)
        row[0].set_ylabel("share of optimal return")
        row[0].annotate(f"{100 * threshold:.0f} %", (0, threshold), (4, 3), xycoords=("axes fraction", "data"),
                        textcoords="offset points", fontsize=7.5)  # fmt: skip
        handles, labels = row[0].get_legend_handles_labels()
        figure.legend(handles, labels, loc="outside lower center", ncols=len(labels))
        figure.suptitle(title, x=0.01, ha="left")
    return figure


def step_grid(traces: Sequence[ArrayLike]) -> NDArray[np.float64]:
    """Evenly spaced steps on a log axis, from the first check of any trace to a little beyond the last."""
    ends = [(np.min(trace, axis=0)[0], np.max(trace, axis=0)[0]) for trace in traces if len(np.asarray(trace))]
    if not ends:
        return np.array([1.0, 10.0])
    first, last = min(end[0] for end in ends), max(end[1] for end in ends)
    return np.geomspace(first, 1.25 * max(last, 2 * first), _POINTS)


def share_at(trace: ArrayLike, steps: ArrayLike) -> NDArray[np.float64]:
    """A trace as a step function: its last share at or before each number of steps, in [0, 1].

    Before the first check it is 0, after the last it stays: a run that has ended keeps what it has. A policy
    that loses reward counts as 0.
    """
    trace = np.asarray(trace, float).reshape(-1, 2)
    # A grid point that rounding put just below a check still counts as that check.
    place = np.searchsorted(trace[:, 0], np.asarray(steps, float) * (1 + 1e-9), side="right")
    return np.clip(np.concatenate([[0.0], trace[:, 1]]), 0.0, 1.0)[place]
