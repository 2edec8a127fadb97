"""Measures and rows of claim C4.3."""

from collections.abc import Mapping, Sequence
from itertools import pairwise

import numpy as np

from lifelore.core.metrics import Estimate, mean_estimate
from lifelore.experiments.chapter4.c4_03_telephone_signals.run import DEFAULT_READING, SIGNALS
from lifelore.experiments.chapter4.c4_03_telephone_signals.telephone_runs import EXACT, LEARNT
from lifelore.experiments.chapter4.reuse_runs import grouped_deviation, grouped_mean, grouped_quantile
from lifelore.experiments.engine.estimates import exact_share, is_above, share_of

SHORT = dict(zip(SIGNALS, ("sas", "sar", "u"), strict=True))


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
