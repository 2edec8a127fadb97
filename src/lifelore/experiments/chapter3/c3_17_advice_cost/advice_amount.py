"""How much is advised as κ grows: agents of fixed policy, and Q-learning after more and more episodes (C3.17).

    KL[θ, p M₁ + (1 - p) / 4] ≤ KL[θ, 1/4] = log 4 - H(θ)

M₁ is θ with α⁰ in it, itself a mixture of θ and the uniform distribution, and a divergence is convex: so this is
the ceiling above which κ can never be met in a state, whoever walks there. Thesis: §3.7.2.3, Figure 3.23.
"""

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from lifelore.action.advice.goal_model import GoalModel
from lifelore.core.metrics import entropy
from lifelore.experiments.chapter3.advice_grid import (
    AGENTS,
    Errand,
    Maze,
    errands_of,
    maze_of,
    policy_of,
    purposes_of,
    thesis_advisor,
    walk,
)
from lifelore.experiments.chapter3.advised_learning import errand_tables, learn_errand


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """One maze: advised steps of every agent by κ, heeded and not, for each kind of experts."""
    maze = maze_of(settings, cell, seed)
    errands = errands_of(maze, settings["tasks"])
    policies = agent_policies(settings, maze, errands)
    amounts, ceilings = [], []
    for experts in settings["experts"]:
        purposes = purposes_of(settings, maze, experts)
        pooled = GoalModel.pooled(purposes)
        top, known = ceiling(pooled), pooled.theta.any(axis=1)
        passed = []
        for agent, of_errands in policies.items():
            watched, over = _watched(settings, maze, errands, of_errands, purposes, (top, known))
            heeded = _heeded(settings, maze, errands, of_errands, purposes, known)
            amounts += [{"experts": experts, "agent": agent, "heeds": False} | watched]
            amounts += [{"experts": experts, "agent": agent, "heeds": True} | heeded]
            passed.append(over)
        kappas = np.array(settings["kappas"])
        states = (top[known, None] >= kappas - 1e-12).mean(axis=0)
        ceilings.append({"experts": experts, "states": states.tolist(), "above": int(sum(passed))})
    return {**cell, "amounts": amounts, "ceilings": ceilings}


def ceiling(pooled: GoalModel) -> NDArray[np.float64]:
    """The greatest gain possible in each state (n_states,), nats; 0 where the advisor is silent."""
    theta = pooled.theta
    known = theta.any(axis=1)
    return np.where(known, np.log(theta.shape[1]) - entropy(theta), 0.0)


def agent_policies(settings: Mapping, maze: Maze, errands: Sequence[Errand]) -> dict[str, list]:
    """The policy of each agent on each errand; ``q N`` is Q-learning after N episodes, as it would go on."""
    found = {agent: [policy_of(maze.world, agent, errand) for errand in errands] for agent in AGENTS}
    for episodes in settings["snapshots"]:
        found[f"q {episodes}"] = [
            _learnt_policy(settings, maze, errand, number, episodes) for number, errand in enumerate(errands)
        ]
    return found


def _learnt_policy(settings: Mapping, maze: Maze, errand: Errand, number: int, episodes: int):
    tables = errand_tables(maze, errand, number, settings["q_starts"])
    learner, _ = learn_errand(settings, maze, tables, number, settings["schedule"], episodes=episodes)
    first, decay, floor = settings["schedule"]
    return greedy_policy(learner.q, max(floor, first * decay**episodes))


def greedy_policy(q: NDArray[np.float64], epsilon: float) -> NDArray[np.float64]:
    """The ε-greedy policy (n_states, n_actions) of the values `q`, ties alike."""
    best = q == q.max(axis=1, keepdims=True)
    return (1 - epsilon) * best / best.sum(axis=1, keepdims=True) + epsilon / q.shape[1]


def _watched(settings, maze: Maze, errands, policies, purposes, of_states) -> tuple[dict, int]:
    """Of an agent that is never told: every κ at once, as nothing it does changes; and gains above the ceiling."""
    top, known = of_states
    advisor = thesis_advisor(settings, purposes, 0.0)
    counts, above = _no_counts(settings), 0
    for number, errand in enumerate(errands):
        walked = walk(maze, errand, policies[number], advisor, number, settings["max_steps"], False)
        shown = known[walked.states]
        above += int((walked.gain > top[walked.states] + 1e-9).sum())
        for k, kappa in enumerate(settings["kappas"]):
            _count(counts, k, shown & (walked.gain >= kappa), shown)
    return counts, above


def _heeded(settings, maze: Maze, errands, policies, purposes, known) -> dict:
    counts = _no_counts(settings)
    for k, kappa in enumerate(settings["kappas"]):
        advisor = thesis_advisor(settings, purposes, kappa)
        for number, errand in enumerate(errands):
            walked = walk(maze, errand, policies[number], advisor, number, settings["max_steps"])
            _count(counts, k, walked.advised, known[walked.states])
    return counts


def _no_counts(settings: Mapping) -> dict[str, list[int]]:
    return {key: [0] * len(settings["kappas"]) for key in ("steps", "known", "advised")}


def _count(counts: Mapping[str, list[int]], k: int, advised, shown) -> None:
    counts["steps"][k] += len(advised)
    counts["known"][k] += int(shown.sum())
    counts["advised"][k] += int(advised.sum())
