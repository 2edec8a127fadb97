"""C3.14: what a task set's minimised domain keeps and what it costs: exact values, traps, exploration, learning.

The domain is as printed: outcomes that lead out of it are renormalised; where none is left (η = 1/0) the action is
taken out, the kindest reading. In a state without kept actions, such as another task's goal, a learner stays for
nothing. Learners within see kept actions alone, in exploring, in ties and in the best, and the world's own
outcomes, which nothing renormalises. Kinds of worlds are the readings. Thesis: §3.2.3, Thm 3.2.6, Props.
3.2.7-3.2.8.
"""

from collections.abc import Iterable, Iterator, Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from lifelore.action.search import domain_reduction
from lifelore.action.search.domain_reduction import MinimisedDomain, tables_within, trap_states
from lifelore.core.learning.curve import Curve, new_curve
from lifelore.core.learning.learning_metrics import episodes_to_threshold
from lifelore.core.learning.q_learning import Schedule, learn, new_learner, uniform_rows
from lifelore.core.mdp import TERMINAL, Tables
from lifelore.core.metrics import Estimate, mean_estimate, ratio_estimate
from lifelore.core.streams import stream
from reproduction.chapter3.c3_14_minimised_domains.minimised_worlds import Solved, TaskSet, task_set
from reproduction.chapter3.learning.grid_tasks import WINDOW, drawn_starts
from reproduction.chapter3.learning.schedules import Epsilon, schedule_of
from reproduction.engine.estimates import share_of
from reproduction.engine.records import having

TRACE = 1e-12
EQUAL = 1e-9
"""Relative to the largest reward: values nearer than this are equal."""

Pairs = NDArray[np.bool_] | None
"""Actions to choose from, (n_states, n_actions); None: the whole domain."""


def values_within(tables: Tables, domain: MinimisedDomain, discount: float) -> NDArray[np.float64]:
    """Optimal action values of a task in the minimised domain, (n_states, n_actions); -inf where not kept.

    Outcomes outside it are left out and the others renormalised (η). A state without kept actions is worth the
    worst reward for ever: a policy that could choose to end there is no policy.
    """
    acting = np.flatnonzero(domain.pairs.any(axis=1))
    follow, reward = tables.next_state[acting], tables.reward[acting]
    mass = np.diff(tables.outcome_cum, prepend=0.0) * domain.states[follow]
    total = mass.sum(axis=2, keepdims=True)
    mass = np.divide(mass, total, out=np.zeros_like(mass), where=total > 0)
    kept = domain.pairs[acting] & (total[..., 0] > 0)
    some = kept.any(axis=1)
    lowest = min(0.0, float(tables.reward.min())) / (1 - discount)
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


def kept(task: Solved, domain: MinimisedDomain, discount: float) -> bool:
    """Whether the task's optimal return is obtained from every start, and its policy is still optimal."""
    q = values_within(task.tables, domain, discount)
    near = EQUAL * max(1.0, float(np.abs(task.tables.reward).max())) / (1 - discount)
    starts = task.tables.starts
    whole, within = task.q.max(axis=1), q.max(axis=1)
    acting = domain_reduction.reachable_states(task.tables, task.best) & task.best.any(axis=1)
    chosen = acting[:, None] & task.best
    lost = np.where(chosen, within[:, None] - np.where(np.isfinite(q), q, -1e300), 0.0)
    return bool((np.abs(whole[starts] - within[starts]) <= near).all() and (lost <= near).all())


def traps(task: Solved, domain: MinimisedDomain) -> list[int]:
    """Numbers of trap states and dead ends of a task: in the domain, and in the minimised domain."""
    usable = domain.pairs & ~domain.without_successor
    within = trap_states(task.tables, usable) & domain.states
    return [int(trap_states(task.tables).sum()), int(within.sum())]


def learn_within(task: Solved, pairs: Pairs, schedule: Schedule, purpose: str) -> Curve:
    """Learn a task in its domain, or with `pairs` alone to choose from; `purpose` names the streams."""
    tables = task.tables
    allowed = np.ones((tables.n_states, tables.n_actions), bool)
    if pairs is not None:
        tables = tables_within(tables, pairs, "stay")
        allowed = pairs | ~pairs.any(axis=1, keepdims=True)
    rows = uniform_rows(tables, allowed / allowed.sum(axis=1, keepdims=True), np.where(allowed, 1.0, TRACE))
    world, own = (stream(*task.stream, purpose, of) for of in ("world", "own"))
    learner = new_learner(tables.n_states, tables.n_actions, world, own)
    learner.q[~allowed] = -np.inf
    curve = new_curve(schedule.epsilon.size)
    learn(tables, rows, schedule, learner, curve, schedule.epsilon.size * schedule.max_steps)
    return curve


def best_returns(task: Solved, n_episodes: int) -> NDArray[np.float64]:
    """The optimal return from where each episode starts; worlds of one outcome draw nothing but starts."""
    if task.tables.n_outcomes > 1:
        return np.full(n_episodes, task.q[task.tables.starts].max(axis=1).mean())
    return task.q[drawn_starts(task.tables, (*task.stream, "learn"), n_episodes)].max(axis=1)


