"""Errors of a move's seconds by predictor, a dot a life, and refusals by predicted probability."""

from collections.abc import Mapping

from lifelore.figures.style import BLUE, GREY, Axes
from reproduction.figures.panels import panels

LABELS = {"travel": "travel", "last": "last time", "mean": "mean", "truth": "truth\nwithout noise"}


@panels(7.2, 3.2, 1, 2, grid="")
def draw(result: Mapping, of_moves: Axes, of_refusals: Axes) -> None:
    """Left: mean absolute errors. Right: share of refused moves of each bin, against the mean probability."""
    *errors, last = result["rows"]
    for place, row in enumerate(errors):
        colour = BLUE if row["method"] == "travel" else GREY
        of_moves.plot([place] * len(row["moves"]), row["moves"], "o", color=colour, alpha=0.5, ms=6, mew=0)
    of_moves.set(xticks=range(len(errors)), xticklabels=[LABELS[row["method"]] for row in errors])
    of_moves.set(ylabel="error of a move's seconds (s)", ylim=(0, None))
    of_moves.grid(axis="y")
    bins = [(predicted / n, refused / n) for n, predicted, refused in last["bins"] if n]
    of_refusals.plot([0, 1], [0, 1], color=GREY, linestyle=(0, (1, 2)))
    of_refusals.plot(*zip(*bins, strict=True), "o-", color=BLUE)
    of_refusals.set(xlabel="predicted probability of a refusal", ylabel="share of refused moves")
    of_refusals.grid()
