"""Claim C2.1: scores of pairs with A and B given, with the direction inferred, and over the grid (§2.4.1)."""

from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from itertools import product
from typing import NamedTuple

import numpy as np

from lifelore.core.metrics import RESAMPLES, Estimate
from lifelore.core.relations import BOTH, CORE_RELATIONS, ON, SYMMETRIC
from lifelore.core.streams import stream
from lifelore.perception.peers import PEERS
from lifelore.perception.relations.relation_classifier import RelationClassifier
from reproduction.chapter2.scenes import tabletop_pairs
from reproduction.chapter2.scenes.tabletop_pairs import BESIDE_US, KERNELS, Row, data_sets, kernel_name
from reproduction.chapter2.scoring.pair_validation import (
    AS_PRINTED,
    DROPS,
    WEIGHTS,
    Reading,
    as_scene,
    as_seen,
    cross_validated,
    in_given_order,
    votes_of_neighbours,
)
from reproduction.chapter2.scoring.relation_scoring import JudgedPair, less_rate, score, score_row, share
from reproduction.engine.estimates import UNMEASURED, is_above, share_of

SCENES = {"simulated": False, "real": True}
cells, run_cell, shared = tabletop_pairs.pair_cells, tabletop_pairs.run_cell, tabletop_pairs.SETTINGS_OF_A_CELL


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """Of the simulated pairs with A and B given: share right, beside the majority's rate, and how *both* fares.

    Then the share right as printed, where contacts of fewer than seven support vectors are dropped, and the share
    of the `readings` in which all that the thesis's sentences say holds by its intervals.
    """
    sets = data_sets(results)
    in_grid = [sentences(given_order(sets, reading, real=False)) for reading in readings(settings)]
    said = [is_above(s.less_majority, 0) and is_above(s.hardest, 0) and is_above(s.as_on, 0.5) for s in in_grid]
    default = sentences(given_order(sets, Reading(), real=False))
    return {
        "right_in_given_order": default.right,
        "right_less_majority_rate": default.less_majority,
        "next_hardest_recall_less_both": default.hardest,
        "misread_both_said_to_be_on": default.as_on,
        "right_as_printed": sentences(given_order(sets, AS_PRINTED, real=False)).right,
        "readings_in_which_all_is_so": share_of(said),
    }


class Sentences(NamedTuple):
    """What the thesis's sentences are about.

    The share right; the same less the majority's rate; the next hardest recall less that of *both*; and of the
    misread pairs that are *both* the share said to be *on*.
    """

    right: Estimate
    less_majority: Estimate
    hardest: Estimate
    as_on: Estimate


def sentences(judged: Sequence[JudgedPair]) -> Sentences:
    """Of simulated pairs, each of a scene of its own."""
    right = share(judged, lambda pair: pair.exact)
    rate = max(Counter(pair.truth.relation for pair in judged).values()) / len(judged)
    misread = [pair for pair in judged if pair.truth.relation == BOTH and not pair.exact]
    as_on = share(misread, lambda pair: pair.relation == ON) if misread else UNMEASURED
    return Sentences(right, less_rate(right, rate), hardest_margin(judged), as_on)


def hardest_margin(judged: Sequence[JudgedPair]) -> Estimate:
    """Least recall of the other relations less that of *both*; pairs of each relation resampled (percentiles)."""
    counts = {name: number for name, number in right_and_all(judged).items() if name != "all"}
    if BOTH not in counts or len(counts) < 2:
        return UNMEASURED
    rng = stream(len(judged), "recalls resampled")
    drawn = {name: rng.binomial(n, right / n, RESAMPLES) / n for name, (right, n) in counts.items()}
    recalls = {name: right / n for name, (right, n) in counts.items()}
    both, of_both = recalls.pop(BOTH), drawn.pop(BOTH)
    value, spread = min(recalls.values()) - both, np.min(list(drawn.values()), axis=0) - of_both
    low, high = np.quantile(spread, [0.025, 0.975])
    return Estimate(value, value, (float(low), float(high)), len(judged))


def given_order(sets: Mapping[int | str, Sequence[Row]], reading: Reading, real: bool) -> list[JudgedPair]:
    """The judged pairs of each simulated data set, or of the real scenes; each scene is left out in turn."""
    return [
        pair
        for name, rows in sets.items()
        if (name == "real") == real
        for pair in in_given_order(rows, votes_of_neighbours(rows, reading).relations(len(rows)))
    ]


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """Confusion matrices with scores, scores by method with the direction inferred, and counts over the grid."""
    sets = data_sets(results)
    found: list[dict] = []
    for name, real in SCENES.items():
        judged = given_order(sets, Reading(), real)
        scored = score(judged)
        if scored:
            matrix = {"confusion": name, "predicted_by_actual": confusion(judged)}
            found.append(matrix | score_row(scored, ("exact", "macro_f1")))
    for method, kinds in inferred(settings["folds"], sets).items():
        scores = {kind: score(judged) for kind, judged in kinds.items()}
        found += [{"method": method, "scenes": kind, **score_row(s)} for kind, s in scores.items() if s]
    for reading in readings(settings):
        judged = {name: given_order(sets, reading, real) for name, real in SCENES.items()}
        found.append(
            {"grid": vars(reading), **{name: right_and_all(pairs) for name, pairs in judged.items() if pairs}}
        )
    return found


def readings(settings: Mapping) -> list[Reading]:
    """The grid of choices that the thesis leaves open."""
    kernels = [kernel_name(*kernel) for kernel in KERNELS]
    return [Reading(*choice) for choice in product(kernels, DROPS, WEIGHTS, (None, settings["omega"]))]


def confusion(judged: Sequence[JudgedPair]) -> list[list[int]]:
    """Predicted by actual, in the order of `CORE_RELATIONS`."""
    counts = Counter((pair.relation, pair.truth.relation) for pair in judged)
    return [[counts[predicted, true] for true in CORE_RELATIONS] for predicted in CORE_RELATIONS]


def right_and_all(judged: Sequence[JudgedPair]) -> dict[str, list[int]]:
    """[right, all] of all pairs and of each relation that occurs."""
    own = {name: [pair.exact for pair in judged if pair.truth.relation == name] for name in CORE_RELATIONS}
    every = {"all": [pair.exact for pair in judged], **own}
    return {name: [sum(answers), len(answers)] for name, answers in every.items() if answers}


def inferred(folds: int, sets: Mapping[int | str, Sequence[Row]]) -> dict[str, dict[str, list[JudgedPair]]]:
    """By method and kind of scenes the judged pairs, each data set by itself; the direction is inferred."""
    found: dict[str, dict[str, list[JudgedPair]]] = {}
    for method, (new_model, look, own_folds) in methods(folds).items():
        for number, pairs in sets.items():
            kind, n_folds = ("real", None) if number == "real" else ("simulated", own_folds)
            found.setdefault(method, {}).setdefault(kind, []).extend(
                cross_validated(pairs, new_model, look, n_folds)
            )
    return found


def methods(folds: int) -> dict[str, tuple[Callable, Callable, int | None]]:
    """By method a fresh model, its view of a row, and the number of folds (None: leave one scene out)."""
    return {
        "lifelore": (lambda: RelationClassifier(symmetric=SYMMETRIC), as_scene, folds),
        "thesis": (lambda: RelationClassifier("displacement", symmetric=SYMMETRIC), as_scene, None),
        **{name: (PEERS[name], as_seen(name), None) for name in BESIDE_US},
    }