def explored(tasks: TaskSet, pairs: Pairs, episodes: int) -> float:
    """Collisions a step of pure exploration, learning nothing."""
    flat = Schedule(np.ones(episodes), np.zeros(episodes), tasks.max_steps, tasks.discount)
    curves = [learn_within(task, pairs, flat, "explore") for task in tasks.tasks]
    return float(sum(c.collisions.sum() for c in curves) / sum(c.steps.sum() for c in curves))


def episodes_to_80(settings: Mapping, tasks: TaskSet, pairs: Pairs, epsilon: Epsilon) -> int:
    """Episodes until some tasks of the set, learnt, return on average 80 % of the optimum; at most all.

    Where the optimum is below zero, as much below it as a fifth of it.
    """
    schedule = schedule_of({**settings, "discount": tasks.discount, "max_steps": tasks.max_steps}, epsilon)
    chosen, episodes = tasks.tasks[: settings["learnt_tasks"]], settings["episodes"]
    returns = np.mean([learn_within(task, pairs, schedule, "learn").returns for task in chosen], axis=0)
    best = np.mean([best_returns(task, episodes) for task in chosen], axis=0)
    reached = episodes_to_threshold(returns - best + 0.2 * np.abs(best), 0.0, min(WINDOW, episodes))
    return episodes if reached is None else reached


def cells(settings: Mapping) -> list[dict]:
    """Every kind of world, run by run."""
    return [{"kind": kind, "run": run} for run in range(settings["runs"]) for kind in settings["kinds"]]


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """One set of tasks: what its minimised domain keeps, how exploring and learning in it goes.

    For random worlds also `worlds` further sets, exactly alone. Pairs of numbers are of the domain, and within.
    """
    names = (seed, "C3.14", cell["kind"], cell["run"])
    more = settings["worlds"] if cell["kind"].endswith("few starts") else 0
    sets = [task_set(cell["kind"], settings, own) for own in (names, *((*names, "exact", i) for i in range(more)))]
    domain = domain_of(sets[0])
    ways = (None, domain.pairs & ~domain.without_successor)
    return {
        **cell,
        "exact": [exact(tasks) for tasks in sets],
        "collisions": [explored(sets[0], pairs, settings["explored"]) for pairs in ways],
        "to_80": [[episodes_to_80(settings, sets[0], pairs, e) for pairs in ways] for e in settings["schedule"]],
    }


def domain_of(tasks: TaskSet) -> MinimisedDomain:
    """The set's minimised domain as printed (Def. 3.2.5)."""
    return domain_reduction.minimised_domain(
        [task.tables for task in tasks.tasks], [task.best for task in tasks.tasks], "printed"
    )


def exact(tasks: TaskSet) -> dict:
    """What every task of a set keeps, its traps, and whether the domain is defined."""
    domain = domain_of(tasks)
    return {
        "kept": [kept(task, domain, tasks.discount) for task in tasks.tasks],
        "traps": [traps(task, domain) for task in tasks.tasks],
        "defined": not domain.without_successor.any(),
    }


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """What is kept and traps over all sets; the costs within over those in the domain, in the worst kind."""
    each = [_costs(having(results, kind=kind), 0) for kind in settings["kinds"]]
    return _kept(results) | {name: worst(costs[name] for costs in each) for name in each[0]}


def _kept(results: Sequence[Mapping]) -> dict[str, Estimate]:
    """Shares of tasks and sets; the change in traps where the domain has some, and new traps where it has none."""
    sets = [found for result in results for found in result["exact"]]
    of_sets = [np.array(found["traps"]) for found in sets]
    some = [of_set[of_set[:, 0] > 0] for of_set in of_sets]
    found = {
        "theorem": share_of([kept for found in sets for kept in found["kept"]]),
        "defined": share_of([found["defined"] for found in sets]),
    }
    if changes := [float((of_set[:, 1] - of_set[:, 0]).mean()) for of_set in some if len(of_set)]:
        found["trap_difference"] = mean_estimate(changes)
    if new := [bool(within) for of_set in of_sets for whole, within in of_set if not whole]:
        found["new_traps"] = share_of(new)
    return found


def _costs(results: Sequence[Mapping], schedule: int) -> dict[str, Estimate]:
    """Costs within the minimised domain over those in the domain, paired by run."""
    pairs = {
        "collisions_ratio": [result["collisions"] for result in results],
        "to_80_ratio": [result["to_80"][schedule] for result in results],
    }
    return {name: ratio_estimate(*np.array(values, float).T[::-1]) for name, values in pairs.items()}


def worst(ratios: Iterable[Estimate]) -> Estimate:
    """The ratio whose interval reaches highest."""
    return max(ratios, key=lambda r: r.ci95[1] if r.ci95 else r.value)


def readings(settings: Mapping, results: Sequence[Mapping]) -> Iterator[tuple[dict, dict[str, Estimate]]]:
    """Kind by kind; learning also by schedule."""
    for kind in settings["kinds"]:
        own = having(results, kind=kind)
        for place, schedule in enumerate(settings["schedule"]):
            costs = _costs(own, place)
            found = _kept(own) | costs if place == 0 else {"to_80_ratio": costs["to_80_ratio"]}
            yield {"kind": kind, "schedule": schedule}, found
