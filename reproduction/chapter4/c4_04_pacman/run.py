"""C4.4: policy reuse, PRQ and Q-learning on Pacman. Thesis: §4.6.3, Figure 4.8.

A task is a layout of foods and a ghost's strategy, which no method knows. The counts differ a little: reuse must
last (`first_lasting`), a learner must reach the target once (`first_stretch`).
"""

from collections.abc import Mapping
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from lifelore.core.errors import InputError
from lifelore.core.streams import stream
from lifelore.domains.pacman.pacman import STRATEGIES, PacmanMaze
from lifelore.interaction.baselines.probabilistic_policy_reuse import ProbabilisticPolicyReuse
from lifelore.interaction.beliefs.type_dynamics import TypeDynamics
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.reuse.bayesian_policy_reuse import BayesianPolicyReuse
from lifelore.interaction.selection import BeliefSampling, ExpectedImprovement, InformationDirected
from reproduction.chapter4.c4_04_pacman import pacman_library
from reproduction.chapter4.c4_04_pacman.pacman_library import GREATEST, Arena, falling_schedule, greedy
from reproduction.engine.curve_blocks import block_means

Array = NDArray[np.float64]
MIDDLE_SAMPLES = 30
"""Samples a pair between `samples` and `more_samples`."""
BPR, BPR_EI, BPR_MIDDLE, BPR_MORE, BPR_EXACT = "bpr", "bpr_ei", "bpr_middle", "bpr_more", "bpr_exact"
"""Belief sampling; expected improvement; sampling with models of some and of many samples; with exact models."""
BPR_DOUBTING, BPR_IDS_DOUBTING = "bpr_doubting", "bpr_ids_doubting"
"""Sampling, and information-directed selection, with a belief over types and the parameters of their models."""
BPR_MIDDLE_DOUBTING, BPR_MORE_DOUBTING = "bpr_middle_doubting", "bpr_more_doubting"
"""Sampling with such a belief, and models of some and of many samples."""
REUSERS = {
    BPR: ("learnt", BeliefSampling()),
    BPR_EI: ("learnt", ExpectedImprovement(of="outcome")),
    BPR_MIDDLE: ("middle", BeliefSampling()),
    BPR_MORE: ("more", BeliefSampling()),
    BPR_EXACT: ("exact", BeliefSampling()),
    BPR_DOUBTING: ("learnt", BeliefSampling()),
    BPR_IDS_DOUBTING: ("learnt", InformationDirected()),
    BPR_MIDDLE_DOUBTING: ("middle", BeliefSampling()),
    BPR_MORE_DOUBTING: ("more", BeliefSampling()),
}
"""The models and the rule of each form of reuse."""
PRQ, PRQ_SCALED, Q = "prq", "prq_scaled", "q"
"""PRQ with returns as they are; with returns in units of the greatest; Q-learning."""
DISCOUNTED = "_discounted"
"""Added to a learner's name where it discounts as the library's training does."""
LEARNERS = tuple(name + extra for extra in ("", DISCOUNTED) for name in (PRQ, PRQ_SCALED, Q))
LEAST_DEVIATION = 1e-3 * 240
"""Least deviation of exact models: a thousandth of the range of returns, as with learnt models."""


def check(settings: Mapping) -> None:
    checkpoints = [0, *settings["checkpoints"], settings["episodes"]]
    if any(not isinstance(place, int) for place in checkpoints) or (np.diff(checkpoints) < 1).any():
        raise InputError(f"checkpoints must rise between 0 and episodes, got {settings['checkpoints']}")
    if not settings["samples"] <= MIDDLE_SAMPLES <= settings["more_samples"]:
        given = f"{settings['samples']} and {settings['more_samples']}"
        raise InputError(f"samples and more_samples must have {MIDDLE_SAMPLES} between them, got {given}")
    PacmanMaze(settings["rows"], settings["columns"])


def cells(settings: Mapping) -> list[dict]:
    return [{"layout": layout} for layout in range(settings["layouts"])]


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """One layout: its library, each type's tasks, and tasks whose foods lie elsewhere."""
    maze, here = PacmanMaze(settings["rows"], settings["columns"]), (seed, "pacman", cell["layout"])
    foods = maze.draw_foods(stream(*here, "foods"))
    at_home = pacman_library.arenas(maze, foods)
    policies = pacman_library.trained_policies(settings, at_home, here)
    mean, deviation = pacman_library.exact_moments(at_home, policies)
    samples = pacman_library.sampled_returns(at_home, policies, settings["more_samples"], (*here, "samples"))
    known = {
        "learnt": PolicyLibrary.from_samples(samples[..., : settings["samples"]], STRATEGIES, STRATEGIES),
        "middle": PolicyLibrary.from_samples(samples[..., :MIDDLE_SAMPLES], STRATEGIES, STRATEGIES),
        "more": PolicyLibrary.from_samples(samples, STRATEGIES, STRATEGIES),
        "exact": PolicyLibrary.from_means(mean, np.maximum(deviation, LEAST_DEVIATION), STRATEGIES, STRATEGIES),
    }
    tasks = [
        _task(settings, arena, policies, mean[number], known, (*here, "task", arena.task.strategy))
        for number, arena in enumerate(at_home)
    ]
    moved = [
        _moved(settings, arena, policies, known, (*here, "moved", arena.task.strategy))
        for arena in pacman_library.arenas(maze, maze.draw_foods(stream(*here, "other foods")))
    ]
    plain = {"foods": list(foods), "mean": mean.round(2).tolist(), "deviation": deviation.round(2).tolist()}
    return {**cell, **plain, "tasks": tasks, "moved": moved}


