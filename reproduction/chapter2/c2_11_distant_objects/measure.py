"""Measures and rows of claim C2.11: support vectors and contacts by gap and kernel."""

from collections.abc import Mapping, Sequence

import numpy as np

from lifelore.core.metrics import Estimate, mean_estimate
from reproduction.chapter2.c2_11_distant_objects.run import FAR, kernels
from reproduction.chapter2.scenes.tabletop_pairs import STANDARD, kernel_name
from reproduction.engine.estimates import exact_share, share_of
from reproduction.engine.results_table import ResultsTable, computed_once

QUARTILES = ("support", "contacts", "contacts_of_7")
NONE_FAR, FEW = 0.95, 10
"""Least share of pairs without a contact point, and most support vectors of a thing, as in the conditions."""
Findings = dict[str, dict[str, Estimate]]
"""By kernel, and over all kernels, the estimates as seen and at `FAR`."""


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """Simulated pairs as seen and at `FAR`: under the standard kernel, the best kernel, and all kernels."""
    found = findings(settings, results)["simulated"]
    measured = {f"{name}_standard_simulated": number for name, number in found.get(STANDARD, {}).items()}
    names = [kernel_name(*kernel) for kernel in kernels(settings)]
    # The best kernel tells the two apart: the smaller of its two shares is the largest.
    shares = ("contacts_as_seen", "no_contacts_far")
    best = max(names, key=lambda name: min(found[name][key].value for key in shares))
    measured |= {f"{key}_best_kernel_simulated": found[best][key] for key in shares}
    key = "no_support_vectors_on_a_side_far"
    measured[f"{key}_simulated"] = found["all"][key]
    return measured | {"kernels_in_which_both_are_so": share_of([both_are_so(found[name]) for name in names])}


def both_are_so(kernel: Mapping[str, Estimate]) -> bool:
    """Whether a kernel leaves no contact point and very few support vectors at `FAR`, by their intervals."""
    none, few = (kernel[key].ci95 for key in ("no_contacts_far", "support_vectors_far"))
    return none is not None and none[0] >= NONE_FAR and few is not None and few[1] <= FEW


@computed_once
def findings(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Findings]:
    """By kind of scenes: estimates of each kernel by its name, and of all kernels under "all"."""
    table, far = pairs_table(settings, results), 1 + list(settings["gaps"]).index(FAR)
    found: dict[str, Findings] = {}
    for kind in table.distinct("kind"):
        by_kernel = found.setdefault(kind, {})
        for number, kernel in enumerate(kernels(settings)):
            seen, away = ({"kind": kind, "gap": gap, "kernel": number} for gap in (0, far))
            support = table.values("support", **away)
            by_kernel[kernel_name(*kernel)] = {
                "no_contacts_far": exact_share(table.values("none_of_7", **away)),
                "contacts_as_seen": exact_share(table.values("both_of_7", **seen)),
                "support_vectors_far": mean_estimate(support),
                "far_over_seen": mean_estimate(support / table.values("support", **seen)),
            }
        sizes = [pair["size"] for result in results if result["kind"] == kind for pair in result["pairs"]]
        by_kernel["all"] = {
            "no_support_vectors_on_a_side_far": exact_share(table.values("no_support", kind=kind, gap=far)),
            "no_support_vectors_on_a_side": exact_share(table.values("no_support", kind=kind)),
            "not_optimal": exact_share(table.values("violation", kind=kind) > 1e-3),
            "far_in_sizes": mean_estimate([FAR / size for size in sizes]),
        }
    return found


@computed_once
def pairs_table(settings: Mapping, results: Sequence[Mapping]) -> ResultsTable:
    """A record for each pair, number of gap (0: as seen) and number of kernel."""
    records = (
        {"kind": result["kind"], "gap": gap, "kernel": kernel, "metres": pair["gaps"][gap], **pair_counts(counts)}
        for result in results
        for pair in result["pairs"]
        for gap, kernel, *counts in pair["found"]
    )
    return ResultsTable(records, ("kind", "gap", "kernel"))


def pair_counts(counts: Sequence[float]) -> dict[str, float]:
    """Means of the two objects, and the answers that shares count, from counts as in `run.parted`."""
    support_a, support_b, contacts_a, contacts_b, strong_a, strong_b, violation = counts
    return {
        "support": (support_a + support_b) / 2,
        "contacts": (contacts_a + contacts_b) / 2,
        "contacts_of_7": (strong_a + strong_b) / 2,
        "none_of_7": strong_a + strong_b == 0,
        "both_of_7": min(strong_a, strong_b) > 0,
        "no_support": min(support_a, support_b) == 0,
        "violation": violation,
    }


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """Quartiles by kind of scenes, kernel and gap; then the estimates of each kernel and of all."""
    table, found = pairs_table(settings, results), []
    units = ["as seen", *["metres"] * len(settings["gaps"]), *(f"{times:g} sizes" for times in settings["sizes"])]
    for kind in table.distinct("kind"):
        for number, kernel in enumerate(kernels(settings)):
            for gap, unit in enumerate(units):
                own = table.select(kind=kind, gap=gap, kernel=number)
                metres = round(float(np.median(own.values("metres"))), 4)
                line = {
                    "scenes": kind,
                    "kernel": kernel_name(*kernel),
                    "gap": metres,
                    "unit": unit,
                    "pairs": len(own),
                }
                for name in QUARTILES:  # median, lower and upper quartile
                    line[name] = np.round(np.quantile(own.values(name), [0.5, 0.25, 0.75]), 2).tolist()
                line["none_of_7"] = round(float(own.values("none_of_7").mean()), 4)
                found.append(line | {"violation": float(own.values("violation").max())})
    for kind, by_kernel in findings(settings, results).items():
        for kernel, numbers in by_kernel.items():
            plain = {name: number.to_dict() for name, number in numbers.items()}
            found.append({"scenes": kind, "estimates of kernel": kernel, **plain})
    return found
