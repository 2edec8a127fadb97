"""Measures and rows of claim C5.3."""

from collections.abc import Mapping, Sequence

import numpy as np

from lifelore.core.learning.learning_metrics import jumpstart
from lifelore.core.metrics import Estimate, mean_estimate, ratio_estimate
from lifelore.experiments.chapter5.c5_03_priors_in_search.run import (
    ARMS_FORM,
    EVEN,
    FLAT,
    INDICES,
    KINDS,
    MOST,
    ORDER_FORM,
    PLAIN,
    PRUNED,
    SEARCH_FORM,
    WAYS,
)
from lifelore.experiments.engine.estimates import is_above, is_below, share_of

Found = dict[tuple, list[Mapping]]


def _by_way(results: Sequence[Mapping], use: str, keys: Sequence[str]) -> Found:
    """What tells the ways of one use apart to their numbers, maze by maze."""
    found: Found = {}
    for result in results:
        for numbers in result[use]:
            found.setdefault(tuple(numbers[key] for key in keys), []).append(numbers)
    return found


def _of(numbers: Sequence[Mapping], key: str) -> np.ndarray:
    return np.array([one[key] for one in numbers], float)


SEARCH_KEYS = ("kind", "form", "guides", "move", "simulations")
ORDER_KEYS = ("search", "kind", "form")
ARMS_KEYS = ("index", "kind", "form", "strength")


def _search_gains(results: Sequence[Mapping]) -> dict[tuple, dict[str, Estimate]]:
    """Each guided way: the share of goals reached, and how much more that is than without the prior."""
    found, gains = _by_way(results, "search", SEARCH_KEYS), {}
    for way, numbers in found.items():
        reached, plain = (_of(n, "reached") for n in (numbers, found[None, PLAIN, None, *way[3:]]))
        gains[way] = {"success": mean_estimate(reached)}
        gains[way] |= {key: mean_estimate(_of(numbers, key)) for key in ("steps", "collisions")}
        if way[0] is not None:
            gains[way]["gain"] = jumpstart(reached, plain)
    return gains


def _order_ratios(results: Sequence[Mapping]) -> dict[tuple, dict[str, Estimate]]:
    """Each order: nodes expanded and moves of the way as ratios to a random order's, and the share found."""
    found, ratios = _by_way(results, "depth_first", ORDER_KEYS), {}
    for way, numbers in found.items():
        plain = found["depth first" if way[0] == PRUNED else way[0], None, PLAIN]
        ratios[way] = {key: mean_estimate(_of(numbers, key)) for key in ("expanded", "moves", "reached")}
        if way[1] is not None:
            ratios[way]["ratio"] = ratio_estimate(_of(numbers, "expanded"), _of(plain, "expanded"))
            ratios[way]["moves_ratio"] = ratio_estimate(_of(numbers, "moves"), _of(plain, "moves"))
    return ratios


def _arms_ratios(settings: Mapping, results: Sequence[Mapping]) -> dict[tuple, dict[str, Estimate]]:
    """Each start of the arms: regret, and its ratio to that of a flat start and of evenly spread pseudo-counts."""
    found, ratios = _by_way(results, "bandit", ARMS_KEYS), {}
    for way, numbers in found.items():
        lost = _of(numbers, "regret")
        ratios[way] = {"regret": mean_estimate(lost)}
        if way[1] is not None:
            flat, even = found[way[0], None, FLAT, 0.0], found[way[0], None, EVEN, settings["strength"]]
            ratios[way]["ratio"] = ratio_estimate(lost, _of(flat, "regret"))
            ratios[way]["even_ratio"] = ratio_estimate(lost, _of(even, "regret"))
    return ratios


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """The defaults of each use, and in how many ways of guiding a tree search the prior helps or harms."""
    gains, orders = _search_gains(results), _order_ratios(results)
    arms = _arms_ratios(settings, results)
    measured = {}
    for n in settings["simulations"]:
        measured[f"success_uniform_{n}"] = gains[None, PLAIN, None, MOST, n]["success"]
    for kind in KINDS:
        for n in settings["simulations"]:
            found = gains[kind, SEARCH_FORM, *WAYS[0], n]
            measured |= {f"success_{kind}_{n}": found["success"], f"gain_{kind}_{n}": found["gain"]}
        ordered = orders["depth first", kind, ORDER_FORM]
        measured |= {f"nodes_ratio_{kind}": ordered["ratio"], f"moves_ratio_{kind}": ordered["moves_ratio"]}
        measured[f"deepening_ratio_{kind}"] = orders["deepening", kind, ORDER_FORM]["ratio"]
        pruned = orders[PRUNED, kind, ORDER_FORM]
        measured |= {f"pruned_ratio_{kind}": pruned["ratio"], f"pruned_found_{kind}": pruned["reached"]}
        for index in INDICES:
            found = arms[index, kind, ARMS_FORM, settings["strength"]]
            measured[f"{index}_ratio_{kind}"] = found["ratio"]
            measured[f"{index}_even_ratio_{kind}"] = found["even_ratio"]
    every = [found["gain"] for found in gains.values() if "gain" in found]
    measured["share_of_ways_better"] = share_of([is_above(gain, 0.0) for gain in every])
    measured["share_of_ways_worse"] = share_of([is_below(gain, 0.0) for gain in every])
    return measured


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """Every way of each use with its numbers, then the curves of regret."""
    uses = (
        ("search", SEARCH_KEYS, _search_gains(results)),
        ("depth first", ORDER_KEYS, _order_ratios(results)),
        ("bandit", ARMS_KEYS, _arms_ratios(settings, results)),
    )
    kept = [
        {"use": use, **dict(zip(keys, way, strict=True)), **{name: e.to_dict() for name, e in numbers.items()}}
        for use, keys, found in uses
        for way, numbers in found.items()
    ]
    return kept + _curve_rows(results)


def _curve_rows(results: Sequence[Mapping]) -> list[dict]:
    """Mean regret over the pulls with its standard error over mazes."""
    found = _by_way(results, "bandit", ARMS_KEYS)
    kept = []
    for way, numbers in found.items():
        if "curve" in numbers[0]:
            curves = np.array([one["curve"] for one in numbers])
            error = curves.std(axis=0, ddof=1) / len(curves) ** 0.5 if len(curves) > 1 else 0 * curves[0]
            curve = {"mean": curves.mean(axis=0).round(4).tolist(), "error": error.round(4).tolist()}
            kept.append({"use": "curve", **dict(zip(ARMS_KEYS, way, strict=True)), **curve})
    return kept
