"""Relations made of relations, by logic (clingo): clear, stacked, supports*, and the thesis's `between` and `in`.

| fact | holds when |
|---|---|
| ``clear(a)`` | no object rests on a; with other words only where *on* or *both* supports every object |
| ``supports*(a, b)`` | b rests on a, directly or through others; a is an object |
| ``stacked(a, b, c)`` | a rests on b, b on c, three objects (Fig. 2.7) |
| ``between(b, a, c)`` | b is adjacent to a and to c, a before c (§5.2: "two different adjacent relationships") |
| ``in(a, b)`` | a is on b and adjacent to it (§5.2: "the presence of on as well as adjacent") |

"Rests on" is *on* or *both*. The last two are as the thesis proposes and are not what the words mean: see errata
E14, and `geometric_relations` for definitions that look at the points.

Thesis: §5.2.
"""

from collections.abc import Iterable

from lifelore.core.errors import InputError
from lifelore.core.labelled_cloud import TABLE
from lifelore.perception.reasoning.fact import Fact, objects_without_support, words_outside_core
from lifelore.perception.relations.relation import Relation

COMPOUND_RULES = """
on(A, B) :- relation("on", A, B).
on(A, B) :- relation("both", A, B).
adjacent(A, B) :- relation("adjacent", A, B).
adjacent(A, B) :- relation("both", A, B).
adjacent(A, B) :- adjacent(B, A).
supports(B, A) :- on(A, B), object(B).
supports_star(B, A) :- supports(B, A).
supports_star(C, A) :- supports(C, B), supports_star(B, A).
fact("clear", (A,)) :- object(A), not supports(A, _), not other_words.
fact("supports*", (A, B)) :- supports_star(A, B), A != B.
fact("stacked", (A, B, C)) :- supports(B, A), supports(C, B), A != C.
fact("between", (B, A, C)) :- adjacent(A, B), adjacent(B, C), object(A), object(B), object(C), A < C.
fact("in", (A, B)) :- on(A, B), adjacent(A, B), object(B).
#show fact/2.
"""
"""The program: ``relation(Name, A, B)``, ``object(A)`` and, where another word may say what an object rests on,
``other_words`` are given; ``fact(Name, (A, …))`` are read off."""


def compound_relations(
    relations: Iterable[Relation], objects: Iterable[int] = (), *, more_rules: str = ""
) -> tuple[Fact, ...]:
    """Every compound fact that the relations imply, sorted by name and objects.

    Parameters
    ----------
    relations : iterable of Relation
        Of any vocabulary; a rule of yours can use names of yours. With a word outside the core vocabulary, and an
        object that no *on* or *both* supports, no object is said to be clear: that word may mean resting.
    objects : iterable of int
        Objects beside those the relations name.
    more_rules : str
        Clingo rules added to `COMPOUND_RULES`, such as ``fact("tower", (A, B)) :- fact("stacked", (A, B, _)).``

    Raises
    ------
    InputError
        `more_rules` is not a clingo program, or its facts are not of whole numbers.

    Examples
    --------
    >>> row = [Relation(2, 3, "adjacent", 1.0, 0.0), Relation(3, 4, "adjacent", 1.0, 0.0)]
    >>> [str(fact) for fact in compound_relations(row) if fact.name != "clear"]
    ['between(3, 2, 4)']
    """
    import clingo

    relations = tuple(relations)
    things = sorted({*objects, *(label for r in relations for label in (r.a, r.b))} - {TABLE})
    given = [f"object({thing})." for thing in things]
    given += [f"relation({clingo.String(r.relation)},{r.a},{r.b})." for r in relations]
    unsure = words_outside_core(relations) and objects_without_support(relations, things)
    given += ["other_words."] if unsure else []
    complaints: list[str] = []
    control = clingo.Control(["--warn=no-atom-undefined"], logger=lambda _, text: complaints.append(text))
    try:
        control.add("base", [], COMPOUND_RULES + more_rules + "\n" + "\n".join(given))
        control.ground([("base", [])])
    except RuntimeError as error:
        raise InputError(f"more_rules must be a clingo program: {' '.join(complaints) or error}") from None
    with control.solve(yield_=True) as handle:
        model = handle.model()
        if model is None:
            raise InputError("more_rules must leave one answer; they contradict the relations")
        return tuple(sorted(_fact(symbol) for symbol in model.symbols(shown=True) if symbol.match("fact", 2)))


def _fact(symbol) -> Fact:
    name, arguments = symbol.arguments
    try:
        return Fact(name.string, tuple(argument.number for argument in arguments.arguments))
    except RuntimeError:
        raise InputError(f"a rule's fact must be a string and a tuple of objects, got {symbol}") from None
