"""Measures and rows of claim C2.1."""

import json
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from functools import lru_cache
from itertools import product

import numpy as np

from lifelore.core.metrics import RESAMPLES, Estimate, mean_estimate
from lifelore.core.relations import BOTH, CORE_RELATIONS, ON, SYMMETRIC
from lifelore.core.streams import stream
from lifelore.experiments.chapter2.pair_validation import (
    DROPS,
    VOTES,
    Reading,
    as_scene,
    as_seen,
    cross_validated,
    in_given_order,
    told_by_neighbours,
)
from lifelore.experiments.chapter2.relation_scoring import JudgedPair, score, share
from lifelore.experiments.chapter2.tabletop_pairs import BESIDE_US, KERNELS, Row, kernel_name
from lifelore.experiments.engine.cell_store import canonical
from lifelore.perception.peers import PEERS
from lifelore.perception.relations.relation_classifier import RelationClassifier


def hardest_margin(judged: Sequence[JudgedPair]) -> Estimate:
    """Least recall of the other relations less that of *both*; pairs of each relation resampled (percentiles)."""
    right = {
        name: np.array([pair.exact for pair in judged if pair.truth.relation == name], float)
        for name in CORE_RELATIONS
    }
    right = {name: answers for name, answers in right.items() if len(answers)}
    if BOTH not in right or len(right) < 2:
        return Estimate(float("nan"), float("nan"), None, 0)
    rng = stream(len(judged), "recalls resampled")
    drawn = {
        name: rng.binomial(len(answers), answers.mean(), RESAMPLES) / len(answers)
        for name, answers in right.items()
    }
    others = [name for name in right if name != BOTH]
    value = float(min(right[name].mean() for name in others) - right[BOTH].mean())
    spread = np.min([drawn[name] for name in others], axis=0) - drawn[BOTH]
    low, high = np.quantile(spread, [0.025, 0.975])
    return Estimate(value, value, (float(low), float(high)), len(judged))


def _given_measures(sets: Mapping[int | str, Sequence[Row]]) -> dict[str, Estimate]:
    by_set = given_order(sets, Reading(), real=False)
    judged = [pair for one in by_set for pair in one]
    misread = [pair for pair in judged if pair.truth.relation == BOTH and not pair.exact]
    scored = score(judged)
    assert scored is not None
    rate = max(Counter(pair.truth.relation for pair in judged).values()) / len(judged)
    found = {
        "right_in_given_order": scored.exact,
        "right_in_given_order_by_data_set": mean_estimate([np.mean([p.exact for p in one]) for one in by_set]),
        "majority_rate": Estimate(rate, rate, None, len(judged)),
        "right_less_majority_rate": _less(scored.exact, rate),
        "macro_f1_in_given_order": scored.macro_f1,
        **{f"recall_in_given_order_{name}": number for name, number in scored.recall.items()},
        "next_hardest_recall_less_both": hardest_margin(judged),
    }
    if misread:
        found["misread_both_said_to_be_on"] = share(misread, lambda pair: pair.relation == ON)
    real = score([pair for one in given_order(sets, Reading(), real=True) for pair in one])
    if real:
        found["right_in_given_order_real"] = real.exact
        found["macro_f1_in_given_order_real"] = real.macro_f1
        found |= {f"recall_in_given_order_real_{name}": number for name, number in real.recall.items()}
    return found


def _less(number: Estimate, rate: float) -> Estimate:
    ends = (number.ci95[0] - rate, number.ci95[1] - rate) if number.ci95 else None
    return Estimate(number.value - rate, number.median - rate, ends, number.n)


