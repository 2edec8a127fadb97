"""C4.3: a telephone service that learns from whole calls, from their rewards, or from their sum alone.

The thesis does not say how many language models there are; nor, but by words, what η splits. Reading A of the
transition system is the default, ten models the headline; beside it other numbers of models, and reading B.

What was known beforehand: for every type and model the distributions of signal and utility, exactly, or as learnt
from `samples` calls a pair with pseudo-counts; the caller's type never.

Thesis: §4.6.2, Figures 4.5 and 4.6.
"""

from collections.abc import Mapping, Sequence
from itertools import pairwise

import numpy as np

from lifelore.core.errors import InputError
from lifelore.core.metrics import Estimate, mean_estimate
from lifelore.domains.telephone.telephone import READINGS
from lifelore.experiments.chapter4.c4_03_telephone_signals.telephone_runs import (
    EXACT,
    LEARNT,
    SIGNAL_OF_PATH,
    serve,
)
from lifelore.experiments.chapter4.reuse_runs import grouped_deviation, grouped_mean, grouped_quantile
from lifelore.experiments.engine.claim import Claim
from lifelore.experiments.engine.estimates import exact_share, is_above, share_of
from lifelore.experiments.engine.learning_settings import check_among, check_counts
from lifelore.experiments.engine.predicate import Predicate

FULL = {
    "groups": 100,
    "users": 100,
    "calls": 200,
    "by_call": 50,
    "models": [5, 10, 20, 50],
    "default_models": 10,
    "readings": ["A", "B"],
    "eta": 0.3,
    "samples": 10,
    "more_samples": 100,
    "pseudo_count": 0.5,
}
QUICK = {**FULL, "groups": 5, "users": 40, "calls": 60, "models": [5, 10]}
SIGNALS = tuple(SIGNAL_OF_PATH)
SHORT = dict(zip(SIGNALS, ("sas", "sar", "u"), strict=True))
DEFAULT_READING = "A"


def _check(settings: Mapping) -> None:
    check_counts(settings, ("groups", "users", "calls", "by_call", "samples", "more_samples"))
    check_counts(settings, ("models",), 2)
    check_among(settings, "readings", READINGS)
    if settings["default_models"] not in settings["models"] or DEFAULT_READING not in settings["readings"]:
        raise InputError(f"models must include default_models ({settings['default_models']}), readings A")
    if settings["by_call"] > settings["calls"]:
        raise InputError(f"by_call must be at most calls ({settings['calls']}), got {settings['by_call']}")
    if settings["samples"] == settings["more_samples"]:
        raise InputError(f"more_samples must not be samples ({settings['samples']})")
    if not 0 <= settings["eta"] < 1 or settings["pseudo_count"] < 0:
        raise InputError("eta must lie in [0, 1) and pseudo_count be at least 0")


def cells(settings: Mapping) -> list[dict]:
    """Every signal, by number of models and kind of model under reading A, and for the default number under B."""
    few, many, default = settings["samples"], settings["more_samples"], settings["default_models"]
    kinds = ((LEARNT, few), (EXACT, None))
    ways = [(DEFAULT_READING, n, *kind) for n in settings["models"] for kind in kinds]
    ways += [(DEFAULT_READING, default, LEARNT, many)]
    ways += [("B", default, *kind) for kind in kinds if "B" in settings["readings"]]
    return [
        {"reading": reading, "models": n, "model": model, "samples": samples, "signal": signal}
        for reading, n, model, samples in ways
        for signal in SIGNALS
    ]


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """One kind of signal; see `telephone_runs.serve`."""
    return {**cell, **serve(settings, cell, seed)}


def _sums(settings: Mapping, results: Sequence[Mapping], key: str = "sums", **way) -> dict[str, np.ndarray]:
    """Of one way the numbers of each signal, (n_groups, n_users)."""
    shape = (settings["groups"], settings["users"])
    return {
        result["signal"]: np.array(result[key], float).reshape(shape)
        for result in results
        if all(result[k] == v for k, v in way.items())
    }


