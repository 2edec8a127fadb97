"""C4.16: the share of decisions alike, the difference of beliefs, and products that become zero."""

from collections.abc import Mapping, Sequence

import numpy as np

from lifelore.core.metrics import Estimate, mean_estimate
from reproduction.engine.estimates import exact_value


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    sessions = [s for r in results for s in r["sessions"]]
    decisions = sum(s["decisions"] for s in sessions)
    apart = np.array([s["apart"] for s in sessions])
    return {
        "decisions_alike": exact_value(sum(s["alike"] for s in sessions) / decisions, decisions),
        "beliefs_apart": Estimate(float(apart.max()), float(np.median(apart)), None, len(sessions)),
        "products_that_vanish": mean_estimate([float(s["vanished"] > 0) for s in sessions]),
    }


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """By ε and type: decisions, those alike, the spread of the log belief and when products vanish."""
    found = []
    for result in results:
        for kind in sorted({s["kind"] for s in result["sessions"]}):
            mine = [s for s in result["sessions"] if s["kind"] == kind]
            row = {key: sum(s[key] for s in mine) for key in ("decisions", "alike")}
            row |= {key: [s[key] for s in mine] for key in ("spread", "vanished")}
            found.append({"epsilon": result["epsilon"], "kind": kind, **row})
    return found
