"""The belief in the true type by Algorithm 9 and by policy reuse, and when products as printed are 0."""

from collections.abc import Mapping

from lifelore.domains.ball_game.ball_game import SIZES
from lifelore.figures.style import INK, VERMILION, Axes
from reproduction.chapter4.ball_game.looks import size_lines
from reproduction.figures.panels import panels

SHOWN = (2, 20, 60)


@panels(8.4, 3.5, 1, 2, width_ratios=[1.5, 1])
def draw(result: Mapping, left: Axes, right: Axes) -> None:
    """A session of three sizes each: a line for policy reuse, dots for Algorithm 9."""
    *sessions, last = result["rows"]
    for session in sessions:
        size = SIZES[session["kind"]]
        if size in SHOWN:
            (name, look), (beat, reuse) = next(iter(size_lines([size]).items())), session["beliefs"]
            left.plot(range(1, len(reuse) + 1), reuse, label=name, linewidth=1.2, **look)
            left.plot(range(1, len(beat) + 1, 4), beat[::4], "o", ms=3.5, mew=0, **look)
    left.plot([], [], "o", ms=3.5, color=INK, label="Algorithm 9")
    left.plot([], [], color=INK, linewidth=1.2, label="policy reuse")
    left.set(xlabel="step of a session", ylabel="belief in the true type", ylim=(0, 1.02))
    left.figure.legend(*left.get_legend_handles_labels(), ncols=5, loc="outside lower center")
    right.hist(last["vanished"], bins=8, color=VERMILION)
    right.set(xlabel="step at which all products are 0", ylabel="sessions", title="As printed, never normalised")
