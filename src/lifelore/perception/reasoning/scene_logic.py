"""The most likely consistent scene: what perception says, reconciled by logic (clingo).

Perception judges each pair by itself, and its judgements can contradict each other: a on b on c on a, or an object
that rests on nothing. The rules:

1. a pair has one relation (*on* and *adjacent* together are the one label *both*);
2. nothing carries the table;
3. everything rests on something, an object or the table;
4. nothing rests on itself, directly or through others.

Among all labellings that obey the rules we take the most probable, pairs being taken as independent but for the
soft rule of `second_support`: what leans needs a second support. Weak constraints ``-ln p``, as whole numbers
(`SCALE` to the nat), so that choosing between two labels weighs the log-odds of their probabilities. Of equally
probable scenes, the pair with the lowest numbers keeps its likelier label, and of equally likely labels the one
that claims least. Where perception says nothing of an object and the table, it stands on the table if, and only
if, no object carries it.

Thesis: §2.5 leaves reasoning over the relations to other work; §5.2 proposes a logic engine.
"""

from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass
from math import inf, prod

from lifelore.core.errors import InputError
from lifelore.core.labelled_cloud import TABLE
from lifelore.core.relations import CORE_RELATIONS, ON
from lifelore.perception.reasoning.label_distribution import (
    LabelDistribution,
    carries,
    label_distributions,
    relation_label,
)
from lifelore.perception.reasoning.second_support import LONE_LEAN, is_lone, leans, supports
from lifelore.perception.relations.relation import PairBelief, Relation

SCALE = 1000
"""Weights to the nat: probabilities that differ by 0.1 % are told apart, and no sum leaves 64 bits."""

MOST_CONFLICTS = 20_000
"""The solver gives up proving after so many conflicts: a count, not a time, so that load changes no answer."""

RULES = """
{ pick(P, L) : option(P, L, _, _) } = 1 :- pair(P).
rests(X, Y) :- pick(P, L), carry(P, L, X, Y).
:- must_rest(X), not rests(X, _).
#edge (X, Y) : rests(X, Y).
second(X, Y) :- rests(X, Y), rests(X, Z), Y != Z.
#minimize { W@(N + 1), P : pick(P, L), option(P, L, W, _), pairs(N);
            W@(N + 1), P, lone : pick(P, L), leans(P, L, X, Y), lone_lean(W), not second(X, Y), pairs(N) }.
#minimize { R@(N - P), P : pick(P, L), option(P, L, _, R), pairs(N) }.
#show pick/2.
"""
"""Pairs are numbered in order, so that the tie-break of an earlier pair has the higher priority."""


@dataclass(frozen=True)
class ConsistentScene:
    """A scene without contradictions.

    Parameters
    ----------
    relations : tuple of Relation
        One a pair, pairs ascending, then those with the table; confidence is the label's probability.
    optimal : bool
        Whether it is proven that no consistent scene is likelier; False when the solver's bound ran out.
    """

    relations: tuple[Relation, ...]
    optimal: bool


def most_likely_scene(
    candidates: Iterable[Relation],
    objects: Iterable[int] = (),
    *,
    beside: Collection[frozenset[int]] = (),
    most_conflicts: int = MOST_CONFLICTS,
) -> ConsistentScene:
    """The most likely scene that obeys the rules of this module.

    Parameters
    ----------
    candidates : iterable of Relation
        One relation a pair, or several that are alternatives, their confidences being probabilities (see
        `LabelDistribution.from_candidates` for what they leave of 1). Relations outside the core vocabulary take
        no part and come back unchanged, after the others.
    objects : iterable of int
        Objects that must rest on something, beside those the candidates name.
    beside : collection of frozenset of int
        Pairs whose side faces are beside each other (`side_faces.pairs_beside`), where leaning needs no second
        support.
    most_conflicts : int
        Bound on the solver's work, ≥ 1.

    Raises
    ------
    InputError
        A confidence is outside [0, 1], a relation joins an object to itself, or the bound is below 1.

    Examples
    --------
    >>> seen = [Relation(2, 3, "on", 0.9, 0.0), Relation(3, 4, "on", 0.8, 0.0), Relation(4, 2, "on", 0.3, 0.0)]
    >>> [(r.relation, r.a, r.b) for r in most_likely_scene(seen).relations]
    [('on', 2, 3), ('none', 2, 4), ('on', 3, 4), ('on', 4, 1)]
    """
    candidates = tuple(candidates)
    if most_conflicts < 1:
        raise InputError(f"most_conflicts must be at least 1, got {most_conflicts}")
    beliefs = label_distributions(candidates)
    things = sorted({*objects, *(label for belief in beliefs for label in belief.pair)} - {TABLE})
    best = [belief.likeliest for belief in beliefs]
    judged = _judged(beliefs)
    labels = [b.labels[k] for b, k in zip(beliefs, best, strict=True)]
    rests = supports(labels)
    lone = any(leans(label, beside, judged) and is_lone(label, rests) for label in labels)
    unsettled = lone or not _is_consistent(rests, judged)
    picked, optimal = _solve(beliefs, beside, most_conflicts) if unsettled else (best, True)
    decided = [belief.relation(k) for belief, k in zip(beliefs, picked, strict=True)]
    return ConsistentScene((*decided, *_on_the_table(decided, beliefs, things), *_others(candidates)), optimal)


