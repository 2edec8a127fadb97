"""Measures and rows of claim C3.8."""

from collections.abc import Iterable, Mapping, Sequence

import numpy as np

from lifelore.core.metrics import Estimate, mean_estimate, ratio_estimate
from lifelore.domains.factory.contexts import PHI
from lifelore.experiments.chapter3.c3_08_feature_importance.run import KEYS, hows
from lifelore.experiments.chapter3.modified_factory_tasks import CARDINALS, DIAGONALS, ITEMS, OWN_CELL
from lifelore.experiments.engine.estimates import exact_share, is_above, share_of
from lifelore.experiments.engine.open_choices import default_of, how_key

Found = dict[tuple, list[Mapping]]


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
