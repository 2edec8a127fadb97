"""Measures and rows of claim C4.15."""

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from lifelore.core.metrics import Estimate, mean_estimate, ratio_estimate
from lifelore.domains.ball_game.ball_game import SIZES
from lifelore.experiments.chapter4.c4_15_safety.safety_runs import LAGGING
from lifelore.experiments.chapter4.diversity_runs import BEATS, ORACLE, PRINTED_EXP3, STATIC, TUNED_EXP3

KEYS = {"BEAT": "", "BEAT, ε as printed": "_printed"}


def losses_of(results: Sequence[Mapping], method: str) -> NDArray[np.float64]:
    """Losses (n_types, players, episodes) of all lots."""
    return np.concatenate([np.array(r["losses"][method]) for r in results], axis=1)


def worst_ratio(mine: NDArray[np.float64], theirs: NDArray[np.float64]) -> tuple[Estimate, list[int]]:
    """The largest ratio of mean losses over types and episodes, and which type and episode it is."""
    ratios = mine.mean(axis=1) / theirs.mean(axis=1)
    type_, episode = np.unravel_index(ratios.argmax(), ratios.shape)
    return ratio_estimate(mine[type_, :, episode], theirs[type_, :, episode]), [int(type_), int(episode)]


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """Ratios to the static speed and to EXP-3, regret to each type's best speed, and steps needed."""
    static, oracle = losses_of(results, STATIC), losses_of(results, ORACLE)
    found: dict[str, Estimate] = {}
    for method, key in KEYS.items():
        mine = losses_of(results, method)
        for name, other in (("static", static), ("exp3", losses_of(results, PRINTED_EXP3))):
            found[f"to_{name}_first{key}"] = ratio_estimate(mine[:, :, 0], other[:, :, 0])
            found[f"to_{name}_last{key}"] = ratio_estimate(mine[:, :, -1], other[:, :, -1])
        found[f"worst_to_static{key}"] = worst_ratio(mine, static)[0]
        found[f"worst_to_static_last{key}"] = worst_ratio(mine[:, :, -1:], static[:, :, -1:])[0]
        regret = (mine - oracle).reshape(-1, mine.shape[2])
        found[f"regret{key}"] = mean_estimate(regret.mean(axis=1))
        found[f"regret_first{key}"] = mean_estimate(regret[:, 0])
        found[f"regret_last{key}"] = mean_estimate(regret[:, -1])
    for method, key in ((STATIC, "static"), (PRINTED_EXP3, "exp3"), (TUNED_EXP3, "tuned_exp3")):
        found[f"regret_{key}"] = mean_estimate((losses_of(results, method) - oracle).mean(axis=2).ravel())
    lagging = losses_of(results, LAGGING)
    found["to_static_with_lag"] = ratio_estimate(lagging.mean(axis=2).ravel(), static.mean(axis=2).ravel())
    found["regret_with_lag"] = mean_estimate((lagging - oracle).mean(axis=2).ravel())
    gap = (losses_of(results, "BEAT") - oracle).mean(axis=2).ravel()
    found["regret_to_exp3"] = ratio_estimate(gap, (losses_of(results, PRINTED_EXP3) - oracle).mean(axis=2).ravel())
    found["regret_to_static"] = ratio_estimate(gap, (static - oracle).mean(axis=2).ravel())
    return found | _speed(results)


def _speed(results: Sequence[Mapping]) -> dict[str, Estimate]:
    """Steps until the named type is right and stays so; who is never named right counts as infinitely slow."""
    needed = np.concatenate([np.array(r["needed"]) for r in results], axis=1)
    lengths = np.concatenate([np.array(r["lengths"]) for r in results], axis=1)
    found = {}
    for b, steps, length in zip(SIZES, needed, lengths, strict=True):
        right = steps[steps >= 0]
        median = float(np.median(np.where(steps < 0, np.inf, steps)))
        found[f"steps_needed_b{b}"] = Estimate(median, median, _median_interval(steps), len(steps))
        found[f"named_right_b{b}"] = mean_estimate((steps >= 0).astype(float))
        found[f"episodes_needed_b{b}"] = Estimate(
            median / float(length.mean()), median / float(length.mean()), None, len(right)
        )
    within = (needed >= 0) & (needed <= lengths)
    found["named_within_first_episode"] = mean_estimate(within.astype(float).ravel())
    speeds = np.concatenate([np.array(r["right_speed"]) for r in results], axis=1)
    found["right_speed_at_end"] = mean_estimate(speeds.astype(float).ravel())
    return found


def _median_interval(steps: NDArray[np.int64]) -> tuple[float, float] | None:
    """Distribution-free 95 % interval of the median; None where an end is infinite."""
    from scipy.stats import binom

    ordered = np.sort(np.where(steps < 0, np.inf, steps.astype(float)))
    low, high = binom.ppf([0.025, 0.975], len(ordered), 0.5).astype(int)
    ends = float(ordered[max(low - 1, 0)]), float(ordered[min(high, len(ordered) - 1)])
    return ends if np.isfinite(ends).all() else None


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """Mean loss by type and episode of each method, and what part of the players is named right by each step."""
    found: list[dict] = []
    for method in (STATIC, ORACLE, *BEATS, LAGGING, PRINTED_EXP3, TUNED_EXP3):
        mean = losses_of(results, method).mean(axis=1)
        found.append({"method": method, "loss": np.round(mean, 4).tolist()})
    needed = np.concatenate([np.array(r["needed"]) for r in results], axis=1)
    lengths = np.concatenate([np.array(r["lengths"]) for r in results], axis=1)
    steps = [1, 2, 3, 5, 8, 12, 20, 30, 45, 65, 100, 150, 220, 330, 500]
    shares = [[float(((row >= 0) & (row < s)).mean()) for s in steps] for row in needed]
    found.append({"steps": steps, "named": np.round(shares, 3).tolist(), "length": float(lengths.mean())})
    return found
