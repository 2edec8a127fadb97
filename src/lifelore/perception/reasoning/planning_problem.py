"""A scene as a planning problem: PDDL with the perceived relations as ``:init``.

*both* gives ``on`` and ``adjacent``. PDDL has no word for unknown: what is not stated is false. So an unknown fact
(see `planning_state`) is left out and listed in a comment at the top, and ``may-cover`` names what a plan must
take away before an object counts as clear.

Thesis: §2.2 and §2.5: the relations are the language of planning problems.
"""

from collections.abc import Iterable, Mapping, Sequence

from lifelore.core.errors import InputError
from lifelore.core.labelled_cloud import TABLE
from lifelore.core.relations import ADJACENT
from lifelore.perception.reasoning.fact import Fact, objects_without_support
from lifelore.perception.reasoning.planning_domain import (
    DOMAIN_NAME,
    RESERVED,
    predicate_names,
    predicates,
    unique_names,
)
from lifelore.perception.reasoning.planning_goal import Statement, pddl_goal
from lifelore.perception.reasoning.planning_state import PlanningState, planning_state, scene_state
from lifelore.perception.relations.relation import Relation
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
    if scene.cloud.has_table:
        _check_support(scene.relations, scene.objects)
    called = pddl_names(scene.objects, words=scene.words)
    wanted = pddl_goal(goal, called, predicates(scene.words)) if goal else NOTHING
    return problem_text(state, called, wanted, scene.words)


def planning_problem(
    relations: Iterable[Relation],
    objects: Iterable[int] = (),
    *,
    goal: str = NOTHING,
    names: Mapping[int, str] | None = None,
) -> str:
    """A PDDL problem whose ``:init`` is the scene that relations describe.

    Parameters
    ----------
    relations : iterable of Relation
        Consistent ones (see `scene_logic`); *none* is left out. Words outside the core vocabulary count as not
        symmetric, and need the domain of `planning_domain` with these words.
    objects : iterable of int
        Objects beside those the relations name.
    goal : str
        A PDDL goal over `DOMAIN` in the objects' names, such as ``(and (clear o2) (on o3 o4))``.
    names : mapping from int to str, optional
        What to call the objects, made valid and unique by `pddl_names`; default ``o2``, ``o3``, ….

    Raises
    ------
    InputError
        No relation says what an object rests on, or `names` names an object that does not exist.

    Examples
    --------
    >>> print(planning_problem([Relation(2, 1, "on", 0.9, 0.0)], goal="(holding o2)"))
    (define (problem scene)
      (:domain tabletop)
      (:objects o2 - thing)
      (:init
        (hand-empty)
        (clear o2)
        (on-table o2))
      (:goal (holding o2)))
    <BLANKLINE>
    """
    relations = tuple(relations)
    state = planning_state(relations, objects)
    _check_support(relations, state.objects)
    words = Words.outside_core((r.relation for r in relations), ())
    return problem_text(state, pddl_names(state.objects, names, words), goal, words)


def problem_text(state: PlanningState, called: Mapping[int, str], goal: str, words: Words = NO_WORDS) -> str:
    """The problem of a state; `called` names the objects, `goal` is PDDL."""
    of_word = predicate_names(words)
    unknown = [
        f";   {_atoms(one.fact, called, of_word, words)[0]} {one.reason}, probability {one.probability:.2f}"
        for one in state.unknown
    ]
    declared = f" {' '.join(called[thing] for thing in state.objects)} - thing" if state.objects else ""
    atoms = {atom for fact in state.stated for atom in _atoms(fact, called, of_word, words)}
    atoms |= {f"(may-cover {called[a]} {called[b]})" for a, b in state.may_cover}
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


def pddl_names(
    things: Sequence[int], names: Mapping[int, str] | None = None, words: Words = NO_WORDS
) -> dict[int, str]:
    """A valid PDDL name for each object, no two alike whatever the case.

    Letters, digits, ``-`` and ``_`` stay, others become ``_``; a name must begin with a letter, and words of the
    language and of the domain are given the object's number.

    Raises
    ------
    InputError
        `names` names an object that does not exist.
    """
    wanted = dict(names or {})
    if strangers := sorted(set(wanted) - set(things)):
        raise InputError(f"names must be of the scene's objects {list(things)}, got {strangers}")
    reserved = RESERVED | set(predicates(words))
    return unique_names({thing: (wanted.get(thing, f"o{thing}"), str(thing)) for thing in things}, reserved, "o")


def _check_support(relations: Sequence[Relation], things: Iterable[int]) -> None:
    if hanging := objects_without_support(relations, things):
        raise InputError(
            "relations of a planning problem must say on what every object rests, by on or both; of"
            f" {', '.join(map(str, hanging))} nothing says so; `scene_logic.most_likely_scene` completes them"
        )


def _atoms(fact: Fact, called: Mapping[int, str], of_word: Mapping[str, str], words: Words) -> list[str]:
    """The atoms of a fact; symmetric relations in both directions."""
    name = of_word.get(fact.name, fact.name)
    if len(fact.arguments) == 1:
        return [f"({name} {called[fact.arguments[0]]})"]
    a, b = fact.arguments
    if TABLE in (a, b):
        return [f"({name}-table {called[a]})" if b == TABLE else f"(table-{name} {called[b]})"]
    both_ways = fact.name == ADJACENT or fact.name in words.symmetric
    return [f"({name} {called[x]} {called[y]})" for x, y in ((a, b), (b, a))[: 1 + both_ways]]
