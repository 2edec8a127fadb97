"""Plans in a perceived scene: the steps with how sure they are, or the reason why there is no plan."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from math import prod
from typing import Protocol

from lifelore.core.errors import LifeloreError
from lifelore.core.labelled_cloud import TABLE
from lifelore.core.relations import ON
from lifelore.perception.reasoning.fact import Fact, objects_without_support
from lifelore.perception.reasoning.goal_obstacles import goal_obstacles
from lifelore.perception.reasoning.planning_domain import planning_domain, predicates
from lifelore.perception.reasoning.planning_goal import Statement, names_of, pddl_goal
from lifelore.perception.reasoning.planning_problem import state_problem
from lifelore.perception.reasoning.planning_state import CLEAR, HIDDEN, PLAN_CONFIDENCE, PlanningState, scene_state
from lifelore.perception.scene import Scene, object_name


class PlannerStep(Protocol):
    """A step of a planner: an action of the domain and names of objects."""

    @property
    def action(self) -> str: ...

    @property
    def arguments(self) -> Sequence[str]: ...


Solver = Callable[[str, str], Sequence[PlannerStep] | None]
"""Maps a domain and a problem in PDDL to a plan; None where there is none."""


@dataclass(frozen=True)
class PlannedStep:
    """A step of a plan.

    Parameters
    ----------
    action : str
        ``pick-up``, ``put-on``, ``put-on-table`` or ``put-beside``.
    objects : tuple of int
        The object that is moved, then the one it is put on or beside.
    confidence : float
        Probability that what the step relies on is true, see `ScenePlan`.
    look : tuple of int
        Those of the objects whose top was hidden until an earlier step: look whether anything rests on them.
    """

    action: str
    objects: tuple[int, ...]
    confidence: float
    look: tuple[int, ...] = ()


@dataclass(frozen=True)
class ScenePlan:
    """A plan for a goal in a scene.

    A step relies on perceived facts, as far as no earlier step made them true: that nothing unknown rests on the
    object that is picked up or put upon, that an object beside which another is put rests on the table, and that
    an object that was cut automatically is one object. Its confidence is the product of their probabilities,
    which count as independent. What may rest on a hidden top is not part of it.

    Parameters
    ----------
    steps : tuple of PlannedStep
        Empty also where the goal holds already; then there is no `reason`.
    confidence : float
        The product over everything that any step relies on; 1 without a step.
    reason : str, optional
        Why there is no plan; None where there is one.
    """

    steps: tuple[PlannedStep, ...] = ()
    confidence: float = 1.0
    reason: str | None = None


def scene_plan(
    scene: Scene,
    goal: Sequence[Statement],
    solve: Solver,
    least: float = PLAN_CONFIDENCE,
    cut_confidence: Mapping[int, float] | None = None,
) -> ScenePlan:
    """The plan that `solve` finds for a goal in a scene.

    Parameters
    ----------
    scene : Scene
    goal : sequence of Statement
        See `read_goal`.
    solve : Solver
        Such as `lifelore.bridges.planner.solve`.
    least : float
        Least probability of the facts that the planner may use, in [0, 1].
    cut_confidence : mapping of int to float, optional
        How surely each object was cut; objects that are left out are sure.

    Raises
    ------
    InputError
        The goal names a predicate or an object that does not exist; the threshold is outside [0, 1].
    """
    if scene.cloud.has_table and (hanging := objects_without_support(scene.relations, scene.objects)):
        return ScenePlan(reason=f"nothing tells what {', '.join(map(object_name, hanging))} rests on")
    state = scene_state(scene, least)
    if reason := no_plan_reason(scene, state, goal):
        return ScenePlan(reason=reason)
    try:
        found = solve(planning_domain(scene.words), state_problem(scene, state, goal))
    except LifeloreError as error:
        if type(error) is not LifeloreError:
            raise
        return ScenePlan(reason=str(error))  # out of time or memory
    if found is None:
        return ScenePlan(reason=_unreachable(state))
    numbers = names_of(scene.objects)
    actions = [(step.action, tuple(numbers[name] for name in step.arguments)) for step in found]
    return _judged(actions, state, cut_confidence or {})


def no_plan_reason(scene: Scene, state: PlanningState, goal: Sequence[Statement]) -> str | None:
    """Why the state alone forbids every plan, see `goal_obstacles`; None where it does not.

    Raises
    ------
    InputError
        The goal names a predicate or an object that does not exist.
    """
    pddl_goal(goal, scene.objects, predicates(scene.words))
    return "; ".join(goal_obstacles(state, goal)) or None


def _unreachable(state: PlanningState) -> str:
    doubts = ", ".join(f"{one.fact} ({one.probability:.2f}, {one.reason})" for one in state.unknown)
    unknown = f"; unknown facts, which are not used: {doubts}" if doubts else ""
    return f"no order of picking up and putting down brings the goal about{unknown}"


def _judged(
    actions: Sequence[tuple[str, tuple[int, ...]]], state: PlanningState, cut: Mapping[int, float]
) -> ScenePlan:
    steps, moved = [], set()
    hidden = {below for (_, below), why in state.may_cover.items() if why == HIDDEN}
    relied: dict[Fact | int, float] = {}
    for action, objects in actions:
        facts = _facts(action, objects)
        look = tuple(fact.arguments[0] for fact in facts if fact.name == CLEAR and fact.arguments[0] in hidden)
        own: dict[Fact | int, float] = {thing: cut.get(thing, 1.0) for thing in objects}
        for fact in facts:
            if fact.arguments[0] not in moved:
                own[fact] = state.probability[fact]
        steps.append(PlannedStep(action, objects, prod(own.values()), look))
        hidden -= set(look)
        relied |= own
        moved.add(objects[0])
    return ScenePlan(tuple(steps), prod(relied.values()))


def _facts(action: str, objects: tuple[int, ...]) -> tuple[Fact, ...]:
    """The perceived facts that an action needs."""
    if action == "pick-up":
        return (Fact(CLEAR, objects),)
    if action == "put-on":
        return (Fact(CLEAR, objects[1:]),)
    return (Fact(ON, (objects[1], TABLE)),) if action == "put-beside" else ()
