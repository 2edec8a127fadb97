"""C3.8: which features of the modified factory save entropy of the action prior, and whether sets agree on it.

The thesis gives no numbers but bars: *matters* is read as saving more than every feature that does not, and *does
not matter* as saving less than half of what the least of N, S, E and W saves. Thesis: §3.4.5, Figure 3.12.
"""

from collections.abc import Iterable, Mapping, Sequence

import numpy as np

from lifelore.core.metrics import Estimate, mean_estimate, ratio_estimate
from lifelore.domains.factory.contexts import PHI
from lifelore.experiments.chapter3.c3_07_feature_sets.run import check_components
from lifelore.experiments.chapter3.c3_08_feature_importance.feature_importance import (
    ACTIONS,
    KEYS,
    OVER,
    cells,
    hows,
    run_cell,
)
from lifelore.experiments.chapter3.modified_factory_tasks import CARDINALS, DIAGONALS, ITEMS, OWN_CELL
from lifelore.experiments.engine.claim import Claim
from lifelore.experiments.engine.estimates import exact_share, is_above, share_of
from lifelore.experiments.engine.learning_settings import check_among, check_counts, check_default
from lifelore.experiments.engine.open_choices import default_of, how_key
from lifelore.experiments.engine.predicate import Predicate

FULL = {
    "discount": 0.99,
    "components": 4,
    "runs": 30,
    "policies": [10, 80],
    "over": list(OVER),
    "actions": list(ACTIONS),
    "default": {"policies": 80, "over": "all", "actions": "tied"},
}
QUICK = {**FULL, "components": 1, "runs": 3, "policies": [1, 3], "default": {**FULL["default"], "policies": 3}}

Found = dict[tuple, list[Mapping]]


def _check(settings: Mapping) -> None:
    check_counts(settings, ("runs", "policies", "components"))
    check_among(settings, "over", OVER)
    check_among(settings, "actions", ACTIONS)
    check_default(settings, {key: key for key in KEYS})
    check_components(settings)


def _by_how(results: Sequence[Mapping]) -> Found:
    """A cell of the grid to its numbers, run by run."""
    found: Found = {}
    for result in results:
        for numbers in result["found"]:
            found.setdefault(how_key(numbers, KEYS), []).append(numbers)
    return found


def _increase(runs: Sequence[Mapping], phi: str, feature: str) -> np.ndarray:
    return np.array([numbers["increase"][phi][feature] for numbers in runs], float)


def _least(runs: Sequence[Mapping], phi: str, features: Iterable[str]) -> np.ndarray:
    """The least Δ of some features, run by run."""
    return np.min([_increase(runs, phi, feature) for feature in features], axis=0)


def _largest(runs: Sequence[Mapping], phi: str, features: Iterable[str]) -> np.ndarray:
    return np.max([_increase(runs, phi, feature) for feature in features], axis=0)


def gaps(runs: Sequence[Mapping]) -> dict[str, Estimate]:
    """By how much the least of N, S, E, W exceeds the largest other, within φ3 and φ4 and from φ2 to φ1, bits."""
    pairs = {"phi4": ("phi4", "phi4"), "phi3": ("phi3", "phi3"), "phi2_to_phi1": ("phi2", "phi1")}
    found = {}
    for name, (ours, theirs) in pairs.items():
        others = [feature for feature in PHI[theirs] if feature not in CARDINALS]
        found[f"gap_{name}"] = mean_estimate(_least(runs, ours, CARDINALS) - _largest(runs, theirs, others))
    return found


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """Δ of each feature in each set at the default, what the claim compares there, and shares of the grid."""
    found = _by_how(results)
    runs = found[how_key(default_of(settings, KEYS), KEYS)]
    measured = {}
    for phi, names in PHI.items():
        measured[f"entropy_{phi}"] = mean_estimate([numbers["entropy"][phi] for numbers in runs])
        for feature in names:
            measured[f"delta_{phi}_{feature}"] = mean_estimate(_increase(runs, phi, feature))
    least = _least(runs, "phi4", CARDINALS)
    groups = {"diagonal": DIAGONALS, "own_cell": (OWN_CELL,), "items": (ITEMS,)}
    for name, features in groups.items():
        measured[f"{name}_share_phi4"] = ratio_estimate(_largest(runs, "phi4", features), least)
    chosen = [set(numbers["chosen"]["phi4"]) == set(CARDINALS) for numbers in runs]
    measured["exactly_four_selected"] = exact_share(chosen)
    consistent = [
        all(is_above(gap, 0.0) for gap in gaps(found[how_key(how, KEYS)]).values()) for how in hows(settings)
    ]
    return measured | gaps(runs) | {"grid_consistent": share_of(consistent)}


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """A row for each cell of the grid: Δ of each feature in each set, shares of runs selected from φ4, gaps."""
    found, kept = _by_how(results), []
    for how in hows(settings):
        runs = found[how_key(how, KEYS)]
        row: dict = {key: how[key] for key in KEYS}
        row["increase"] = {
            phi: {feature: mean_estimate(_increase(runs, phi, feature)).to_dict() for feature in names}
            for phi, names in PHI.items()
        }
        row["selected"] = {
            feature: float(np.mean([feature in numbers["chosen"]["phi4"] for numbers in runs]))
            for feature in PHI["phi4"]
        }
        kept.append(row | {name: gap.to_dict() for name, gap in gaps(runs).items()})
    return kept


def _draw(result: Mapping):
    from lifelore.experiments.chapter3.feature_bars import draw_feature_bars

    return draw_feature_bars(result)


CAUSES = {
    "most of the grid": "along optimal ways alone, what the own cell is and what is left to do decide between "
    "using a point and moving on, and tell as much as the walls",
}

CLAIM = Claim(
    id="C3.8",
    title="Which features save entropy of the action prior (Figure 3.12)",
    thesis="In the modified factory the cells to the North, South, East and West are the most valuable features; "
    "the diagonal cells, the own cell and the flag Items are not important; the relative importance is consistent "
    "across the four sets.",
    sizes={"quick": QUICK, "full": FULL},
    predicate=Predicate.of("C3.8"),
    cells=cells,
    run_cell=run_cell,
    measure=measure,
    rows=rows,
    draw=_draw,
    causes=CAUSES,
    check=_check,
)
