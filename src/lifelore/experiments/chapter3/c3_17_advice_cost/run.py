"""C3.17: advice given in 100 steps as its cost κ grows, and as Q-learning learns.

The gain of advice has a ceiling in each state, above which no κ can be met, whoever walks there:

    KL[θ, p M₁ + (1 - p) / 4] ≤ KL[θ, 1/4] = log 4 - H(θ)

M₁ is θ with α⁰ in it, itself a mixture of θ and the uniform distribution, and a divergence is convex. Whether the
agents of Figure 3.23 followed the advice is not printed: both are measured. A walk that reaches its goal ends.
Thesis: §3.7.2.3, Figure 3.23.
"""

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lifelore.action.advice.goal_model import GoalModel
from lifelore.core.errors import InputError
from lifelore.core.metrics import entropy
from lifelore.experiments.chapter3.advice.learning import errand_tables, learn_errand
from lifelore.experiments.chapter3.advice.mazes import (
    AGENTS,
    Errand,
    Maze,
    errands_of,
    goal_models_of,
    maze_of,
    policy_of,
    thesis_advisor,
    walk,
)
from lifelore.experiments.chapter3.advice.mazes import maze_cells as cells

__all__ = ["cells", "check", "run_cell"]


class Experts(NamedTuple):
    """Goal models of one kind of experts, the ceiling of each state, and the states that an expert passed."""

    purposes: Sequence[GoalModel]
    top: NDArray[np.float64]
    known: NDArray[np.bool_]


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """One maze: advised steps of every agent by κ, heeded and not, for each kind of experts."""
    maze = maze_of(settings, cell, seed)
    errands = errands_of(maze, settings["tasks"])
    policies = agent_policies(settings, maze, errands)
    kappas, amounts, ceilings = np.array(settings["kappas"]), [], []
    for kind in settings["experts"]:
        purposes = goal_models_of(settings, maze, kind)
        pooled = GoalModel.pooled(purposes)
        experts, above = Experts(purposes, ceiling(pooled), np.array(pooled.theta.any(axis=1))), 0
        for agent, of_errands in policies.items():
            watched, over = _watched(settings, maze, errands, of_errands, experts)
            heeded = _heeded(settings, maze, errands, of_errands, experts)
            for heeds, counts in ((False, watched), (True, heeded)):
                amounts.append({"experts": kind, "agent": agent, "heeds": heeds, **counts})
            above += over
        states = (experts.top[experts.known, None] >= kappas - 1e-12).mean(axis=0)
        ceilings.append({"experts": kind, "states": states.tolist(), "above": above})
    return {**cell, "amounts": amounts, "ceilings": ceilings}


def ceiling(pooled: GoalModel) -> NDArray[np.float64]:
    """The greatest gain possible in each state (n_states,), nats; 0 where the advisor is silent."""
    theta = pooled.theta
    known = theta.any(axis=1)
    return np.where(known, np.log(theta.shape[1]) - entropy(theta), 0.0)


def agent_policies(settings: Mapping, maze: Maze, errands: Sequence[Errand]) -> dict[str, list]:
    """The policy of each agent on each errand; ``q N`` is Q-learning after N episodes, as it would go on."""
    found = {agent: [policy_of(maze.world, agent, errand) for errand in errands] for agent in AGENTS}
    first, decay, floor = settings["schedule"]
    for episodes in settings["snapshots"]:
        found[f"q {episodes}"] = []
        for number, errand in enumerate(errands):
            tables = errand_tables(maze, errand, number, settings["q_starts"])
            learner, _ = learn_errand(settings, maze, tables, number, settings["schedule"], episodes=episodes)
            found[f"q {episodes}"].append(greedy_policy(learner.q, max(floor, first * decay**episodes)))
    return found


def greedy_policy(q: NDArray[np.float64], epsilon: float) -> NDArray[np.float64]:
    """The ε-greedy policy (n_states, n_actions) of the values `q`, ties alike."""
    best = q == q.max(axis=1, keepdims=True)
    return (1 - epsilon) * best / best.sum(axis=1, keepdims=True) + epsilon / q.shape[1]


def _watched(settings: Mapping, maze: Maze, errands, policies, experts: Experts) -> tuple[dict, int]:
    """Counts of an agent that ignores advice, all κ in one walk; and how many gains exceed the ceiling."""
    advisor = thesis_advisor(settings, experts.purposes, 0.0)
    counts, above = _no_counts(settings), 0
    for number, errand in enumerate(errands):
        walked = walk(maze, errand, policies[number], advisor, number, settings["max_steps"], heeds=False)
        known = experts.known[walked.states]
        above += int((walked.gain > experts.top[walked.states] + 1e-9).sum())
        for k, kappa in enumerate(settings["kappas"]):
            _count(counts, k, known & (walked.gain >= kappa), known)
    return counts, above


def _heeded(settings: Mapping, maze: Maze, errands, policies, experts: Experts) -> dict:
    """Counts of an agent that follows advice, a walk for each κ."""
    counts = _no_counts(settings)
    for k, kappa in enumerate(settings["kappas"]):
        advisor = thesis_advisor(settings, experts.purposes, kappa)
        for number, errand in enumerate(errands):
            walked = walk(maze, errand, policies[number], advisor, number, settings["max_steps"])
            _count(counts, k, walked.advised, experts.known[walked.states])
    return counts


def _no_counts(settings: Mapping) -> dict[str, list[int]]:
    return {key: [0] * len(settings["kappas"]) for key in ("steps", "known", "advised")}


def _count(counts: Mapping[str, list[int]], k: int, advised: NDArray, known: NDArray) -> None:
    counts["steps"][k] += len(advised)
    counts["known"][k] += int(known.sum())
    counts["advised"][k] += int(advised.sum())


def check(settings: Mapping) -> None:
    kappas, snapshots = settings["kappas"], settings["snapshots"]
    if kappas[:1] != [0.0] or settings["kappa"] not in kappas or sorted(set(kappas)) != kappas:
        raise InputError(f"kappas must rise from 0 and contain kappa ({settings['kappa']}), got {kappas}")
    if sorted(set(snapshots)) != snapshots:
        raise InputError(f"snapshots must be rising numbers of episodes, got {snapshots}")
    if not isinstance(settings["default"].get("heeds"), bool):
        raise InputError(f"default must say whether agents heed, true or false, got {settings['default']}")
