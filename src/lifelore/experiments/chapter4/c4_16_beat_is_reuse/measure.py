"""Measures and rows of claim C4.16."""

from collections.abc import Mapping, Sequence

import numpy as np

from lifelore.core.metrics import Estimate, mean_estimate


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """Share of decisions alike, the largest difference of beliefs, and when the printed products become zero."""
    sessions = [s for r in results for s in r["sessions"]]
    decisions = sum(s["decisions"] for s in sessions)
    share = sum(s["alike"] for s in sessions) / decisions
    apart = max(s["apart"] for s in sessions)
    spread = np.array([s["spread"] for s in sessions])
    gone = [s["vanished"] for s in sessions if s["vanished"]]
    found = {
        "decisions_alike": Estimate(share, share, None, decisions),
        "beliefs_apart": Estimate(apart, float(np.median([s["apart"] for s in sessions])), None, len(sessions)),
        "belief_spread": mean_estimate(spread),
        "belief_spread_largest": Estimate(float(spread.max()), float(np.median(spread)), None, len(spread)),
        "products_that_vanish": mean_estimate([float(s["vanished"] > 0) for s in sessions]),
    }
    if gone:
        found["steps_until_products_vanish"] = mean_estimate(np.array(gone, float))
    return found


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
