"""A scene as a planning problem: PDDL with the perceived relations as ``:init``.

*both* gives ``on`` and ``adjacent``. PDDL has no word for unknown: what is not stated is false. So an unknown fact
(see `planning_state`) is left out and listed in a comment at the top, and ``may-cover`` names what a plan must
take away before an object counts as clear.

Thesis: §2.2 and §2.5: the relations are the language of planning problems.
"""

from collections.abc import Mapping, Sequence

from lifelore.core.errors import InputError
from lifelore.core.labelled_cloud import TABLE
from lifelore.core.relations import ADJACENT
from lifelore.perception.reasoning.fact import Fact, objects_without_support
from lifelore.perception.reasoning.planning_domain import (
    DOMAIN_NAME,
    predicate_names,
    predicates,
)
from lifelore.perception.reasoning.planning_goal import Statement, pddl_goal, pddl_name
from lifelore.perception.reasoning.planning_state import PlanningState, scene_state
from lifelore.perception.relations.words import NO_WORDS, Words
from lifelore.perception.scene import Scene

NOTHING = "(and )"
"""The goal that always holds."""


def scene_problem(scene: Scene, least: float, goal: Sequence[Statement] = ()) -> str:
    """The problem of a perceived scene: facts with a probability of at least `least`, hidden tops unknown.

    Raises
    ------
    InputError
        As for `state_problem`; the threshold is outside [0, 1].
    """
    return state_problem(scene, scene_state(scene, least), goal)


def state_problem(scene: Scene, state: PlanningState, goal: Sequence[Statement] = ()) -> str:
    """The problem of a perceived scene in a `state` of its own.

    Raises
    ------
    InputError
        No relation says what an object rests on, although there is a table; the goal names a predicate or an
        object that does not exist.
    """
    if scene.cloud.has_table and (hanging := objects_without_support(scene.relations, scene.objects)):
        raise InputError(
            "relations of a planning problem must say on what every object rests, by on or both; of"
            f" {', '.join(map(str, hanging))} nothing says so; `scene_logic.most_likely_scene` completes them"
        )
    wanted = pddl_goal(goal, scene.objects, predicates(scene.words)) if goal else NOTHING
    return problem_text(state, wanted, scene.words)


def problem_text(state: PlanningState, goal: str, words: Words = NO_WORDS) -> str:
    """The problem of a state; `goal` is PDDL."""
    of_word = predicate_names(words)
    unknown = [
        f";   {_atoms(one.fact, of_word, words)[0]} {one.reason}, probability {one.probability:.2f}"
        for one in state.unknown
    ]
    declared = f" {' '.join(map(pddl_name, state.objects))} - thing" if state.objects else ""
    atoms = {atom for fact in state.stated for atom in _atoms(fact, of_word, words)}
    atoms |= {f"(may-cover {pddl_name(a)} {pddl_name(b)})" for a, b in state.may_cover}
    initial = [f"    {atom}" for atom in ("(hand-empty)", *sorted(atoms))]
    return "\n".join(
        [
            *(["; unknown, so not stated:", *unknown] if unknown else []),
            "(define (problem scene)",
            f"  (:domain {DOMAIN_NAME})",
            f"  (:objects{declared})",
            "  (:init",
            *initial[:-1],
            initial[-1] + ")",
            f"  (:goal {goal}))",
            "",
        ]
    )


def _atoms(fact: Fact, of_word: Mapping[str, str], words: Words) -> list[str]:
    """The atoms of a fact; symmetric relations in both directions."""
    name = of_word.get(fact.name, fact.name)
    if len(fact.arguments) == 1:
        return [f"({name} {pddl_name(fact.arguments[0])})"]
    a, b = fact.arguments
    if TABLE in (a, b):
        return [f"({name}-table {pddl_name(a)})" if b == TABLE else f"(table-{name} {pddl_name(b)})"]
    both_ways = fact.name == ADJACENT or fact.name in words.symmetric
    return [f"({name} {pddl_name(x)} {pddl_name(y)})" for x, y in ((a, b), (b, a))[: 1 + both_ways]]
