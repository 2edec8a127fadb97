"""Goals for a planner as a person writes them: ``on(o2, o3) and not adjacent(o3, o4)``, turned into PDDL.

A goal is one statement or several joined by ``and``; ``not`` before a statement denies it. The table is ``table``.
"""

import re
from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass

from lifelore.core.errors import InputError

TABLE_WORD = "table"
STATEMENT = re.compile(r"\s*(not\s+)?([^\s(),]+)\s*\(([^()]*)\)\s*")
FORM = "write statements such as on(o2, o3), joined by `and`, each with `not` before it where it shall not hold"


@dataclass(frozen=True)
class Statement:
    """A predicate, the names of its objects, and whether it shall hold."""

    name: str
    arguments: tuple[str, ...]
    holds: bool


def read_goal(text: str) -> tuple[Statement, ...]:
    """The statements of a goal, lower case.

    Raises
    ------
    InputError
        The text is no goal; the message shows where.

    Examples
    --------
    >>> read_goal("not clear(o2)")
    (Statement(name='clear', arguments=('o2',), holds=False),)
    """
    text = " ".join(text.split())
    statements, at, lower = [], 0, text.lower()
    while True:
        match = STATEMENT.match(lower, at)
        if match is None:
            rest = text[at:].strip()[:80]
            raise InputError(f"goal must be statements, got '{rest}' in '{text[:80]}': {FORM}")
        denied, name, inside = match.groups()
        arguments = tuple(part.strip() for part in inside.split(",")) if inside.strip() else ()
        statements.append(Statement(name, arguments, denied is None))
        if (at := match.end()) == len(lower):
            return tuple(statements)
        if (joint := re.match(r"and\b", lower[at:])) is None:
            rest = text[at:].strip()[:80]
            raise InputError(f"goal must join statements by `and`, got '{rest}' in '{text[:80]}': {FORM}")
        at += joint.end()


def pddl_name(thing: int) -> str:
    """What an object is called in goals and in PDDL: ``o2``."""
    return f"o{thing}"


def names_of(things: Iterable[int]) -> dict[str, int]:
    """The object of each name in a goal: ``o2`` or ``2``."""
    return {name: thing for thing in things for name in (pddl_name(thing), str(thing))}


def pddl_goal(statements: Collection[Statement], things: Iterable[int], predicates: Mapping[str, int]) -> str:
    """The goal in PDDL.

    Parameters
    ----------
    statements : collection of Statement
    things : iterable of int
        The objects of the scene.
    predicates : mapping from str to int
        How many objects each predicate takes.

    Raises
    ------
    InputError
        A predicate or an object is unknown, or a predicate has the wrong number of objects.
    """
    known = {name: pddl_name(thing) for name, thing in names_of(things).items()}
    atoms = [_atom(statement, known, predicates) for statement in statements]
    return atoms[0] if len(atoms) == 1 else f"(and {' '.join(atoms)})"


def _atom(statement: Statement, known: Mapping[str, str], predicates: Mapping[str, int]) -> str:
    name, arguments = statement.name, list(statement.arguments)
    if len(arguments) == 2 and TABLE_WORD in arguments:
        name = f"{name}-{TABLE_WORD}" if arguments[1] == TABLE_WORD else f"{TABLE_WORD}-{name}"
        arguments.remove(TABLE_WORD)
    if name not in predicates:
        raise InputError(f"goal must state one of {', '.join(predicates)}, got '{name}'")
    if strangers := [argument for argument in arguments if argument not in known]:
        objects = ", ".join(dict.fromkeys(known.values())) or "none"
        raise InputError(f"goal must name objects of the scene ({objects}), got '{strangers[0]}'")
    if len(arguments) != predicates[name]:
        raise InputError(f"goal: {name} takes {predicates[name]} objects, got {len(arguments)}")
    atom = f"({' '.join([name, *(known[argument] for argument in arguments)])})"
    return atom if statement.holds else f"(not {atom})"