def alternatives(beliefs: Iterable[PairBelief]) -> tuple[Relation, ...]:
    """All that a classifier holds possible of each pair, as candidates for `most_likely_scene`."""
    return tuple(belief.relation(name) for belief in beliefs for name in belief.shares)


def _is_consistent(rests: Mapping[int, Iterable[int]], must_rest: Iterable[int]) -> bool:
    """Whether all of `must_rest` rest on something, and nothing rests on itself, directly or through others."""
    hanging = any(thing not in rests for thing in must_rest)
    return not hanging and not any(thing in reached_from(thing, rests) for thing in rests)


def reached_from(thing: int, links: Mapping[int, Iterable[int]]) -> set[int]:
    """All objects that links lead to from one, directly or through others; itself where it is part of a circle."""
    found: set[int] = set()
    waiting = [thing]
    while waiting:
        new = set(links.get(waiting.pop(), ())) - found
        found |= new
        waiting += new
    return found


def _judged(beliefs: Iterable[LabelDistribution]) -> set[int]:
    """Objects of which perception said something towards the table: for others, the table is always open."""
    return {belief.pair[0] for belief in beliefs if belief.pair[1] == TABLE}


def _on_the_table(
    decided: Sequence[Relation], beliefs: Sequence[LabelDistribution], things: Iterable[int]
) -> list[Relation]:
    """``on(x, table)`` for each object without a carrier; as sure as it is that no other object carries it."""
    carried = {step[0] for r in decided if (step := carries(relation_label(r))) is not None}
    free = [thing for thing in things if thing not in carried and thing not in _judged(beliefs)]
    sure = {x: prod(1 - b.carried(x) for b in beliefs if x in b.pair) for x in free}
    return [Relation(thing, TABLE, ON, sure[thing], inf) for thing in free]


def _others(candidates: Iterable[Relation]) -> list[Relation]:
    return [relation for relation in candidates if relation.relation not in CORE_RELATIONS]


def _solve(
    beliefs: Sequence[LabelDistribution], beside: Collection[frozenset[int]], most_conflicts: int
) -> tuple[list[int], bool]:
    """The number of each belief's label in the most likely consistent scene, and whether that is proven."""
    import clingo

    # Core-guided search: a proof in tens of conflicts where descending from a first model needs tens of thousands.
    control = clingo.Control(["--warn=none", "--opt-strategy=usc", f"--solve-limit={most_conflicts}"])
    control.add("base", [], RULES + "\n".join(_facts(beliefs, beside)))
    control.ground([("base", [])])
    picked = _bearing_nothing(beliefs)
    with control.solve(yield_=True) as handle:
        for model in handle:
            for symbol in model.symbols(shown=True):
                pair, label = (argument.number for argument in symbol.arguments)
                picked[pair] = label
        return picked, bool(handle.get().exhausted)


def _bearing_nothing(beliefs: Iterable[LabelDistribution]) -> list[int]:
    """A consistent scene to fall back on: no object carries another, and all stand on the table."""
    picked = []
    for belief in beliefs:
        on_table = belief.pair[1] == TABLE
        open_ = [k for k, label in enumerate(belief.labels) if (carries(label) is not None) == on_table]
        picked.append(max(open_, key=lambda k: (belief.probabilities[k], -k)))
    return picked


def _facts(beliefs: Sequence[LabelDistribution], beside: Collection[frozenset[int]]) -> Iterable[str]:
    """The beliefs as facts of the logic program."""
    judged = _judged(beliefs)
    yield f"pairs({len(beliefs)}). lone_lean({round(SCALE * LONE_LEAN)})."
    yield from (f"must_rest({thing})." for thing in sorted(judged))
    for number, belief in enumerate(beliefs):
        yield f"pair({number})."
        least = belief.cost(belief.likeliest)
        weights = [round(SCALE * (belief.cost(k) - least)) for k in range(len(belief.labels))]
        order = sorted(range(len(weights)), key=lambda k, w=weights: (w[k], k))
        for rank, k in enumerate(order):
            yield f"option({number},{k},{weights[k]},{rank})."
            step = carries(belief.labels[k])
            if step is not None:
                yield f"carry({number},{k},{step[0]},{step[1]})."
            if leans(belief.labels[k], beside, judged):
                yield f"leans({number},{k},{belief.labels[k][1]},{belief.labels[k][2]})."
