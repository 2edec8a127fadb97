"""C4.13: how fast BEAT names the right type, and which types it confuses. Thesis: §4.8.5.2, Figure 4.17.

Players who have reached the goal keep their belief: otherwise the average would be that of slow players.
"""

from collections.abc import Iterable, Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from lifelore.core.metrics import Estimate, mean_estimate
from lifelore.domains.ball_game.ball_game import SIZES
from lifelore.figures.style import GREY, Axes
from reproduction.chapter4.ball_game import trials
from reproduction.chapter4.ball_game.games import check_games
from reproduction.chapter4.ball_game.looks import size_lines
from reproduction.chapter4.ball_game.trials import BEAT
from reproduction.engine.estimates import exact_share, exact_value
from reproduction.figures.curves import draw_curves
from reproduction.figures.panels import panels

cells, check, run_cell, shared = trials.cells, check_games, trials.run_cell, trials.SHARED


def size_ratio(counts: Sequence[int], size: int) -> Estimate:
    """Mean of the size named over the true size, from how often each size was named."""
    return mean_estimate(np.repeat(SIZES, counts) / size)


def numbers(result: Mapping, instead: Mapping[str, str]) -> dict[str, Estimate]:
    """Ratios half-way through the first episode, and pairs of sizes that are confused."""
    half: NDArray = np.array(result["half"][instead.get(BEAT, BEAT)])
    ratios = [size_ratio(counts, size) for counts, size in zip(half, SIZES, strict=True)]
    off = [abs(ratio.value - 1) for ratio in ratios]
    pairs = (half + half.T)[np.triu_indices(len(SIZES), 1)]
    return {
        "ratio_2": ratios[0],
        "ratio_5": ratios[1],
        "worst_ratio_10_to_60": ratios[2 + int(np.argmax(off[2:]))],
        "smallest_off_beyond_others": exact_value(off[0] - max(off[1:]), len(off)),
        "pairs_confused_more_often": exact_value((pairs > pairs[0]).sum(), len(pairs)),
        "right_half": exact_share(np.repeat([True, False], [half.trace(), half.sum() - half.trace()])),
    }


def readings(settings: Mapping, results: Sequence[Mapping]) -> Iterable[tuple[dict, dict[str, Estimate]]]:
    """The numbers of every game, and of the first with each other choice that BEAT has."""
    return (one for one in trials.readings_of(results, numbers) if _is_of_beat(one[0]))


def _is_of_beat(reading: Mapping[str, str]) -> bool:
    return {reading["EXP-3's pull"], reading["static speed"]} == {"default"}


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """By true size, the mean ratio step by step of the first episode."""
    first = results[0]
    return [{"size": size, "ratio": ratio} for size, ratio in zip(SIZES, first["ratio"][BEAT], strict=True)] + [
        {"half_of_first": first["half_of_first"]}
    ]


@panels(6.4, 3.8)
def draw(result: Mapping, axes: Axes) -> None:
    """The most likely size over the true size, step by step of the first episode (Figure 4.17).

    A curve for each true size.
    """
    *sizes, last = result["rows"]
    series = {f"b = {row['size']}": {"mean": row["ratio"]} for row in sizes}
    draw_curves(axes, None, series, looks=size_lines([row["size"] for row in sizes], linewidth=1.6))
    axes.axhline(1, color=GREY, linestyle=(0, (4, 2)), linewidth=1)
    axes.axvline(last["half_of_first"], color=GREY, linewidth=1)
    axes.annotate(
        "half of the median\nfirst episode", (last["half_of_first"], 1), (4, -2), va="top", fontsize=8,
        xycoords=("data", "axes fraction"), textcoords="offset points", color=GREY,
    )  # fmt: skip
    axes.set(xlabel="step of the first episode", ylabel="most likely size / true size", ylim=(0, None))
    axes.legend(title="true size", ncols=2)