def _task(settings: Mapping, arena: Arena, policies: Array, mean: Array, known: Mapping, stream_of: tuple) -> dict:
    """All methods on one task: episodes needed, and their mean return in blocks of episodes."""
    n, window, target = settings["episodes"], settings["window"], mean.max() - settings["tolerance"] * GREATEST
    drawn = arena.returns_of_each(policies, n, (*stream_of, "reuse"))
    needed, stretch, regret, first_greedy, curves = {}, {}, {}, {}, {}
    for name, (model, rule) in REUSERS.items():
        returns = drawn if name == BPR else drawn[:, : settings["peer_episodes"]]
        chosen = reused(known[model], rule, returns, (*stream_of, name), doubting=name.endswith("doubting"))
        needed[name] = first_lasting(mean[chosen], target, window)
        curves[name] = returns[chosen, np.arange(len(chosen))]
        stretch[name] = first_stretch(curves[name], target, window)
        regret[name] = round(float((mean.max() - mean[chosen[: settings["peer_episodes"]]]).sum()), 1)
    for name in LEARNERS:
        curves[name], first_greedy[name] = _learn(settings, name, arena, policies, target, stream_of)
        needed[name] = first_stretch(curves[name], target, window)
    return {
        "type": arena.task.strategy,
        "best": float(mean.max()),
        "needed": needed,
        "stretch": stretch,
        "regret": regret,
        "greedy": first_greedy,
        "curves": {name: np.round(block_means(curves[name]), 1).tolist() for name in (BPR, PRQ, Q)},
    }


def _moved(settings: Mapping, arena: Arena, policies: Array, known: Mapping, stream_of: tuple) -> dict:
    """Final returns of reuse and of learners on a task whose foods lie elsewhere than in training."""
    mean, n = np.array([arena.moments(policy)[0] for policy in policies]), settings["peer_episodes"]
    drawn = arena.returns_of_each(policies, n, (*stream_of, "reuse"))
    chosen = reused(known["learnt"], BeliefSampling(), drawn, (*stream_of, BPR))
    found = {"best": mean.max(), BPR: mean[chosen[-(n // 2) :]].mean()}
    for name in LEARNERS:
        rewards, _ = _learn(settings, name, arena, policies, None, stream_of)
        found[name] = rewards[-settings["window"] :].mean()
    return {"type": arena.task.strategy} | {name: round(float(value), 2) for name, value in found.items()}


def reused(
    library: PolicyLibrary, rule, returns: Array, stream_of: tuple, doubting: bool = False
) -> NDArray[np.int64]:
    """The policies that BPR selects, given the return of each in each episode, (n_policies, n_episodes)."""
    models = "uncertain" if doubting else "plug-in"
    agent = BayesianPolicyReuse(
        library, rule, dynamics=TypeDynamics.static(), seed=stream(*stream_of), models=models
    )
    chosen = np.empty(returns.shape[1], np.int64)
    for episode in range(returns.shape[1]):
        policy = chosen[episode] = agent.select()
        agent.update(policy, float(returns[policy, episode]))
    return chosen


def first_lasting(expected: Array, target: float, window: int) -> int | None:
    """First episode, counted from 1, of a stretch of `window` whose every expected return reaches the target."""
    return first_stretch((expected >= target).astype(float), 1.0, window)


def first_stretch(returns: Array, target: float, window: int) -> int | None:
    """First episode, counted from 1, of a stretch of `window` whose *mean* return reaches the target.

    Chance may lift a mean over it, and the episodes before the stretch need not be as good.
    """
    # Summed before divided: a hundred returns of 140 have the mean 140.
    reached = np.flatnonzero(np.convolve(returns, np.ones(window), mode="valid") / window >= target)
    return int(reached[0]) + 1 if reached.size else None


def _learn(settings: Mapping, name: str, arena: Arena, policies: Array, target: float | None, stream_of: tuple):
    """A learner's rewards by episode, and the episode from which its greedy policy stays as good as the target.

    The greedy policy's exact value is computed at the `checkpoints` and at the end. The episode is the checkpoint
    *before* the first from which all values are good enough, so that no episode too many is counted; None where
    the last value is not, or without a target.
    """
    n = settings["episodes"]
    discount = settings["training_discount"] if name.endswith(DISCOUNTED) else 1.0
    plan = falling_schedule(settings["epsilon"], settings["rate"], n, discount)
    learn, q = _learner(name.removesuffix(DISCOUNTED), arena, policies, stream_of)
    rewards, good_since = [], None
    for begin, end in pairwise([0, *settings["checkpoints"], n]):
        rewards.append(learn(plan._replace(epsilon=plan.epsilon[begin:end], alpha=plan.alpha[begin:end])).rewards)
        good = target is not None and arena.moments(greedy(q))[0] >= target
        good_since = (good_since or max(begin, 1)) if good else None
    return np.concatenate(rewards), good_since


def _learner(name: str, arena: Arena, policies: Array, stream_of: tuple):
    """A learner that goes on for the episodes of a schedule, and its table of values, changed in place."""
    if name == Q:
        learner = arena.begin(stream_of)
        return lambda plan: arena.learn(learner, plan), learner.q
    prq = ProbabilisticPolicyReuse(gain_unit=GREATEST if name == PRQ_SCALED else 1.0)
    world, own = stream(*stream_of, "world"), stream(*stream_of, "learner")
    reuser = prq.begin(arena.task.n_observations, policies, world, own)
    return lambda plan: prq.learn(arena.tables, arena.rows, policies, plan, reuser)[0], reuser.q
