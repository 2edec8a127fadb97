"""Checks of a family of tasks, as Gymnasium's checker does for environments: mistakes are named in one line.

`check_family` plays some tasks. `live_long` checks the constants once, and every task, plan and step as it lives.
"""

import math
from numbers import Real
from typing import Any

import numpy as np

from lifelore.agent.long_lived.knowledge import MOST_CONTEXTS
from lifelore.agent.long_lived.task_family import AGENTS, AgentTask, Plan, SharedKnowledge, Step, TaskFamily
from lifelore.core.errors import InputError
from lifelore.domains.task_stream import DrawnTask

MOST_ACTS = 1000
"""Acts after which an episode counts as endless."""
ROW_SUM = 1e-9
"""Largest distance from 1 of the sum of a row of `TaskFamily.possible`."""
WHOLE = (int, np.integer)
ARRAYS = {"groups": np.integer, "kinds": np.integer, "judges": np.bool_, "constancy": np.number}
"""Attributes with a value for each cause, and the kind of number that they hold."""


def check_family(family: TaskFamily, tasks: int = 3, episodes: int = 2, seed: int = 0) -> None:
    """Play some tasks of a family by acts that its plans propose, and name the first mistake.

    Parameters
    ----------
    family : TaskFamily
    tasks, episodes : int
        Tasks to play, from number 0, and episodes of each.
    seed : int
        Draws the laws that plans are asked for, and the behaviours that are followed.

    Raises
    ------
    InputError
        The family breaks a rule, such as: rows of ``possible`` sum to 1; causes, effects and acts lie in their
        ranges; rewards are finite; a plan has a value for each type and behaviour; an episode ends within 1000
        acts; the same number is the same task.

    Examples
    --------
    >>> from lifelore.agent.long_lived.families.by_name import family_named
    >>> check_family(family_named("factory-customers", seed=0), tasks=1)
    """
    check_constants(family)
    generator = np.random.default_rng(seed)
    for number in range(tasks):
        drawn, task = checked_meeting(family, number, family.meet(number, AGENTS["full"]))
        again, _ = family.meet(number, AGENTS["full"])
        _rule(family, drawn == again, f"task {number} must be the same task each time, got {drawn} and {again}")
        checked_best_return(family, number, family.best_return(number))
        for episode in range(episodes):
            _play(family, task, f"episode {episode} of task {number}", generator)


def _play(family: TaskFamily, task: AgentTask, name: str, generator: np.random.Generator) -> None:
    """An episode under two drawn laws and an unknown type."""
    drawn = generator.standard_gamma(np.repeat(family.possible[None], 2, axis=0)) + 1e-9
    laws = np.concatenate([drawn / drawn.sum(axis=2, keepdims=True), family.possible[None]])
    shared, tried = SharedKnowledge.empty(family), np.zeros(family.n_causes, np.bool_)
    task.begin()
    for _ in range(MOST_ACTS):
        scene = task.describe()
        _rule(family, isinstance(scene, str), f"describe must return a text, got {scene!r}")
        plan = checked_plan(family, task.plan(laws.copy(), tried.copy(), len(laws) - 1, shared), len(laws))
        act = int(generator.choice(np.concatenate([plan.acts, plan.trying])))
        step = checked_step(family, act, task.act(act))
        tried[[cause for cause, _ in step.effects]] = True
        if step.ended:
            break
    else:
        _rule(family, False, f"{name} must end, got {MOST_ACTS} acts without an end; let the last Step have ended")
    contexts, best = task.best_acts(laws[0], shared)
    _check_shape(family, "best_acts", best, (len(contexts), len(family.acts)), "contexts × acts")


def check_constants(family: TaskFamily) -> None:
    """Refuse a family whose attributes break a rule.

    Raises
    ------
    InputError
        The message names the attribute and what it should be.
    """
    if not isinstance(family, TaskFamily):
        raise InputError(f"family must derive from TaskFamily, got {type(family).__name__}")
    for name in ("name", "acts", "n_causes", "n_effects"):
        if not hasattr(family, name):
            raise InputError(f"family {type(family).__name__} must have an attribute {name}; see TaskFamily")
    named = isinstance(family.name, str) and family.name.strip() and "/" not in family.name
    _rule(family, named, f"name must be a text without '/', got {family.name!r}")
    acts = isinstance(family.acts, tuple) and family.acts and all(isinstance(act, str) for act in family.acts)
    _rule(family, acts, f"acts must be a tuple of names, at least one, got {family.acts!r}")
    for name in ("n_causes", "n_effects"):
        n = getattr(family, name)
        _rule(family, isinstance(n, WHOLE) and n >= 1, f"{name} must be a whole number from 1, got {n!r}")
    for name, kind in ARRAYS.items():
        array, shape = getattr(family, name), (family.n_causes,)
        _check_shape(family, name, array, shape, "a value a cause")
        held = np.issubdtype(array.dtype, kind)
        _rule(family, held, f"{name} must hold {kind.__name__} values, got {array.dtype}")
    _rule(family, np.min(family.groups) >= 0, f"groups must be numbers from 0, got {np.min(family.groups)}")
    constant = np.isfinite(family.constancy).all() and np.min(family.constancy) > 0
    _rule(family, constant, f"constancy must be finite and above 0, got {np.min(family.constancy)}")
    _check_possible(family)


