"""C3.17: advice given in 100 steps as its cost κ grows, and as Q-learning learns.

The gain of advice has a ceiling in each state, above which no κ can be met, whoever walks there:

    KL[θ, p M₁ + (1 - p) / 4] ≤ KL[θ, 1/4] = log 4 - H(θ)

M₁ is θ with α⁰ in it, itself a mixture of θ and the uniform distribution, and a divergence is convex. Whether the
agents of Figure 3.23 followed the advice is not printed: both are measured. A walk that reaches its goal ends.
Thesis: §3.7.2.3, Figure 3.23.
"""

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from lifelore.action.advice.advised_walk import Walk
from lifelore.action.advice.goal_model import GoalModel
from lifelore.core.errors import InputError
from lifelore.core.metrics import entropy
from reproduction.chapter3.advice import mazes
from reproduction.chapter3.advice.learning import learn_errands
from reproduction.chapter3.advice.mazes import AGENTS, Maze, thesis_advisor, walks_of
from reproduction.chapter3.advice.mazes import maze_cells as cells

__all__ = ["cells", "check", "run_cell"]
COUNTS = ("steps", "known", "advised")


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """One maze: advised steps of every agent by κ, heeded and not, for each kind of experts."""
    maze = mazes.maze_of(settings, cell, seed)
    policies = agent_policies(settings, maze)
    kappas, amounts, ceilings = settings["kappas"], [], []
    for kind in settings["experts"]:
        purposes = mazes.goal_models_of(settings, maze, kind)
        pooled, above = GoalModel.pooled(purposes), 0
        top, known = ceiling(pooled), np.array(pooled.theta.any(axis=1))
        advisors = {kappa: thesis_advisor(settings, purposes, kappa) for kappa in kappas}
        for agent, policy in policies.items():
            alone = walks_of(settings, maze, policy, advisors[0.0], heeds=False)
            above += sum(int((w.gain > top[w.states] + 1e-9).sum()) for w in alone)
            watched = [advised_steps(alone, known, kappa) for kappa in kappas]
            heeded = [advised_steps(walks_of(settings, maze, policy, advisors[k]), known) for k in kappas]
            for heeds, counts in ((False, watched), (True, heeded)):
                numbers = dict(
                    zip(("steps", "known", "advised"), map(list, zip(*counts, strict=True)), strict=True)
                )
                amounts.append({"experts": kind, "agent": agent, "heeds": heeds, **numbers})
        states = (top[known, None] >= np.array(kappas) - 1e-12).mean(axis=0)
        ceilings.append({"experts": kind, "states": states.tolist(), "above": above})
    return {**cell, "amounts": amounts, "ceilings": ceilings}


def advised_steps(walks: Sequence[Walk], known: NDArray[np.bool_], kappa: float | None = None) -> list[int]:
    """`COUNTS` of walks: all steps, those in `known` states, and advised; with `kappa`, what it would advise."""
    advised = [w.advised if kappa is None else known[w.states] & (w.gain >= kappa) for w in walks]
    counts = [(len(w.states), known[w.states].sum(), a.sum()) for w, a in zip(walks, advised, strict=True)]
    return np.sum(counts, axis=0).tolist()


def ceiling(pooled: GoalModel) -> NDArray[np.float64]:
    """The greatest gain possible in each state (n_states,), nats; 0 where the advisor is silent."""
    theta = pooled.theta
    known = theta.any(axis=1)
    return np.where(known, np.log(theta.shape[1]) - entropy(theta), 0.0)


def agent_policies(settings: Mapping, maze: Maze) -> dict[str, list]:
    """The policy of each agent on each errand; ``q N`` is Q-learning after N episodes, as it would go on."""
    found = {agent: mazes.policies_of(settings, maze, agent) for agent in AGENTS}
    first, decay, floor = settings["schedule"]
    for episodes in settings["snapshots"]:
        learnt = learn_errands(settings, maze, settings["q_starts"], settings["schedule"], None, episodes)
        epsilon = max(floor, first * decay**episodes)
        found[f"q {episodes}"] = [greedy_policy(learner.q, epsilon) for learner, _ in learnt]
    return found


def greedy_policy(q: NDArray[np.float64], epsilon: float) -> NDArray[np.float64]:
    """The ε-greedy policy (n_states, n_actions) of the values `q`, ties alike."""
    best = q == q.max(axis=1, keepdims=True)
    return (1 - epsilon) * best / best.sum(axis=1, keepdims=True) + epsilon / q.shape[1]


def check(settings: Mapping) -> None:
    kappas, snapshots = settings["kappas"], settings["snapshots"]
    if kappas[:1] != [0.0] or settings["kappa"] not in kappas or sorted(set(kappas)) != kappas:
        raise InputError(f"kappas must rise from 0 and contain kappa ({settings['kappa']}), got {kappas}")
    if sorted(set(snapshots)) != snapshots:
        raise InputError(f"snapshots must be rising numbers of episodes, got {snapshots}")
    if not isinstance(settings["default"].get("heeds"), bool):
        raise InputError(f"default must say whether agents heed, true or false, got {settings['default']}")