def _inferred_measures(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    found = {}
    for method, kinds in inferred(settings["folds"], canonical(list(results))).items():
        for kind, judged in kinds.items():
            scored = score(judged)
            assert scored is not None
            place = f"{method.replace(' ', '_')}_{kind}"
            found |= {f"exact_{place}": scored.exact, f"macro_f1_{place}": scored.macro_f1}
            found |= {f"on_{place}": scored.on, f"adjacent_{place}": scored.adjacent}
    return found


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """With A and B given first, then every method with the direction inferred."""
    return _given_measures(data_sets(results)) | _inferred_measures(settings, results)


OURS, THESIS = "lifelore", "thesis"


def data_sets(results: Sequence[Mapping]) -> dict[int | str, list[Row]]:
    """The rows of each data set, by its number, and of the real scenes under "real" where there are any."""
    found: dict[int | str, list[Row]] = {}
    for result in results:
        found.setdefault(result["set"], []).extend(result["rows"])
    return found


def given_order(sets: Mapping[int | str, Sequence[Row]], reading: Reading, real: bool) -> list[list[JudgedPair]]:
    """Each data set told by itself, leave one scene out; the real scenes alone where `real`."""
    return [
        in_given_order(rows, told_by_neighbours(rows, reading).united(len(rows)))
        for name, rows in sets.items()
        if (name == "real") == real
    ]


def confusion(judged: Sequence[JudgedPair]) -> list[list[int]]:
    """Predicted by actual, in the order of `CORE_RELATIONS`."""
    counts = Counter((pair.relation, pair.truth.relation) for pair in judged)
    return [[counts[said, true] for true in CORE_RELATIONS] for said in CORE_RELATIONS]


def readings(settings: Mapping) -> list[Reading]:
    """The grid of what the thesis leaves open."""
    kernels = [kernel_name(*kernel) for kernel in KERNELS]
    return [Reading(*one) for one in product(kernels, DROPS, VOTES, (None, settings["omega"]))]


def _grid_rows(settings: Mapping, sets: Mapping[int | str, Sequence[Row]]) -> list[dict]:
    rows = []
    for reading in readings(settings):
        row = {"grid": {**vars(reading)}}
        for name, real in (("simulated", False), ("real", True)):
            judged = [pair for one in given_order(sets, reading, real) for pair in one]
            if judged:
                row[name] = _counts(judged)
        rows.append(row)
    return rows


def _counts(judged: Sequence[JudgedPair]) -> dict[str, list[int]]:
    """[right, of] in all and by relation."""
    found = {"all": [sum(pair.exact for pair in judged), len(judged)]}
    for name in CORE_RELATIONS:
        own = [pair.exact for pair in judged if pair.truth.relation == name]
        if own:
            found[name] = [sum(own), len(own)]
    return found


def _methods(folds: int) -> dict[str, tuple[Callable, Callable, int | None]]:
    """Of each method a fresh model, its look at a row, and how many folds (None: leave one scene out)."""
    return {
        OURS: (lambda: RelationClassifier(symmetric=SYMMETRIC), as_scene, folds),
        THESIS: (lambda: RelationClassifier("displacement", symmetric=SYMMETRIC), as_scene, None),
        **{name: (PEERS[name], as_seen(name), None) for name in BESIDE_US},
    }


@lru_cache(maxsize=2)
def inferred(folds: int, results: str) -> dict[str, dict[str, list[JudgedPair]]]:
    """By method, the pairs of all simulated data sets, each told by itself, and of the real scenes.

    Kept, since measures and rows both ask, and our trees take their time.
    """
    sets = data_sets(json.loads(results))
    found: dict[str, dict[str, list[JudgedPair]]] = {}
    for name, (new_model, look, own_folds) in _methods(folds).items():
        kinds: dict[str, list[JudgedPair]] = {}
        for number, rows in sets.items():
            kind = "real" if number == "real" else "simulated"
            n_folds = None if kind == "real" else own_folds
            kinds.setdefault(kind, []).extend(cross_validated(rows, new_model, look, n_folds))
        found[name] = kinds
    return found


def _inferred_rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    rows = []
    for method, kinds in inferred(settings["folds"], canonical(list(results))).items():
        for kind, judged in kinds.items():
            scored = score(judged)
            assert scored is not None
            recall = {name: number.to_dict() for name, number in scored.recall.items()}
            rows.append({"method": method, "scenes": kind, "exact": scored.exact.to_dict(), "recall": recall})
    return rows


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """Confusion matrices, the grid, and recalls by method."""
    sets = data_sets(results)
    matrices = []
    for name, real in (("simulated", False), ("real", True)):
        judged = [pair for one in given_order(sets, Reading(), real) for pair in one]
        if judged:
            matrices.append({"confusion": name, "predicted_by_actual": confusion(judged)})
    return matrices + _inferred_rows(settings, results) + _grid_rows(settings, sets)
