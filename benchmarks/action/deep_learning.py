"""One run of DQN in one layout, with the prior or without: how good its greedy walk is while it learns.

The settings were tuned without a prior on SimpleCrossingS9N1, MiniGrid's seeds 1000 to 1002; runs have others.
That world has 42 layouts in all, so that a run can meet one of those three again.
"""

from typing import Any

import gymnasium
from threadpoolctl import threadpool_limits

from benchmarks.action.deep_worlds import layout_seed, one_layout
from lifelore.action.priors.action_prior import ActionPrior
from lifelore.bridges.minigrid_view import open_directions, solved_layout

STEPS, EVERY = 15_000, 500
SETTINGS: dict[str, Any] = {
    "learning_rate": 1e-3,
    "gamma": 0.97,
    "n_steps": 3,
    "buffer_size": 20_000,
    "learning_starts": 1_000,
    "train_freq": 4,
    "batch_size": 64,
    "target_update_interval": 200,
    "exploration_fraction": 0.5,
    "exploration_final_eps": 0.05,
    "policy_kwargs": {"net_arch": [64, 64]},
}
LONGEST = 3
"""A greedy walk of more times the shortest way counts as lost."""


def learnt(name: str, run: int, prior: ActionPrior | None, steps: int = STEPS, every: int = EVERY) -> dict:
    """One run.

    Returns
    -------
    dict
        ``scores``: after each `every` steps, length of the shortest way over that of the greedy walk, 0 where it
        is lost; ``goals``: times the goal was reached while learning; ``shortest``: steps of the shortest way.
    """
    from lifelore.bridges.sb3 import DQN, PriorDQN  # pyright: ignore[reportAttributeAccessIssue]

    layout = layout_seed(name, "learning", run)
    env, examined = one_layout(name, layout), one_layout(name, layout)
    examined.reset()
    shortest = int(solved_layout(examined).steps[solved_layout(examined).passed].max())
    scores: list[float] = []
    goals = 0

    def look(now: dict, _: dict) -> bool:
        nonlocal goals
        goals += int(now["rewards"][0] > 0)
        if now["self"].num_timesteps % every == 0:
            scores.append(greedy_score(now["self"], examined, shortest))
        return True

    about = {"seed": run, "device": "cpu", **SETTINGS}
    with threadpool_limits(1):
        if prior is None:
            model = DQN("MlpPolicy", env, **about)
        else:
            model = PriorDQN("MlpPolicy", env, prior=prior, contexts=open_directions, **about)
        model.learn(steps, callback=look)
    return {"scores": scores, "goals": goals, "shortest": shortest}


def greedy_score(model: Any, env: gymnasium.Env, shortest: int) -> float:
    """`shortest` over the steps of the greedy walk; 0 where it does not arrive within `LONGEST` times as many."""
    seen, _ = env.reset()
    for number in range(1, LONGEST * shortest + 1):
        seen, _, terminated, _, _ = env.step(int(model.predict(seen, deterministic=True)[0]))
        if terminated:
            return shortest / number
    return 0.0
