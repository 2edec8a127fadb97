"""Counts the actions of a trained model into an action prior, which guides learning in later tasks."""

from typing import Any

import gymnasium

from lifelore.action.priors.action_prior import ActionPrior
from lifelore.bridges.observations import Contexts, as_batch, check_actions
from lifelore.core.streams import stream


def count_episodes(
    prior: ActionPrior,
    model: Any,
    env: gymnasium.Env,
    contexts: Contexts,
    episodes: int,
    least: float = 0.0,
    seed: int = 0,
) -> int:
    """Count the actions of a trained model in episodes whose return exceeds `least`; return their number.

    Each visit counts once with equal weight (§3.4.8). States that the model does not visit do not count.

    Parameters
    ----------
    prior : ActionPrior
        Changed in place.
    model : anything with ``predict(observation, deterministic=True)``
        As all models of Stable-Baselines3 and sb3-contrib.
    env : gymnasium.Env
        Episode i is reset by a seed drawn from (`seed`, i).
    """
    check_actions(prior, env.action_space)
    counted = 0
    for episode in range(episodes):
        codes, actions, earned = _episode(model, env, contexts, int(stream(seed, "sb3", episode).integers(2**31)))
        if earned > least:
            prior.update_trajectory(codes, actions)
            counted += 1
    return counted


def _episode(model: Any, env: gymnasium.Env, contexts: Contexts, seed: int) -> tuple[list[int], list[int], float]:
    codes, actions, earned = [], [], 0.0
    observation, _ = env.reset(seed=seed)
    over = False
    while not over:
        codes.append(int(contexts(as_batch(observation))[0]))
        actions.append(int(model.predict(observation, deterministic=True)[0]))
        observation, reward, terminated, truncated, _ = env.step(actions[-1])
        earned += float(reward)
        over = terminated or truncated
    return codes, actions, earned
