"""What a task set's minimised domain keeps and what it costs: exact values, traps, exploration, learning.

The domain as printed renormalises outcomes that lead out of it, and where none is left (η = 1/0) the action is
taken out, the kindest reading. The closed one mends both faults of the other two (errata E8, E36). In a state
without kept actions, such as another task's goal, a learner stays for nothing (`stay`), or has all actions of the
domain again (`free`); a policy that could choose to end there is no policy, so exact values give such a state the
worst reward for ever. Learners within a minimised domain see kept actions alone, in exploring, in ties and in the
best, and the world's own outcomes, which nothing renormalises. Thesis: §3.2.3, Thm 3.2.6, Props. 3.2.7-3.2.8.
"""

from collections.abc import Iterator, Mapping

import numpy as np
from numpy.typing import NDArray

from lifelore.action.search import domain_reduction
from lifelore.action.search.domain_reduction import FORMS, MinimisedDomain, tables_within, trap_states
from lifelore.core.errors import InputError
from lifelore.core.learning.curve import Curve, new_curve
from lifelore.core.learning.learning_metrics import episodes_to_threshold
from lifelore.core.learning.q_learning import Schedule, learn, new_learner, uniform_rows
from lifelore.core.mdp import TERMINAL, Tables
from lifelore.core.planning.planning import optimal_q
from lifelore.core.streams import stream
from reproduction.chapter3.c3_14_minimised_domains import minimised_worlds
from reproduction.chapter3.c3_14_minimised_domains.minimised_worlds import Solved, TaskSet, task_set
from reproduction.chapter3.learning.grid_tasks import drawn_starts
from reproduction.chapter3.learning.schedules import schedule_of

WHOLE = "domain"
WITHIN = (("repaired", "stay"), ("repaired", "free"), ("printed", "stay"), ("closed", "stay"))
"""Definition, and what a state without kept actions does, of the domains that are learnt in."""
TRACE = 1e-12
EQUAL = 1e-9
"""Relative to the largest reward: values nearer than this are equal."""


def values_within(tables: Tables, domain: MinimisedDomain, discount: float) -> NDArray[np.float64]:
    """Optimal action values of a task in the minimised domain, (n_states, n_actions); -inf where not kept.

    Outcomes outside it are left out and the others renormalised, which changes nothing in the repaired form.
    """
    pairs = domain.pairs & ~domain.without_successor
    if (domain.leading_out & pairs).any():
        return _renormalised_values(tables, domain, discount)
    within = tables_within(tables, pairs, "stay")
    stuck = ~pairs.any(axis=1)
    within.reward[stuck], within.event[stuck] = _lowest(tables, discount), TERMINAL
    q = optimal_q(within, discount)
    q[~pairs] = -np.inf
    return q


def _lowest(tables: Tables, discount: float) -> float:
    """The worst reward for ever, or none if no reward is a loss."""
    return min(0.0, float(tables.reward.min())) / (1 - discount)


def _renormalised_values(tables: Tables, domain: MinimisedDomain, discount: float) -> NDArray[np.float64]:
    """The same by sweeps over kept states, outcomes that lead out left out."""
    acting = np.flatnonzero(domain.pairs.any(axis=1))
    follow, reward = tables.next_state[acting], tables.reward[acting]
    mass = np.diff(tables.outcome_cum, prepend=0.0) * domain.states[follow]
    total = mass.sum(axis=2, keepdims=True)
    mass = np.divide(mass, total, out=np.zeros_like(mass), where=total > 0)
    kept = domain.pairs[acting] & (total[..., 0] > 0)
    some = kept.any(axis=1)
    lowest = _lowest(tables, discount)
    value, q = np.full(tables.n_states, lowest), np.full(domain.pairs.shape, -np.inf)
    gain, stays = (mass * reward).sum(axis=2), discount * mass * ((tables.event[acting] & TERMINAL) == 0)
    tolerance = EQUAL * 1e-3 * max(1.0, float(np.abs(tables.reward).max()))
    while True:
        q[acting] = np.where(kept, gain + (stays * value[follow]).sum(axis=2), -np.inf)
        better = np.where(some, q[acting].max(axis=1), lowest)
        moved = np.abs(better - value[acting]).max(initial=0.0)
        value[acting] = better
        if moved <= tolerance:
            return q


