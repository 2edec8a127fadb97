"""`bench novelty`: false alarms, power, delay and AUC of the novelty detector, beside what was used before it.

Each round draws one library for every case, calibrates the detector on tasks simulated from that library alone,
and then meets known and unseen tasks of the true world, which the calibration does not see. Intervals are over
libraries. An AUC is the probability that a statistic is larger for an unseen task than for a known task.
"""

import time
from collections.abc import Sequence
from statistics import median
from typing import Any

import numpy as np
from numpy.typing import NDArray

from benchmarks.interaction.novelty_cases import Case, Draw, cases
from benchmarks.rounds import at_least, at_most, paired_ratio, row
from lifelore.core.metrics import mean_estimate
from lifelore.core.protocols import Progress
from lifelore.core.streams import stream
from lifelore.domains.surveillance.surveillance import Surveillance
from lifelore.interaction.beliefs.type_dynamics import TypeDynamics
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.novelty.calibration import Watched, calibration_of, known_statistic, watch
from lifelore.interaction.novelty.novelty_detector import NoveltyDetector
from lifelore.interaction.novelty.novelty_statistics import NoveltyStatistics
from lifelore.interaction.reuse.bayesian_policy_reuse import BayesianPolicyReuse
from lifelore.interaction.selection import BeliefSampling, ExpectedImprovement

Array = NDArray[np.float64]
Measured = dict[str, list[float]]

HORIZON = 30
RATES = (0.01, 0.05)
CALIBRATION_TASKS, KNOWN_TASKS, UNSEEN_TASKS = 5000, 1500, 200
"""Simulated tasks of the calibration, and tasks of the true world, for each library."""
IMPROVEMENT_SHARE = 4
"""Every how many rounds the cases of expected improvement run: a decision takes 50 times that of sampling."""
EPISODES = (5, 15, 30)
AGENT = {"models": "plug-in", "dynamics": TypeDynamics.static()}
"""Settings of the agents: estimates are taken for the truth, and types do not change."""
MASS = 0.05
"""Prior probability of no known type; the detector's default."""
STATISTICS = {
    "belief's entropy": "entropy",
    "sum of −log evidence": "raw_surprise",
    "standardised surprise": "surprise",
    "shortfall": "shortfall",
    "joined": "statistic",
    "odds of no known type": "log_odds",
}
TOLERANCE = 0.2
"""Largest relative error of a false-alarm rate."""
LEAST_TASKS = 20_000
"""Least number of known tasks that decide on the tolerance; a rate of 1 % then has a standard error of 7 %."""


def bench_novelty(repeats: int, progress: Progress) -> dict:
    """Rows and goals; see `benchmarks.bench`."""
    every = cases()
    work = [(round_, case) for round_ in range(repeats) for case in every if _runs(case, round_)]
    found: dict[str, Measured] = {case.name: {} for case in every}
    for done, (round_, case) in enumerate(work):
        for name, value in measure(case, round_).items():
            found[case.name].setdefault(name, []).append(value)
        progress(done + 1, len(work), case.name)
    rows = [_row(case, name, values) for case, measured in found.items() for name, values in measured.items()]
    cost = update_cost(9)
    return {"rows": rows + cost["rows"], "goals": _goals(found) + cost["goals"]}


def _runs(case: Case, round_: int) -> bool:
    return not isinstance(case.rule, ExpectedImprovement) or round_ % IMPROVEMENT_SHARE == 0


def measure(case: Case, round_: int) -> dict[str, float]:
    """Shares of alarms, delays and AUCs of one library, by name; NaN where no alarm has a delay."""
    generator = stream(0, "bench", "novelty", case.name, round_)
    setting = case.make(generator)
    simulated = known_statistic(
        setting.library, case.rule, HORIZON, CALIBRATION_TASKS, generator, setting.signal_count, **AGENT
    )
    statistics = NoveltyStatistics(setting.library)

    def watched_tasks(draw: Draw, n: int) -> Watched:
        return watch(statistics, case.rule, draw(generator, n), n, HORIZON, generator, **AGENT)

    known = watched_tasks(setting.known, KNOWN_TASKS)
    unseen = {kind: watched_tasks(draw, UNSEEN_TASKS) for kind, draw in setting.unseen.items()}
    measured: dict[str, float] = {}
    for rate in RATES:
        calibration = calibration_of(simulated, rate)

        def alarms(watched: Watched, calibration=calibration) -> NDArray[np.bool_]:
            return calibration.standardised(watched.statistic) > calibration.threshold

        measured[f"false alarms at {rate:.0%}"] = float(alarms(known).any(axis=1).mean())
        for kind, watched in unseen.items():
            raised = alarms(watched)
            some = raised.any(axis=1)
            delay = float(np.median(raised[some].argmax(axis=1) + 1)) if some.any() else np.nan
            measured[f"{kind}: power at {rate:.0%}"] = float(some.mean())
            measured[f"{kind}: delay at {rate:.0%}"] = delay
    for kind, watched in {"known tasks": known, **unseen}.items():
        for episode in EPISODES:
            odds = watched.log_odds[:, episode - 1] + np.log(MASS / (1 - MASS))
            measured[f"{kind}: probability of no known type at {episode}"] = float(
                np.mean(0.5 + 0.5 * np.tanh(odds / 2))
            )
    for kind, watched in unseen.items():
        for label, field in STATISTICS.items():
            for episode in EPISODES:
                pair = (getattr(side, field)[:, episode - 1] for side in (known, watched))
                measured[f"{kind}: AUC of {label} at {episode}"] = auc(*pair)
    return measured