def orders(sums: Mapping[str, np.ndarray]) -> dict[str, Estimate]:
    """How much more a poorer signal costs in all, and how much more it varies (difference of variances)."""
    found = {}
    for better, worse in pairwise(SIGNALS):
        name = f"{SHORT[worse]}_minus_{SHORT[better]}"
        found[f"regret_{name}"] = grouped_mean(sums[worse] - sums[better])
        spread = [(sums[s] - sums[s].mean()) ** 2 for s in (worse, better)]
        found[f"variance_{name}"] = grouped_mean(spread[0] - spread[1])
    return found


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """Order of the signals and how many callers end without regret; the order over the grid; reading B."""
    measured = {}
    n = settings["default_models"]
    for model, samples in ((LEARNT, settings["samples"]), (EXACT, None)):
        way = {"reading": DEFAULT_READING, "models": n, "model": model, "samples": samples}
        sums, ended = _sums(settings, results, **way), _sums(settings, results, "ended", **way)
        measured |= {f"{name}_{model}": number for name, number in orders(sums).items()}
        for signal in SIGNALS:
            name = f"{SHORT[signal]}_{model}"
            measured[f"cumulative_{name}"] = grouped_mean(sums[signal])
            measured[f"deviation_{name}"] = grouped_deviation(sums[signal])
            measured[f"zero_from_call_{settings['by_call']}_{name}"] = exact_share(
                (ended[signal] <= settings["by_call"]).ravel().tolist()
            )
            free = next(r["free"] for r in results if r["signal"] == signal and way.items() <= r.items())
            measured[f"zero_at_call_{settings['by_call']}_{name}"] = exact_share(
                (np.arange(ended[signal].size) < free).tolist()
            )
            measured[f"zero_at_end_{name}"] = exact_share((ended[signal] <= settings["calls"]).ravel().tolist())
            measured[f"converged_median_{name}"] = grouped_quantile(ended[signal], 0.5)
            measured[f"converged_p90_{name}"] = grouped_quantile(ended[signal], 0.9)
    grid = [
        orders(_sums(settings, results, reading=DEFAULT_READING, models=m, samples=samples))
        for m in settings["models"]
        for samples in (settings["samples"], None)
    ]
    measured["grid_order_of_means"] = share_of([all(one[k].value > 0 for k in one) for one in grid])
    measured["grid_order_beyond_doubt"] = share_of([all(is_above(one[k], 0.0) for k in one) for one in grid])
    if "B" in settings["readings"]:
        under_b = orders(_sums(settings, results, reading="B", models=n, model=EXACT))
        measured["regret_sar_minus_sas_reading_B"] = under_b["regret_sar_minus_sas"]
    return measured


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """A row a cell: curves, sum and its deviation, when regret ended."""
    kept = []
    for result in results:
        row = {key: result[key] for key in ("reading", "models", "model", "samples", "signal")}
        sums, ended = np.array(result["sums"]), np.array(result["ended"])
        row |= {"cumulative": mean_estimate(sums).to_dict(), "deviation_of_sum": round(float(sums.std()), 4)}
        row |= {"ended_median": float(np.median(ended)), "ended_p90": float(np.quantile(ended, 0.9))}
        row["zero_at_call"] = round(result["free"] / len(ended), 5)
        row["zero_at_end"] = round(float((ended <= settings["calls"]).mean()), 5)
        if result["models"] == settings["default_models"]:
            row |= {"mean": result["mean"], "deviation": result["deviation"]}
        kept.append(row)
    return kept


def _draw(result: Mapping):
    from lifelore.experiments.chapter4.c4_03_telephone_signals.figure_telephone_curves import draw_telephone_curves

    return draw_telephone_curves(result)


CLAIM = Claim(
    id="C4.3",
    title="Three signals on the telephone (Figure 4.6)",
    thesis="Sampling the belief with η = 0.3 and utilities 10 and 3: regret and its variance are lowest with "
    "(s, a, s′), then (s, a, r), then U; all three eventually converge to zero regret.",
    sizes={"quick": QUICK, "full": FULL},
    predicate=Predicate.of("C4.3"),
    cells=cells,
    run_cell=run_cell,
    measure=measure,
    rows=rows,
    draw=_draw,
    check=_check,
)