def kept(task: Solved, domain: MinimisedDomain, discount: float) -> dict:
    """Whether the task's optimal return is obtained from every start, and its policy is still optimal."""
    q = values_within(task.tables, domain, discount)
    near = EQUAL * max(1.0, float(np.abs(task.tables.reward).max())) / (1 - discount)
    starts = task.tables.starts
    whole, within = task.q.max(axis=1), q.max(axis=1)
    acting = domain_reduction.reachable_states(task.tables, task.best) & task.best.any(axis=1)
    chosen = acting[:, None] & task.best
    lost = np.where(chosen, within[:, None] - np.where(np.isfinite(q), q, -1e300), 0.0)
    return {
        "return_kept": bool((np.abs(whole[starts] - within[starts]) <= near).all()),
        "policy_kept": bool((lost <= near).all() and (within[starts] >= whole[starts] - near).all()),
    }


def traps(task: Solved, domain: MinimisedDomain) -> dict:
    """Trap states and dead ends of a task: the domain's, how many of them are kept, the minimised domain's."""
    whole = int(trap_states(task.tables).sum())
    usable = domain.pairs & ~domain.without_successor
    within = int((trap_states(task.tables, usable) & domain.states).sum())
    left = int((trap_states(task.tables) & domain.states).sum())
    return {"traps": whole, "traps_left": left, "traps_within": within, "states": int(domain.states.sum())}


def learn_within(
    task: Solved, pairs: NDArray[np.bool_] | None, dead_ends: str, schedule: Schedule, purpose: str
) -> Curve:
    """Learn a task in its domain, or with `pairs` alone to choose from; `purpose` names the streams."""
    tables = task.tables
    allowed = np.ones((tables.n_states, tables.n_actions), bool)
    if pairs is not None:
        tables = tables_within(tables, pairs, dead_ends)
        allowed = pairs | ~pairs.any(axis=1, keepdims=True)
    rows = uniform_rows(tables, allowed / allowed.sum(axis=1, keepdims=True), np.where(allowed, 1.0, TRACE))
    world, own = (stream(*task.stream, purpose, of) for of in ("world", "own"))
    learner = new_learner(tables.n_states, tables.n_actions, world, own)
    learner.q[~allowed] = -np.inf
    curve = new_curve(schedule.epsilon.size)
    learn(tables, rows, schedule, learner, curve, schedule.epsilon.size * schedule.max_steps)
    return curve


def best_returns(task: Solved, n_episodes: int, purpose: str) -> NDArray[np.float64]:
    """The optimal return from where each episode starts; worlds of one outcome draw nothing but starts."""
    if task.tables.outcome_cum.size > 1:
        return np.full(n_episodes, task.q[task.tables.starts].max(axis=1).mean())
    return task.q[drawn_starts(task.tables, (*task.stream, purpose), n_episodes)].max(axis=1)


def explored(tasks: TaskSet, pairs: NDArray[np.bool_] | None, dead_ends: str, episodes: int) -> dict:
    """Pure exploration, learning nothing: collisions a step, and the share of episodes that reach the goal."""
    flat = Schedule(np.ones(episodes), np.zeros(episodes), tasks.max_steps, tasks.discount)
    curves = [learn_within(task, pairs, dead_ends, flat, "explore") for task in tasks.tasks]
    collisions, steps = (sum(int(getattr(c, name).sum()) for c in curves) for name in ("collisions", "steps"))
    reached = float(np.mean([c.reached.mean() for c in curves]))
    return {"explored_collisions": collisions / steps, "explored_reached": reached}