def auc(known: Array, unseen: Array) -> float:
    """Probability that a number of `unseen` exceeds a number of `known`, ties counted by half."""
    order = np.sort(known)
    below = np.searchsorted(order, unseen, side="left") + np.searchsorted(order, unseen, side="right")
    return float(below.mean() / (2 * len(known)))


def update_cost(repeats: int) -> dict:
    """Processor time of an episode at 68 types and 68 policies, with the detector and without."""
    world = Surveillance()
    library = PolicyLibrary.from_means(world.mean, world.deviation)
    detector = NoveltyDetector.calibrate(library, BeliefSampling(), n_tasks=2000, horizon=HORIZON)
    pays = stream(0, "bench", "novelty", "cost").normal(world.mean[7], world.deviation, (200, world.n_targets))
    plain, watched = "episode of the default rule", "the same with the detector"
    times: dict[str, list[float]] = {plain: [], watched: []}
    for number in range(repeats + 1):
        for label in (plain, watched) if number % 2 else (watched, plain):
            agent, own = BayesianPolicyReuse(library), detector.restart()
            started = time.process_time()
            for pay in pays:
                policy = agent.select()
                if label == plain:
                    agent.update(policy, float(pay[policy]))
                else:
                    own.update(agent, policy, float(pay[policy]))
            if number:  # the first round starts compilers and fills caches
                times[label].append((time.process_time() - started) / len(pays) * 1e6)
    ratio = paired_ratio(times[watched], times[plain])
    rows = [row(plain, median(times[plain]), "µs"), row(watched, median(times[watched]), "µs", plain, ratio)]
    return {"rows": rows, "goals": [at_most(f"{watched} / {plain}", 2.0, ratio)]}


def _row(case: str, name: str, values: Sequence[float]) -> dict[str, Any]:
    """The mean over libraries, with its 95 % interval from three libraries on."""
    unit = (
        "episodes"
        if "delay" in name
        else "AUC"
        if "AUC" in name
        else "probability"
        if "probability" in name
        else "share"
    )
    value, interval = _mean(values)
    found = row(f"{case}: {name}", value, unit)
    return found | {"ci95": interval, "libraries": len(values)}


def _mean(values: Sequence[float]) -> tuple[float | None, list[float] | None]:
    finite = np.array([value for value in values if np.isfinite(value)])
    if not finite.size:
        return None, None
    interval = mean_estimate(finite).ci95
    return round(float(finite.mean()), 5), None if interval is None else [round(bound, 5) for bound in interval]


def _goals(found: dict[str, Measured]) -> list[dict[str, Any]]:
    goals = []
    for case, measured in found.items():
        if not case.startswith("surveillance"):
            continue
        for rate in RATES:
            name = f"false alarms at {rate:.0%}"
            value = _mean(measured.get(name, []))[0]
            low, high = rate * (1 - TOLERANCE), rate * (1 + TOLERANCE)
            enough = len(measured.get(name, [])) * KNOWN_TASKS >= LEAST_TASKS
            met = low <= value <= high if enough and value is not None else None
            goals.append(
                {"name": f"{case}: {name}", "goal": f"{low:g} to {high:g}", "measured": value, "met": met}
            )
        least = 0.94 if "exact" in case else 0.86
        for name, values in measured.items():
            if case.endswith("improvement") and name.endswith("AUC of joined at 15"):
                goals.append(at_least(f"{case}: {name}", least, _mean(values)[0]))
    return goals
