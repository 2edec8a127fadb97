"""A scene as a planning problem: PDDL with the perceived relations as ``:init``, and a domain to plan in.

The domain is the blocks world opened to what scenes show: an object may rest on several others, and several on
one; neighbours are ``adjacent``, and stop being so when one of them is taken away. *both* gives ``on`` and
``adjacent``. Picking up needs a clear object and an empty hand. What one cannot see is not modelled: whether a top
is flat enough to put something on, whether a pile stays up, or whether the hand can get there.

Thesis: §2.2 and §2.5: the relations are the language of planning problems.
"""

import re
from collections.abc import Iterable, Mapping, Sequence

from lifelore.core.errors import InputError
from lifelore.core.labelled_cloud import TABLE
from lifelore.core.relations import ADJACENT, BOTH, CORE_RELATIONS, ON
from lifelore.perception.reasoning.fact import objects_without_support, words_outside_core
from lifelore.perception.relations.relation import Relation

DOMAIN_NAME = "tabletop"

DOMAIN = """(define (domain tabletop)
  (:requirements :strips :typing :equality :negative-preconditions :disjunctive-preconditions
                 :universal-preconditions :conditional-effects)
  (:types thing)
  (:predicates
    (on ?a ?b - thing)
    (on-table ?a - thing)
    (clear ?a - thing)
    (holding ?a - thing)
    (adjacent ?a ?b - thing)
    (hand-empty))
  (:action pick-up
    :parameters (?a - thing)
    :precondition (and (clear ?a) (hand-empty))
    :effect (and
      (holding ?a) (not (hand-empty)) (not (clear ?a)) (not (on-table ?a))
      (forall (?b - thing) (and
        (when (on ?a ?b) (not (on ?a ?b)))
        (when (and (on ?a ?b) (forall (?c - thing) (or (= ?c ?a) (not (on ?c ?b))))) (clear ?b))
        (when (adjacent ?a ?b) (not (adjacent ?a ?b)))
        (when (adjacent ?b ?a) (not (adjacent ?b ?a)))))))
  (:action put-on
    :parameters (?a ?b - thing)
    :precondition (and (holding ?a) (clear ?b) (not (= ?a ?b)))
    :effect (and (on ?a ?b) (not (clear ?b)) (clear ?a) (not (holding ?a)) (hand-empty)))
  (:action put-on-table
    :parameters (?a - thing)
    :precondition (holding ?a)
    :effect (and (on-table ?a) (clear ?a) (not (holding ?a)) (hand-empty)))
  (:action put-beside
    :parameters (?a ?b - thing)
    :precondition (and (holding ?a) (on-table ?b) (not (= ?a ?b)))
    :effect (and (on-table ?a) (adjacent ?a ?b) (adjacent ?b ?a)
                 (clear ?a) (not (holding ?a)) (hand-empty))))
"""

RESERVED = frozenset(re.findall(r"[a-z][a-z-]*", DOMAIN)) | {
    "exists",
    "imply",
    "either",
    "object",
    "problem",
    "goal",
}
"""Words of the language and of `DOMAIN`, which no object may be called."""


def planning_problem(
    relations: Iterable[Relation],
    objects: Iterable[int] = (),
    *,
    goal: str = "(and )",
    names: Mapping[int, str] | None = None,
) -> str:
    """A PDDL problem whose ``:init`` is the scene.

    Parameters
    ----------
    relations : iterable of Relation
        Consistent ones (see `scene_logic`), in the core vocabulary; *none* is left out.
    objects : iterable of int
        Objects beside those the relations name.
    goal : str
        A PDDL goal over `DOMAIN` in the objects' names, such as ``(and (clear o2) (on o3 o4))``.
    names : mapping from int to str, optional
        What to call the objects, made valid and unique by `pddl_names`; default ``o2``, ``o3``, ….

    Raises
    ------
    InputError
        A relation is not of the core vocabulary, nothing says what an object rests on, or `names` names an object
        that is not there: what an unknown word says of resting cannot be planned with.

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
    things = sorted({*objects, *(label for r in relations for label in (r.a, r.b))} - {TABLE})
    _check(relations, things)
    called = pddl_names(things, names)
    declared = f" {' '.join(called[thing] for thing in things)} - thing" if things else ""
    lines = ["(define (problem scene)", f"  (:domain {DOMAIN_NAME})", f"  (:objects{declared})", "  (:init"]
    lines += [f"    {atom}" for atom in _initial(relations, things, called)]
    return "\n".join([*lines[:-1], lines[-1] + ")", f"  (:goal {goal}))", ""])


def pddl_names(things: Sequence[int], names: Mapping[int, str] | None = None) -> dict[int, str]:
    """A valid PDDL name for each object, no two alike whatever the case.

    Letters, digits, ``-`` and ``_`` are kept, others become ``_``; a name must begin with a letter, and words of
    the language and of `DOMAIN` are given the object's number.

    Raises
    ------
    InputError
        `names` names an object that is not there.
    """
    wanted = dict(names or {})
    if strangers := sorted(set(wanted) - set(things)):
        raise InputError(f"names must be of the scene's objects {list(things)}, got {strangers}")
    taken: set[str] = set()
    called = {}
    for thing in things:
        name = re.sub(r"[^a-z0-9_-]", "_", wanted.get(thing, f"o{thing}").lower())
        name = name if name[:1].isalpha() else f"o{name}"
        while name in taken or name in RESERVED:
            name = f"{name}_{thing}"
        taken.add(name)
        called[thing] = name
    return called


def _check(relations: Sequence[Relation], things: Sequence[int]) -> None:
    if strange := words_outside_core(relations):
        raise InputError(
            f"relations of a planning problem must be {', '.join(CORE_RELATIONS)}, got {', '.join(strange)};"
            " perceive with a model of those words, such as the one shipped"
        )
    if hanging := objects_without_support(relations, things):
        raise InputError(
            "relations of a planning problem must say on what every object rests, by on or both; of"
            f" {', '.join(map(str, hanging))} nothing says so; `scene_logic.most_likely_scene` completes them"
        )


def _initial(relations: Sequence[Relation], things: Sequence[int], called: Mapping[int, str]) -> list[str]:
    """The atoms of ``:init``, sorted; symmetric relations in both directions."""
    carried, atoms = set(), set()
    for r in relations:
        if r.relation in (ON, BOTH):
            carried.add(r.b)
            atoms.add(f"(on-table {called[r.a]})" if r.b == TABLE else f"(on {called[r.a]} {called[r.b]})")
        if r.relation in (ADJACENT, BOTH) and TABLE not in (r.a, r.b):
            atoms |= {f"(adjacent {called[a]} {called[b]})" for a, b in ((r.a, r.b), (r.b, r.a))}
    atoms |= {f"(clear {called[thing]})" for thing in things if thing not in carried}
    return ["(hand-empty)", *sorted(atoms)]
