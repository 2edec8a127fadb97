"""The domain to plan in: PDDL of a blocks world opened to what scenes show, with a user's words as predicates.

An object may rest on several others, and several on one; neighbours are ``adjacent``, and stop being so when one
of them is taken away. Picking up needs a clear object and an empty hand. ``may-cover ?a ?b`` says that a may rest
on b, or hides a part of its top: b is not clear before a has been taken away. The domain does not model whether a
top is flat enough to put something on, whether a pile stays up, or whether the hand can get there.

A user's word is the predicate ``WORD ?a ?b``, and ``WORD-table ?a`` or ``table-WORD ?a`` with the table. It
describes the scene as seen: taking an object away ends the words that hold of it, and no action makes a word hold.

Thesis: §2.2 and §2.5: the relations are the language of planning problems.
"""

import re

from lifelore.perception.relations.words import NO_WORDS, Words

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
    (may-cover ?a ?b - thing)
    (hand-empty))
  (:action pick-up
    :parameters (?a - thing)
    :precondition (and (clear ?a) (hand-empty))
    :effect (and
      (holding ?a) (not (hand-empty)) (not (clear ?a)) (not (on-table ?a))
      (forall (?b - thing) (and
        (when (on ?a ?b) (not (on ?a ?b)))
        (when (may-cover ?a ?b) (not (may-cover ?a ?b)))
        (when (and (or (on ?a ?b) (may-cover ?a ?b))
                   (forall (?c - thing) (or (= ?c ?a) (and (not (on ?c ?b)) (not (may-cover ?c ?b))))))
              (clear ?b))
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
"""Words of the language and of `DOMAIN`, which no object and no other predicate may be called."""


def planning_domain(words: Words = NO_WORDS) -> str:
    """`DOMAIN` with a predicate for each of a user's words.

    Examples
    --------
    >>> "(next_to ?a ?b - thing)" in planning_domain(Words(("next to",)))
    True
    """
    declared, ended, parted = "", "", ""
    for name in predicate_names(words).values():
        for predicate in (f"({name} ?a ?b", f"({name}-table ?a", f"(table-{name} ?a"):
            declared += f"    {predicate} - thing)\n"
        ended += f"(not ({name}-table ?a)) (not (table-{name} ?a))\n      "
        for pair in ("?a ?b", "?b ?a"):
            parted += f"(when ({name} {pair}) (not ({name} {pair})))\n        "
    text = DOMAIN.replace("    (hand-empty))", f"{declared}    (hand-empty))", 1)
    every = "(forall (?b - thing) (and\n        "
    return text.replace(every, ended + every + parted, 1)


def predicate_names(words: Words) -> dict[str, str]:
    """A valid PDDL name for each word, by word, no two alike, none of `RESERVED` and none of an object (``o2``).

    Letters, digits, ``-`` and ``_`` stay, others become ``_``; a name must begin with a letter.
    """
    found: dict[str, str] = {}
    for number, word in enumerate(words.names):
        name = re.sub(r"[^a-z0-9_-]", "_", word.lower())
        name = name if name[:1].isalpha() and not re.fullmatch(r"o\d+", name) else f"w{name}"
        while name in RESERVED or name in found.values():
            name = f"{name}_{number}"
        found[word] = name
    return found


def predicates(words: Words = NO_WORDS) -> dict[str, int]:
    """The predicates of the domain and their numbers of objects."""
    own = predicate_names(words).values()
    core = {"on": 2, "adjacent": 2, "on-table": 1, "clear": 1, "holding": 1, "hand-empty": 0}
    return core | {key: n for name in own for key, n in ((name, 2), (f"{name}-table", 1), (f"table-{name}", 1))}
