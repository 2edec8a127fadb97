"""Measures and rows of claim C2.11."""

from collections.abc import Callable, Mapping, Sequence

import numpy as np

from lifelore.core.metrics import Estimate, mean_estimate
from lifelore.experiments.chapter2.c2_11_distant_objects.run import FAR, kernels
from lifelore.experiments.chapter2.tabletop_pairs import STANDARD, kernel_name
from lifelore.experiments.engine.estimates import exact_share

KINDS = ("simulated", "real")
SV_A, SV_B, CONTACTS_A, CONTACTS_B, STRONG_A, STRONG_B, VIOLATION = range(7)
Counts = np.ndarray
"""Of one gap and kernel, a row of seven numbers a pair."""


def table_of(settings: Mapping, results: Sequence[Mapping], kind: str) -> dict[tuple[int, int], Counts]:
    """By number of gap and of kernel, the seven numbers of every pair, ``(n, 7)``."""
    found: dict[tuple[int, int], list] = {}
    for pair in (pair for result in results if result["kind"] == kind for pair in result["pairs"]):
        for gap, kernel, *numbers in pair["found"]:
            found.setdefault((gap, kernel), []).append(numbers)
    return {key: np.array(rows, float) for key, rows in found.items()}


def nothing(counts: Counts) -> list[bool]:
    """Pairs without a contact of at least 7 support vectors on either side."""
    return (counts[:, STRONG_A] + counts[:, STRONG_B] == 0).tolist()


def nothing_at_all(counts: Counts) -> list[bool]:
    """Pairs with no support vector, hence no contact of any size, on some side."""
    return (np.minimum(counts[:, SV_A], counts[:, SV_B]) == 0).tolist()


def something(counts: Counts) -> list[bool]:
    """Pairs with a contact of at least 7 support vectors on both sides."""
    return (np.minimum(counts[:, STRONG_A], counts[:, STRONG_B]) > 0).tolist()


def support(counts: Counts) -> np.ndarray:
    """Support vectors a thing, mean of the two."""
    return (counts[:, SV_A] + counts[:, SV_B]) / 2


def gap_number(settings: Mapping, gap: float) -> int:
    """Number of a gap of the settings; 0 is the pair as it was seen."""
    return 1 + list(settings["gaps"]).index(gap)


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """As seen and at `FAR`, by kernel; then of the kernel that tells the two apart best."""
    found: dict[str, Estimate] = {}
    far = gap_number(settings, FAR)
    names = [kernel_name(*kernel) for kernel in kernels(settings)]
    for kind in KINDS:
        table = table_of(settings, results, kind)
        if not table:
            continue
        for number, name in enumerate(names):
            near_by, away = table[0, number], table[far, number]
            place = f"{name}_{kind}" if name != STANDARD else f"standard_{kind}"
            found[f"no_contacts_far_{place}"] = exact_share(nothing(away))
            found[f"contacts_as_seen_{place}"] = exact_share(something(near_by))
            found[f"support_vectors_far_{place}"] = mean_estimate(support(away))
            found[f"far_over_seen_{place}"] = mean_estimate(support(away) / support(near_by))
        found |= _of_all_kernels(table, far, kind)
        found |= _best_kernel(table, far, len(names), kind)
        sizes = [pair["size"] for r in results if r["kind"] == kind for pair in r["pairs"]]
        found[f"far_in_sizes_{kind}"] = mean_estimate([FAR / size for size in sizes])
    return found


def _of_all_kernels(table: Mapping[tuple[int, int], Counts], far: int, kind: str) -> dict[str, Estimate]:
    """Over all gaps and kernels: sides without any support vector, and separators that are not optimal."""
    every = np.concatenate(list(table.values()))
    distant = np.concatenate([counts for (gap, _), counts in table.items() if gap == far])
    return {
        f"no_support_vectors_on_a_side_far_{kind}": exact_share(nothing_at_all(distant)),
        f"no_support_vectors_on_a_side_{kind}": exact_share(nothing_at_all(every)),
        f"not_optimal_{kind}": exact_share((every[:, VIOLATION] > 1e-3).tolist()),
    }


def _best_kernel(table: Mapping[tuple[int, int], Counts], far: int, n: int, kind: str) -> dict[str, Estimate]:
    """The kernel under which most pairs have contacts as seen and none far: best by the worse of two shares."""
    shares = [(exact_share(something(table[0, k])), exact_share(nothing(table[far, k]))) for k in range(n)]
    seen, gone = max(shares, key=lambda pair: min(pair[0].value, pair[1].value))
    return {f"contacts_as_seen_best_kernel_{kind}": seen, f"no_contacts_far_best_kernel_{kind}": gone}


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """Of each kind, kernel and gap: quartiles of support vectors a thing and of contacts, shares without."""
    found = []
    for kind in KINDS:
        table = table_of(settings, results, kind)
        gaps = [pair["gaps"] for r in results if r["kind"] == kind for pair in r["pairs"]]
        for number, kernel in enumerate(kernels(settings) if table else ()):
            for place, unit in enumerate(_units(settings)):
                counts = table[place, number]
                line = {"scenes": kind, "kernel": kernel_name(*kernel), "gap": _median(gaps, place), "unit": unit}
                line |= {"pairs": len(counts), "support": _quartiles(support(counts))}
                line |= {"contacts": _quartiles(_mean_of(counts, CONTACTS_A, CONTACTS_B))}
                line |= {"contacts_of_7": _quartiles(_mean_of(counts, STRONG_A, STRONG_B))}
                line |= {"none_of_7": round(float(np.mean(nothing(counts))), 4)}
                found.append(line | {"violation": float(counts[:, VIOLATION].max())})
    return found


def _units(settings: Mapping) -> list[str]:
    """Of each gap how it was asked for."""
    return ["as seen", *("metres" for _ in settings["gaps"]), *(f"{times:g} sizes" for times in settings["sizes"])]


def _median(gaps: Sequence[Sequence[float]], place: int) -> float:
    return round(float(np.median([one[place] for one in gaps])), 4)


def _mean_of(counts: Counts, first: int, second: int) -> np.ndarray:
    return (counts[:, first] + counts[:, second]) / 2


def _quartiles(values: np.ndarray) -> list[float]:
    """Median, lower and upper quartile."""
    return np.round(np.quantile(values, [0.5, 0.25, 0.75]), 2).tolist()


def curves_of(rows: Sequence[Mapping], kernels_shown: Callable[[str], bool], kind: str = "simulated") -> dict:
    """Rows of gaps in metres as `figures.separation_curve` takes them."""
    curves: dict[str, dict] = {}
    for row in rows:
        if row["scenes"] == kind and row["unit"] in ("as seen", "metres") and kernels_shown(row["kernel"]):
            curve = curves.setdefault(row["kernel"], {"gap": [], "support_vectors": [], "nodes": []})
            curve["gap"].append(row["gap"])
            curve["support_vectors"].append(row["support"])
            curve["nodes"].append(row["contacts_of_7"])
    return curves