def _check_possible(family: TaskFamily) -> None:
    possible, shape = family.possible, (family.n_causes, family.n_effects)
    _check_shape(family, "possible", possible, shape, "causes × effects")
    sums = np.where((possible >= 0).all(axis=1), possible.sum(axis=1), np.nan)
    wrong = np.flatnonzero(~(np.abs(sums - 1) <= ROW_SUM))
    if wrong.size:
        row = possible[wrong[0]].tolist()
        _rule(family, False, f"rows of possible must be probabilities with sum 1, got {row} for cause {wrong[0]}")
    _check_shape(family, "smoothed counts", family.smoothed(possible[None]), (1, *shape), "that of the counts")


def checked_meeting(family: TaskFamily, number: int, met: Any) -> tuple[DrawnTask, AgentTask]:
    """What `TaskFamily.meet` has returned, if it follows the rules."""
    pair = isinstance(met, tuple) and len(met) == 2 and isinstance(met[0], DrawnTask)
    _rule(family, pair, f"meet must return (DrawnTask, task), got {met!r}")
    drawn, task = met
    _rule(family, drawn.number == number, f"meet must return task {number}, got task {drawn.number}")
    known = isinstance(drawn.context, WHOLE) and 0 <= drawn.context < MOST_CONTEXTS
    _rule(family, known, f"a context must lie in 0..{MOST_CONTEXTS - 1}, got {drawn.context!r} in task {number}")
    return drawn, task


def checked_best_return(family: TaskFamily, number: int, best: Any) -> float:
    """What `TaskFamily.best_return` has returned, if it is finite."""
    _rule(family, _finite(best), f"best_return must be a finite number, got {best!r} for task {number}")
    return float(best)


def checked_plan(family: TaskFamily, plan: Any, n_types: int) -> Plan:
    """A plan with a value for each type and behaviour, and an act for each behaviour."""
    _rule(family, isinstance(plan, Plan), f"plan must return a Plan, got {type(plan).__name__}")
    _check_shape(family, "values of a plan", np.asarray(plan.values), (n_types, n_types), "types × behaviours")
    _rule(family, np.isfinite(plan.values).all(), "values of a plan must be finite, got infinite or missing ones")
    for name in ("acts", "trying"):
        acts = np.asarray(getattr(plan, name))
        _check_shape(family, f"{name} of a plan", acts, (n_types,), "an act a behaviour")
        known = np.issubdtype(acts.dtype, np.integer) and acts.min() >= 0 and acts.max() < len(family.acts)
        _rule(family, known, f"{name} of a plan must lie in 0..{len(family.acts) - 1}, got {acts.tolist()}")
    return plan


def checked_step(family: TaskFamily, act: int, step: Any) -> Step:
    """A step with a finite reward and with effects that the family has."""
    name = family.acts[act]
    _rule(family, isinstance(step, Step), f"act must return a Step, got {type(step).__name__} for {name!r}")
    _rule(family, _finite(step.reward), f"a reward must be a finite number, got {step.reward!r} for act {name!r}")
    for effect in step.effects:
        _rule(family, len(effect) == 2, f"effects must be pairs (cause, effect), got {effect!r} for act {name!r}")
        for what, n, got in zip(("cause", "effect"), (family.n_causes, family.n_effects), effect, strict=True):
            known = isinstance(got, WHOLE) and 0 <= got < n
            _rule(family, known, f"{what} must lie in 0..{n - 1} (n_{what}s = {n}), got {got!r} for act {name!r}")
    return step


def _finite(value: Any) -> bool:
    return isinstance(value, Real) and math.isfinite(value)


def _check_shape(family: TaskFamily, what: str, array: Any, shape: tuple[int, ...], axes: str) -> None:
    right = isinstance(array, np.ndarray) and array.shape == shape
    _rule(family, right, f"{what} must be an array of shape {shape}, {axes}, got {np.shape(array)}")


def _rule(family: TaskFamily, holds: Any, rule: str) -> None:
    if not holds:
        raise InputError(f"family {family.name!r}: {rule}")
