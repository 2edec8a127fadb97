"""`bench deep_layouts`: MaskablePPO and DQN with a prior where every episode has another layout.

MaskablePPO is measured in one layout a run as well; `bench deep` has that for DQN.

As MiniGrid registers its worlds, each `reset` draws a layout. A policy for all layouts must read the view, so that
the learner cannot recall a path. Judged is the greedy walk in layouts that no learner met. MaskablePPO has
the settings of sb3-contrib but for those in `PPO`; DQN those of `deep_learning`. None was tuned here.
"""

from collections.abc import Mapping, Sequence
from typing import Any

import gymnasium
import numpy as np
from threadpoolctl import threadpool_limits

from benchmarks.action import deep_learning
from benchmarks.action.deep_worlds import crossing_prior, layout_seed, new_world, one_layout
from benchmarks.rounds import at_least, estimated_row
from lifelore.action.priors.action_prior import ActionPrior
from lifelore.bridges.minigrid_view import SymbolicView, open_directions, solved_layout
from lifelore.core.metrics import interquartile_mean_estimate, mean_estimate
from lifelore.core.protocols import Progress
from lifelore.core.streams import stream

WORLD = "SimpleCrossingS9N1"
MASKABLE_PPO, DQN = "MaskablePPO", "DQN"
ONE, EVERY = "one layout", "another layout every episode"
Case = tuple[str, str]
CASES: dict[Case, int] = {(MASKABLE_PPO, ONE): 10_000, (MASKABLE_PPO, EVERY): 30_000, (DQN, EVERY): 15_000}
"""Method and layouts to the number of steps of a run."""
PLAIN, PRIOR = "without prior", "with prior"
CHECKS = 5
"""Times that a run is judged, at equal distances."""
JUDGED = 20
"""Layouts in which a policy for all layouts is judged."""
PPO: dict[str, Any] = {"n_steps": 512, "gamma": 0.97, "device": "cpu"}
ESCAPE = 0.02


LEAST_RUNS = 10


def bench_deep_layouts(repeats: int, progress: Progress, cases: Mapping[Case, int] = CASES) -> dict:
    """Rows and goals; see `benchmarks.bench`. `repeats` are runs of learning of each case.

    Raises
    ------
    MissingExtraError
        Stable-Baselines3 is not installed.
    """
    import lifelore.bridges.sb3  # noqa: F401  says at once which extra is missing

    priors = {PLAIN: None, PRIOR: crossing_prior()}
    runs: dict[Case, dict[str, list[dict[str, Any]]]] = {case: {PLAIN: [], PRIOR: []} for case in cases}
    done, total = 0, len(cases) * len(priors) * repeats
    for run in range(repeats):
        for (method, layouts), steps in cases.items():
            for who, prior in priors.items():
                runs[method, layouts][who].append(learnt(method, layouts, run, prior, steps))
                done += 1
                progress(done, total, f"{method} {who}, {layouts}, run {run + 1}")
    return {"rows": layout_rows(runs), "goals": [at_least("runs of each case", LEAST_RUNS, repeats)]}


class OtherLayouts(gymnasium.Wrapper):
    """Another layout every episode, drawn from the run's own stream."""

    def __init__(self, env: gymnasium.Env, *names: str | int) -> None:
        super().__init__(env)
        self.random = stream(0, "bench", "deep", "layouts", *names)

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Any, dict[str, Any]]:
        """Always with the next seed of the stream."""
        return self.env.reset(seed=int(self.random.integers(2**31)), options=options)


def learnt(method: str, layouts: str, run: int, prior: ActionPrior | None, steps: int) -> dict[str, Any]:
    """One run: ``scores``, the mean score of the greedy walk at each check (see `deep_learning.greedy_score`), and
    ``goals``, the times the goal was reached while learning.
    """
    env = one_layout(WORLD, layout_seed(WORLD, "learning", run))
    if layouts == EVERY:
        env = OtherLayouts(SymbolicView(new_world(WORLD)), method, run)
    judged = [layout_seed(WORLD, "learning", run)]
    if layouts == EVERY:
        judged = [layout_seed(WORLD, "judged", number) for number in range(JUDGED)]
    scores: list[float] = []
    goals = 0

    def look(now: dict, _: dict) -> bool:
        nonlocal goals
        goals += int(now["rewards"][0] > 0)
        if now["self"].num_timesteps % (steps // CHECKS) == 0 and len(scores) < CHECKS:
            scores.append(float(np.mean([_score(now["self"], layout, prior, method) for layout in judged])))
        return True

    with threadpool_limits(1):
        _model(method, env, run, prior).learn(steps, callback=look)
    return {"scores": scores, "goals": goals}


def _model(method: str, env: gymnasium.Env, run: int, prior: ActionPrior | None) -> Any:
    from lifelore.bridges.prior_mask import PriorMask
    from lifelore.bridges.sb3 import DQN as PlainDQN  # pyright: ignore[reportAttributeAccessIssue]
    from lifelore.bridges.sb3 import PriorDQN

    if method == DQN:
        settings = {"seed": run, "device": "cpu", **deep_learning.SETTINGS}
        if prior is None:
            return PlainDQN("MlpPolicy", env, **settings)
        return PriorDQN("MlpPolicy", env, prior=prior, contexts=open_directions, **settings)
    from sb3_contrib import MaskablePPO  # pyright: ignore[reportMissingImports]

    # An empty prior masks nothing, so that both learners run the same code.
    masked = PriorMask(env, prior or ActionPrior(3), open_directions, escape=ESCAPE)
    return MaskablePPO("MlpPolicy", masked, seed=run, **PPO)


def _score(model: Any, layout: int, prior: ActionPrior | None, method: str) -> float:
    """Length of the shortest path over that of the greedy walk; 0 if it takes more than three times as long."""
    env = one_layout(WORLD, layout)
    seen, _ = env.reset()
    solved = solved_layout(env)
    shortest = int(solved.steps[solved.passed].max())
    for number in range(1, deep_learning.LONGEST * shortest + 1):
        masks: dict[str, Any] = {}
        if method == MASKABLE_PPO and prior is not None:
            masks = {"action_masks": prior.mask(open_directions(seen[None]))}
        action = np.ravel(model.predict(seen, deterministic=True, **masks)[0])[0]
        seen, _, terminated, _, _ = env.step(int(action))
        if terminated:
            return shortest / number
    return 0.0


def layout_rows(runs: Mapping[Case, Mapping[str, Sequence[Mapping[str, Any]]]]) -> list[dict]:
    """Rows of each case from its runs: last score and goals of both learners, and their paired difference."""
    rows = []
    for (method, layouts), by_who in runs.items():
        case = f"{WORLD}, {layouts}, {method}"
        for measure, unit in (("score at the end", "of optimal"), ("goals reached while learning", "goals")):
            values = {who: _values(of, measure) for who, of in by_who.items()}
            for who, of in values.items():
                rows.append(estimated_row(f"{case} {who}, {measure}", mean_estimate(of), unit))
            gained = values[PRIOR] - values[PLAIN]
            rows.append(estimated_row(f"{case}, {measure}, gain by prior, mean", mean_estimate(gained), unit))
            middle = interquartile_mean_estimate(gained[:, None])
            rows.append(estimated_row(f"{case}, {measure}, gain by prior, interquartile mean", middle, unit))
    return rows


def _values(runs: Sequence[Mapping[str, Any]], measure: str) -> np.ndarray:
    if measure.startswith("score"):
        return np.array([run["scores"][-1] for run in runs])
    return np.array([float(run["goals"]) for run in runs])
