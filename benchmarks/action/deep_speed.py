"""What the prior costs a step of DQN, and its masks a step of MaskablePPO: both learn in turns."""

import time
from collections.abc import Callable
from typing import Any

import numpy as np
from threadpoolctl import threadpool_limits

from benchmarks.action.deep_worlds import new_world
from benchmarks.rounds import Rates, interleaved
from lifelore.action.priors.action_prior import ActionPrior
from lifelore.bridges.minigrid_view import N_MOVES, SymbolicView, open_directions

WORLD = "SimpleCrossingS9N1"
ROUNDS, BLOCK = 60, 256
"""Rounds, and steps of each block that is timed."""
SELDOM, ALWAYS, MASKS = "DQN, ε 0.05", "DQN, ε 1", "MaskablePPO"
PLAIN, PRIOR = "as it is", "with prior"


def blocks(case: str) -> dict[str, Callable[[], float]]:
    """Two learners of one case, each as a function that learns for a block: CPU microseconds a step.

    The prior holds every move as likely as any other, so that both live through the same law of episodes.
    """
    prior = ActionPrior(N_MOVES)
    prior.update(np.arange(8), np.ones((8, N_MOVES), bool))
    models = _masked(prior) if case == MASKS else _exploring(prior, 1.0 if case == ALWAYS else 0.05)
    for model in models.values():
        model.learn(2 * BLOCK)  # buffers filled, code warm
    return {who: _timed(model) for who, model in models.items()}


def measured(case: str, after: Callable[[str], None], rounds: int = ROUNDS) -> Rates:
    """CPU microseconds a step of both, round by round."""
    with threadpool_limits(1):
        return interleaved(blocks(case), rounds, after)


def _exploring(prior: ActionPrior, epsilon: float) -> dict[str, Any]:
    """DQN as Stable-Baselines3 sets it, but for a smaller buffer."""
    from lifelore.bridges.sb3 import DQN, PriorDQN  # pyright: ignore[reportAttributeAccessIssue]

    about = {
        "exploration_initial_eps": epsilon,
        "exploration_final_eps": epsilon,
        "buffer_size": 20_000,
        "seed": 0,
        "device": "cpu",
    }
    env = SymbolicView(new_world(WORLD))
    guided = PriorDQN("MlpPolicy", env, prior=prior, contexts=open_directions, **about)
    return {PLAIN: DQN("MlpPolicy", SymbolicView(new_world(WORLD)), **about), PRIOR: guided}


def _masked(prior: ActionPrior) -> dict[str, Any]:
    """MaskablePPO as sb3-contrib sets it, but for a rollout as long as a block; once with masks of ones."""
    from sb3_contrib import MaskablePPO  # pyright: ignore[reportMissingImports]
    from sb3_contrib.common.wrappers import ActionMasker  # pyright: ignore[reportMissingImports]

    from lifelore.bridges.prior_mask import PriorMask

    ones = np.ones(N_MOVES, bool)
    free = ActionMasker(SymbolicView(new_world(WORLD)), lambda env: ones)
    masked = PriorMask(SymbolicView(new_world(WORLD)), prior, open_directions)
    return {
        who: MaskablePPO("MlpPolicy", env, n_steps=BLOCK, seed=0, device="cpu")
        for who, env in ((PLAIN, free), (PRIOR, masked))
    }


def _timed(model: Any) -> Callable[[], float]:
    def block() -> float:
        began = time.process_time()
        model.learn(BLOCK, reset_num_timesteps=False)
        return (time.process_time() - began) / BLOCK * 1e6

    return block