def learnt(tasks: TaskSet, pairs, dead_ends: str, settings: Mapping, epsilon) -> dict:
    """Learning of some tasks of the set: mean returns, and episodes to 80 % of the optimal return.

    Where that is below zero, to as much below it as a fifth of it. `regret` is what the last episodes miss of it.
    """
    schedule = schedule_of({**settings, "discount": tasks.discount, "max_steps": tasks.max_steps}, epsilon)
    chosen, last = tasks.tasks[: settings["learnt_tasks"]], settings["window"]
    curves = [learn_within(task, pairs, dead_ends, schedule, "learn") for task in chosen]
    returns = np.mean([curve.returns for curve in curves], axis=0)
    best = np.mean([best_returns(task, settings["episodes"], "learn") for task in chosen], axis=0)
    reached = episodes_to_threshold(returns - best + 0.2 * np.abs(best), 0.0, last)
    return {
        "to_80": settings["episodes"] if reached is None else reached,
        "never_80": reached is None,
        "first_ten": float(returns[:10].mean()),
        "regret": float((best - returns)[-last:].sum() / np.abs(best)[-last:].sum()),
        "collisions": sum(int(curve.collisions.sum()) for curve in curves) / len(curves),
    }


def cells(settings: Mapping) -> list[dict]:
    """Every kind of world, run by run."""
    return [{"kind": kind, "run": run} for run in range(settings["runs"]) for kind in settings["kinds"]]


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """One set of tasks: what its minimised domains keep, how exploring and learning in them goes.

    For random worlds also `worlds` further sets, exactly alone.
    """
    names = (seed, "C3.14", cell["kind"], cell["run"])
    more = settings["worlds"] if cell["kind"].endswith("few starts") else 0
    sets = [task_set(cell["kind"], settings, own) for own in (names, *((*names, "exact", i) for i in range(more)))]
    return {**cell, "exact": [exact(tasks) for tasks in sets], "learning": list(_learning(settings, sets[0]))}


def domains_of(tasks: TaskSet) -> dict[str, MinimisedDomain]:
    """The set's minimised domain by each definition."""
    tables, best = [t.tables for t in tasks.tasks], [t.best for t in tasks.tasks]
    return {form: domain_reduction.minimised_domain(tables, best, form) for form in FORMS}


def exact(tasks: TaskSet) -> dict:
    """Of each form, what every task keeps, its traps, and what is undefined."""
    found = {}
    for form, domain in domains_of(tasks).items():
        each = [{**kept(t, domain, tasks.discount), **traps(t, domain)} for t in tasks.tasks]
        found[form] = {"tasks": each, "undefined": int(domain.without_successor.sum())}
    return found


def _learning(settings: Mapping, tasks: TaskSet) -> Iterator[dict]:
    """Every domain: exploration once, learning under each schedule."""
    domains = domains_of(tasks)
    for form, ends in ((WHOLE, ""), *WITHIN):
        pairs = None if form == WHOLE else domains[form].pairs & ~domains[form].without_successor
        walk = explored(tasks, pairs, ends, settings["explored"])
        for epsilon in settings["schedules"]:
            numbers = learnt(tasks, pairs, ends, settings, epsilon)
            yield {"form": form, "dead_ends": ends, "schedule": epsilon, **walk, **numbers}


def check(settings: Mapping) -> None:
    for group in (minimised_worlds.EVERY_START, minimised_worlds.WITH_SINKS):
        if not set(group) & set(settings["kinds"]):
            raise InputError(f"kinds must hold one of {', '.join(group)}, got {', '.join(settings['kinds'])}")
    if settings["size"] % 2 == 0 or settings["size"] < 7:
        raise InputError(f"size must be odd and at least 7, got {settings['size']}")
    if settings["random_states"] < settings["tasks"] + 4:
        raise InputError(f"random_states must be at least tasks + 4, got {settings['random_states']}")
