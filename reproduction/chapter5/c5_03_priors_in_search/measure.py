"""Measures and rows of claim C5.3: gains of search, nodes expanded and regret, with the prior and without."""

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from lifelore.core.metrics import Estimate
from reproduction.chapter5.c5_03_priors_in_search import run
from reproduction.engine.estimates import is_above, is_below, share_of
from reproduction.engine.results_table import ResultsTable

SEARCH_KEYS = ("kind", "form", "guides", "move", "simulations")
ORDER_KEYS = ("search", "kind", "form")
ARMS_KEYS = ("index", "kind", "form", "strength")
Row = dict[str, Any]


def _ways(results: Sequence[Mapping], use: str, keys: Sequence[str]) -> Iterator[tuple[ResultsTable, Row]]:
    """Each way of one use, with the table of all of them; every maze has the same ways."""
    table = ResultsTable.nested(results, use, keys)
    yield from ((table, {key: way[key] for key in keys}) for way in results[0][use])


def _searches(results: Sequence[Mapping]) -> Iterator[Row]:
    """Each way of tree search: the share of goals reached, and how much more that is than without the prior."""
    for table, way in _ways(results, "search", SEARCH_KEYS):
        row = {"use": "search", **way, "success": table.mean("reached", **way)}
        row |= {key: table.mean(key, **way) for key in ("steps", "collisions")}
        if way["kind"] is not None:
            plain = {**way, "kind": None, "form": run.PLAIN, "guides": None}
            row["gain"] = table.difference("reached", way, plain)
        yield row


def _orders(results: Sequence[Mapping]) -> Iterator[Row]:
    """Each order: nodes expanded and moves of the path as ratios to a random order's, and the share found."""
    for table, way in _ways(results, "depth_first", ORDER_KEYS):
        row = {"use": "depth first", **way}
        row |= {key: table.mean(key, **way) for key in ("expanded", "moves", "reached")}
        if way["kind"] is not None:
            search = "depth first" if way["search"] == run.PRUNED else way["search"]
            plain = {"search": search, "kind": None, "form": run.PLAIN}
            row["ratio"] = table.ratio("expanded", way, plain)
            row["moves_ratio"] = table.ratio("moves", way, plain)
        yield row


def _arms(settings: Mapping, results: Sequence[Mapping]) -> Iterator[Row]:
    """Each start of the arms: regret, and its ratio to that of a flat start and of evenly spread pseudo-counts."""
    for table, way in _ways(results, "bandit", ARMS_KEYS):
        row = {"use": "bandit", **way, "regret": table.mean("regret", **way)}
        if way["kind"] is not None:
            row["ratio"] = table.ratio("regret", way, {**way, "kind": None, "form": run.FLAT, "strength": 0.0})
            even = {**way, "kind": None, "form": run.EVEN, "strength": settings["strength"]}
            row["even_ratio"] = table.ratio("regret", way, even)
        yield row


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """The defaults of each use, and in how many ways of guiding a tree search the prior helps or harms."""
    searches, orders = ResultsTable(_searches(results), SEARCH_KEYS), ResultsTable(_orders(results), ORDER_KEYS)
    arms = ResultsTable(_arms(settings, results), ARMS_KEYS)
    measured, (guides, move) = {}, run.WAYS[0]
    for kind in run.KINDS:
        for n in settings["simulations"]:
            default = {"form": run.SEARCH_FORM, "guides": guides, "move": move}
            measured[f"gain_{kind}_{n}"] = searches.record(kind=kind, simulations=n, **default)["gain"]
        order = orders.record(search="depth first", kind=kind, form=run.ORDER_FORM)
        measured[f"nodes_ratio_{kind}"] = order["ratio"]
        for index in (run.UCB1, run.BETA):
            begun = arms.record(index=index, kind=kind, form=run.ARMS_FORM, strength=settings["strength"])
            measured[f"{index}_ratio_{kind}"] = begun["ratio"]
            measured[f"{index}_even_ratio_{kind}"] = begun["even_ratio"]
    gains = [row["gain"] for row in searches.records if "gain" in row]
    measured["share_of_ways_better"] = share_of([is_above(gain, 0.0) for gain in gains])
    measured["share_of_ways_worse"] = share_of([is_below(gain, 0.0) for gain in gains])
    return measured


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """Every way of each use with its numbers, then the curves of regret with their standard errors over mazes."""
    found = [*_searches(results), *_orders(results), *_arms(settings, results)]
    plain = [{k: v.to_dict() if isinstance(v, Estimate) else v for k, v in row.items()} for row in found]
    for table, way in _ways(results, "bandit", ARMS_KEYS):
        if "curve" in table.record(**way):
            curve = table.curve("curve", **way)
            error = [round(deviation / len(results) ** 0.5, 4) for deviation in curve["deviation"]]
            mean = [round(value, 4) for value in curve["mean"]]
            plain.append({"use": "curve", **way, "mean": mean, "error": error})
    return plain
