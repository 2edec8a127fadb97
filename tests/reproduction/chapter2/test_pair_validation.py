"""Rows of pairs told by others: displacements, votes and unions by hand, a naive twin, and who may be asked."""

import numpy as np
import pytest

from lifelore.core.relations import ADJACENT, BOTH, CORE_RELATIONS, NONE, ON
from reproduction.chapter2.scenes.tabletop_pairs import STANDARD
from reproduction.chapter2.scoring.pair_validation import (
    FIXED,
    SCALED,
    Reading,
    Votes,
    displacements,
    united,
    votes_of_neighbours,
)


def pair(scene, relation, a=((0, 0, 0, 9),), b=((0, 0, 0, 9),), gap: float | None = 0.01) -> dict:
    """A row of the things 2 and 3, with the contacts of 2 and of 3."""
    row = {"scene": scene, "a": 2, "b": 3, "relation": relation, "confidence": 3, "gap": gap, "contacts": {}}
    if gap is not None:
        row["contacts"] = {STANDARD: {"a": [list(c) for c in a], "b": [list(c) for c in b]}}
    return row


def at(scene, relation, *places) -> dict:
    """A row with the displacements (x, 0, 0), one for each of `places`."""
    return pair(scene, relation, a=[(x, 0, 0, 9) for x in places])


def one_by_one(*relations_at) -> list[dict]:
    return [at(str(number), name, x) for number, (name, x) in enumerate(relations_at)]


# --- displacements ----------------------------------------------------------------------------------------


def test_every_contact_of_one_meets_every_contact_of_the_other():
    row = pair("s", ON, a=[(1, 2, 3, 9), (5, 5, 5, 8)], b=[(1, 0, 0, 9), (0, 0, 4, 7)])
    expected = [[0, 2, 3], [1, 2, -1], [4, 5, 5], [5, 5, 1]]
    assert displacements(row).tolist() == expected


@pytest.mark.parametrize(
    ("supports", "scaled", "fixed"),
    [
        ((9, 7, 6), [0, 1], [0, 1]),  # seven is enough
        ((6, 9), [1], [1]),  # the strongest of all is no exception where another has support
        ((6, 6), [0], []),  # nobody has enough: the strongest, which stands first, or nobody
    ],
)
def test_weak_contacts_are_dropped(supports, scaled, fixed):
    row = pair("s", ON, a=[(x, 0, 0, n) for x, n in enumerate(supports)])
    assert displacements(row, threshold=SCALED)[:, 0].tolist() == scaled
    assert displacements(row, threshold=FIXED)[:, 0].tolist() == fixed


# --- votes ------------------------------------------------------------------------------------------------

LINE = one_by_one((ON, 0), (ON, 1), (ADJACENT, 2), (ADJACENT, 3), (BOTH, 10))
"""Five scenes: with k = 4 each is told by all others."""


def test_votes_by_hand():
    told = votes_of_neighbours(LINE)
    assert told.row.tolist() == [0, 1, 2, 3, 4]
    # At 10 two say on and two adjacent: of equal votes the first by name wins.
    assert told.labels.tolist() == [ADJACENT, ADJACENT, ON, ON, ADJACENT]
    expected = [[1, 2, 1, 0], [1, 2, 1, 0], [2, 1, 1, 0], [2, 1, 1, 0], [2, 2, 0, 0]]
    assert told.shares.tolist() == [[n / 4 for n in votes] for votes in expected]


def naive(rows, reading, train=None) -> list[tuple[int, dict[str, float]]]:
    """Every displacement against every other, sorted; the votes of each."""
    every = [(i, d) for i, row in enumerate(rows) for d in displacements(row, reading.kernel, reading.threshold)]
    said = []
    for i, mine in every:
        if train is not None and train[i]:
            continue
        others = sorted(
            (float(np.sqrt(((mine - other) ** 2).sum())), rows[j]["relation"])
            for j, other in every
            if rows[j]["scene"] != rows[i]["scene"]
            and (train is None or train[j])
            and (reading.omega is None or np.sqrt((other**2).sum()) <= reading.omega)
        )
        votes: dict[str, float] = dict.fromkeys([relation for _, relation in others[: reading.k]], 0.0)
        for distance, relation in others[: reading.k]:
            votes[relation] += 1 if reading.votes == "equal" else 1 / distance
        said.append((i, {name: votes[name] / sum(votes.values()) for name in votes}))
    return said


def some_rows(seed: int) -> list[dict]:
    """30 rows of 20 scenes; up to three contacts a side, some weak, some not near."""
    rng = np.random.default_rng(seed)

    def contacts():
        return [(*rng.normal(size=3).round(6), int(rng.integers(4, 12))) for _ in range(rng.integers(1, 4))]

    return [
        pair(
            f"scene {rng.integers(20)}",
            CORE_RELATIONS[rng.integers(4)],
            contacts(),
            contacts(),
            gap=None if rng.random() < 0.1 else 0.01,
        )
        for _ in range(30)
    ]


@pytest.mark.parametrize(
    "reading",
    [
        Reading(),
        Reading(threshold=FIXED, k=1),
        Reading(votes="inverse distance", omega=2.0),
        Reading(threshold=FIXED, votes="inverse distance", k=7),
        Reading(omega=0.3, k=5),
    ],
    ids=str,
)
def test_votes_are_what_sorting_all_distances_gives(reading):
    for seed, train in ((0, None), (1, np.random.default_rng(1).random(30) < 0.6)):
        rows = some_rows(seed)
        told, expected = votes_of_neighbours(rows, reading, train), naive(rows, reading, train)
        assert told.row.tolist() == [i for i, _ in expected]
        for label, shares, (_, votes) in zip(told.labels, told.shares, expected, strict=True):
            np.testing.assert_allclose(shares, [votes.get(name, 0) for name in CORE_RELATIONS], atol=1e-12)
            best = max(votes.values(), default=0)
            assert label == min((name for name, n in votes.items() if n > best - 1e-12), default=NONE)


# --- the union --------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("said", "whole"),
    [
        ([], NONE),
        ([NONE], NONE),
        ([ON], ON),
        ([ADJACENT, NONE], ADJACENT),
        ([ON, ADJACENT], BOTH),
        ([BOTH], BOTH),
        ([BOTH, ON], BOTH),
        ([BOTH, ADJACENT, NONE], BOTH),
    ],
)
def test_the_union_has_a_component_if_any_has(said, whole):
    assert united(set(said)) == whole


def test_each_rows_displacements_are_united():
    told = Votes(np.array([0, 2, 0, 2, 3]), np.array([ON, ON, ADJACENT, NONE, NONE]), np.zeros((5, 4)))
    assert told.relations(4) == [BOTH, NONE, ON, NONE]
