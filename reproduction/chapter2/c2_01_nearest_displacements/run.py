"""C2.1: relations of pairs by the nearest displacements between contact points, each scene left out (§2.4.1).

A and B are given, as in the thesis's pictures; the label of a pair is the union over its displacements.
"""

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import product

import numpy as np

from lifelore.core.intervals import RESAMPLES, percentile_interval
from lifelore.core.metrics import Estimate
from lifelore.core.relations import BOTH, CORE_RELATIONS, ON
from lifelore.core.streams import stream
from lifelore.figures.style import BLUE, GREY, INK, PAPER, VERMILION, Axes, Figure, new_figure
from reproduction.chapter2.scenes import tabletop_pairs
from reproduction.chapter2.scenes.tabletop_pairs import Row, data_sets, simulated_sets
from reproduction.chapter2.scoring.pair_validation import CONTACT_READINGS, WEIGHTS, Reading, votes_of_neighbours
from reproduction.chapter2.scoring.relation_scoring import less_rate
from reproduction.engine.estimates import UNMEASURED, exact_share

cells, run_cell, shared = tabletop_pairs.pair_cells, tabletop_pairs.run_cell, tabletop_pairs.SETTINGS_OF_A_CELL
Answer = tuple[str, str]
"""The true relation of a pair, and the predicted one."""


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """The measures of the simulated pairs at the default, and the share right of the real pairs."""
    real = answers([data_sets(results).get("real", [])], Reading())
    right = exact_share(true == said for true, said in real)
    return measures(answers(simulated_sets(results), Reading())) | {"right_of_real": right}


def readings(settings: Mapping, results: Sequence[Mapping]) -> Iterator[tuple[dict, dict[str, Estimate]]]:
    """The measures of the simulated pairs for every kernel, threshold, weight of votes and longest vote."""
    sets = simulated_sets(results)
    for base, votes, omega in product(CONTACT_READINGS, WEIGHTS, (None, settings["omega"])):
        reading = replace(base, votes=votes, omega=omega)
        found = measures(answers(sets, reading))
        yield {key: value for key, value in vars(reading).items() if key != "k"}, found


def answers(sets: Sequence[Sequence[Row]], reading: Reading) -> list[Answer]:
    """The pairs of each data set, each scene classified by the others of its set."""
    return [
        (row["relation"], said)
        for rows in sets
        if rows
        for row, said in zip(rows, votes_of_neighbours(rows, reading).relations(len(rows)), strict=True)
    ]


def measures(pairs: Sequence[Answer]) -> dict[str, Estimate]:
    """Share right, the same less the majority's rate, how much harder *both* is, and how it is misread."""
    right = exact_share(true == said for true, said in pairs)
    rate = max(Counter(true for true, _ in pairs).values()) / len(pairs)
    return {
        "right": right,
        "right_less_majority": less_rate(right, rate),
        "next_hardest_recall_less_both": hardest_margin(pairs),
        "misread_both_as_on": exact_share(said == ON for true, said in pairs if true == BOTH != said),
    }


def hardest_margin(pairs: Sequence[Answer]) -> Estimate:
    """Least recall of the other relations less that of *both*; pairs of each relation resampled (percentiles)."""
    counts = Counter(true for true, _ in pairs)
    if BOTH not in counts or len(counts) < 2:
        return UNMEASURED
    recalls = {name: sum(said == name == true for true, said in pairs) / n for name, n in counts.items()}
    rng = stream(len(pairs), "recalls resampled")
    drawn = {name: rng.binomial(counts[name], recalls[name], RESAMPLES) / counts[name] for name in recalls}
    both, of_both = recalls.pop(BOTH), drawn.pop(BOTH)
    value, spread = min(recalls.values()) - both, np.min(list(drawn.values()), axis=0) - of_both
    return Estimate(value, value, percentile_interval(spread), len(pairs))


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """Confusion matrices of the simulated and of the real pairs."""
    kinds = {"simulated": simulated_sets(results), "real": [data_sets(results).get("real", [])]}
    found = {kind: answers(sets, Reading()) for kind, sets in kinds.items()}
    return [{"confusion": kind, "predicted_by_actual": confusion(pairs)} for kind, pairs in found.items() if pairs]


def confusion(pairs: Sequence[Answer]) -> list[list[int]]:
    """Predicted by actual, in the order of `CORE_RELATIONS`."""
    counts = Counter(pairs)
    return [[counts[true, predicted] for true in CORE_RELATIONS] for predicted in CORE_RELATIONS]


PRINTED = [[64, 6, 13, 0], [2, 20, 5, 0], [4, 5, 12, 0], [0, 1, 0, 0]]
"""Figure 2.5: predicted by actual, in the order of `CORE_RELATIONS`."""


def draw(result: Mapping) -> Figure:
    """The printed confusion matrix beside ours, of simulated and of real pairs (Figure 2.5).

    The matrices side by side.
    """
    matrices = {"thesis, printed": PRINTED}
    matrices |= {f"here, {row['confusion']} pairs": row["predicted_by_actual"] for row in result["rows"]}
    figure = new_figure(9.6, 3.5)
    every = figure.subplots(1, len(matrices), squeeze=False)[0]
    for axes, (title, matrix) in zip(every, matrices.items(), strict=True):
        draw_confusion(axes, np.asarray(matrix), title)
    return figure


def draw_confusion(axes: Axes, counts: np.ndarray, title: str) -> None:
    """A matrix, its diagonal blue and the rest vermilion, by the share of the column."""
    from matplotlib.colors import LinearSegmentedColormap

    labels, actual = CORE_RELATIONS, counts.sum(axis=0)
    share = counts / np.maximum(1, actual)
    signed = np.where(np.eye(len(labels), dtype=bool), share, -share)
    shades = LinearSegmentedColormap.from_list("right or wrong", [VERMILION, PAPER, BLUE])
    axes.imshow(signed, cmap=shades, vmin=-1.15, vmax=1.15)
    for (row, column), count in np.ndenumerate(counts):
        colour = GREY if count == 0 else PAPER if share[row, column] > 0.62 else INK
        weight = "bold" if row == column else "normal"
        axes.text(column, row, f"{count:g}", ha="center", va="center", color=colour, fontweight=weight)
    recalls = [f"{100 * share[k, k]:.0f} %" if n else "–" for k, n in enumerate(actual)]
    axes.set_xticks(range(len(labels)), [f"{label}\n{part}" for label, part in zip(labels, recalls, strict=True)])
    axes.set_yticks(range(len(labels)), labels)
    axes.set(xlabel="actual, with its recall", ylabel="predicted")
    axes.set_title(f"{title}\n{np.trace(counts):g} of {counts.sum():g} right", fontsize=9)
    axes.tick_params(which="both", length=0)
    axes.spines[:].set_visible(False)
