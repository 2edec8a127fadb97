"""C4.3: the order of the signals by regret and its variance, and how many callers end without regret."""

from collections.abc import Mapping, Sequence
from itertools import pairwise

import numpy as np

from lifelore.core.metrics import Estimate, mean_estimate
from reproduction.chapter4.c4_03_telephone_signals.run import DEFAULT_READING, SIGNALS, samples_of
from reproduction.chapter4.reuse.many_tasks import EXACT, LEARNT, UNCERTAIN, grouped_mean
from reproduction.engine.estimates import exact_share, is_above, share_of
from reproduction.engine.results_table import ResultsTable

ENDED = 0.95
"""Share of callers without regret by the last call that counts as all."""
SHORT = dict(zip(SIGNALS, ("sas", "sar", "u"), strict=True))


def orders(sums: Mapping[str, np.ndarray]) -> dict[str, Estimate]:
    """How much more a poorer signal costs in all, and how much more it varies (difference of variances).

    `sums`: of each signal the summed regret of every caller, (n_groups, n_users).
    """
    found = {}
    for better, worse in pairwise(SIGNALS):
        name = f"{SHORT[worse]}_minus_{SHORT[better]}"
        found[f"regret_{name}"] = grouped_mean(sums[worse] - sums[better])
        spread = [(sums[s] - sums[s].mean()) ** 2 for s in (worse, better)]
        found[f"variance_{name}"] = grouped_mean(spread[0] - spread[1])
    return found


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    doubting = [result for result in results if result["model"] == UNCERTAIN]
    table = ResultsTable(
        [r for r in results if r["model"] != UNCERTAIN], ("reading", "models", "samples", "signal")
    )
    few, n, call = settings["samples"], settings["default_models"], settings["by_call"]

    def order(models: int, samples: int | None, reading: str = DEFAULT_READING) -> dict[str, Estimate]:
        cell = {"reading": reading, "models": models, "samples": samples}
        shape = (settings["groups"], settings["users"])
        return orders({s: table.values("sums", signal=s, **cell).reshape(shape) for s in SIGNALS})

    measured = {}
    for model, samples in ((LEARNT, few), (EXACT, None)):
        measured |= {f"{name}_{model}": number for name, number in order(n, samples).items()}
        for signal in SIGNALS:
            row = table.record(reading=DEFAULT_READING, models=n, samples=samples, signal=signal)
            ended, name = np.array(row["ended"]), f"{SHORT[signal]}_{model}"
            measured[f"zero_from_call_{call}_{name}"] = exact_share(ended <= call)
            measured[f"zero_at_call_{call}_{name}"] = exact_share(np.arange(ended.size) < row["free"])
            measured[f"zero_at_end_{name}"] = exact_share(ended <= settings["calls"])
    sums = {}
    for row in (row for row in doubting if row["samples"] == few):
        ended, name = np.array(row["ended"]), f"{SHORT[row['signal']]}_{UNCERTAIN}"
        measured[f"zero_at_end_{name}"] = exact_share(ended <= settings["calls"])
        sums[row["signal"]] = np.array(row["sums"]).reshape(-1, settings["users"])
    measured |= {f"{name}_{UNCERTAIN}": number for name, number in orders(sums).items()}
    grid = [order(models, samples) for models in settings["models"] for samples in (few, None)]
    measured["grid_order_of_means"] = share_of(
        [all(number.value > 0 for number in found.values()) for found in grid]
    )
    measured["grid_order_beyond_doubt"] = share_of(
        [all(is_above(number, 0.0) for number in found.values()) for found in grid]
    )
    measured["grid_sentence"] = share_of(_sentences(settings, results))
    if "B" in settings["readings"]:
        measured["regret_sar_minus_sas_reading_B"] = order(n, None, "B")["regret_sar_minus_sas"]
    return measured


def _sentences(settings: Mapping, results: Sequence[Mapping]) -> list[bool]:
    """Whether for certain both orders hold and all signals end without regret, in each cell of the grid.

    The grid: every number of language models by models learnt from few, some and many calls, and exact ones; and
    models known to be uncertain, of the default number.
    """
    table = ResultsTable(
        [row for row in results if row["reading"] == DEFAULT_READING], ("models", "model", "samples", "signal")
    )
    every = [(LEARNT, samples) for samples in samples_of(settings)]
    cells = [(n, *kind) for n in settings["models"] for kind in [*every, (EXACT, None)]]
    cells += [(settings["default_models"], UNCERTAIN, samples) for samples in samples_of(settings)]
    found = []
    for n, model, samples in cells:
        own = {s: table.record(models=n, model=model, samples=samples, signal=s) for s in SIGNALS}
        sums = {s: np.array(row["sums"]).reshape(-1, settings["users"]) for s, row in own.items()}
        ended = [exact_share(np.array(row["ended"]) <= settings["calls"]) for row in own.values()]
        in_order = all(is_above(number, 0.0) for number in orders(sums).values())
        found.append(in_order and all(is_above(share, ENDED) for share in ended))
    return found


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """A row a cell: curves, sum and its deviation, when regret ended."""
    found = []
    for result in results:
        row = {key: result[key] for key in ("reading", "models", "model", "samples", "signal")}
        sums, ended = np.array(result["sums"]), np.array(result["ended"])
        row |= {"cumulative": mean_estimate(sums).to_dict(), "deviation_of_sum": round(float(sums.std()), 4)}
        row |= {"ended_median": float(np.median(ended)), "ended_p90": float(np.quantile(ended, 0.9))}
        row["zero_at_call"] = round(result["free"] / len(ended), 5)
        row["zero_at_end"] = round(float((ended <= settings["calls"]).mean()), 5)
        if result["models"] == settings["default_models"]:
            row |= {"mean": result["mean"], "deviation": result["deviation"]}
        found.append(row)
    return found
