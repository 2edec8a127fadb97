"""Rows of pairs told by others: displacements, votes and unions by hand, a naive twin, and who may be asked."""

import numpy as np
import pytest

from lifelore.core.relations import ADJACENT, BOTH, CORE_RELATIONS, NONE, ON, SYMMETRIC, PairLabel
from lifelore.perception.pairs.pair_features import column_names
from lifelore.perception.peers import PEERS
from lifelore.perception.relations.relation import Relation
from lifelore.perception.relations.relation_classifier import RelationClassifier
from reproduction.chapter2.scenes.tabletop_pairs import STANDARD
from reproduction.chapter2.scoring import pair_validation
from reproduction.chapter2.scoring.pair_validation import (
    Reading,
    Votes,
    as_scene,
    as_seen,
    cross_validated,
    displacements,
    gap_of,
    in_given_order,
    label_of,
    united,
    votes_of_neighbours,
    votes_on,
)

COLUMNS = column_names(2)


def pair(scene, relation, a=((0, 0, 0, 9),), b=((0, 0, 0, 9),), way=(2, 3), gap: float | None = 0.01) -> dict:
    """A row of the things 2 and 3, with the contacts of 2 and of 3; `way` is the truth's order."""
    row = {"scene": scene, "a": way[0], "b": way[1], "relation": relation, "confidence": 3}
    if gap is None:
        return {**row, "pair": [2, 3], "gap": None}
    contacts = {STANDARD: {"a": [list(c) for c in a], "b": [list(c) for c in b]}}
    return {**row, "pair": [2, 3], "gap": gap, "contacts": contacts}


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
    # Contacts are stored in the order of the numbers; the truth may say it the other way.
    turned = {**row, "a": 3, "b": 2}
    assert displacements(turned).tolist() == [[-x, -y, -z] for x, y, z in expected]


def test_a_pair_that_is_not_near_has_no_displacement():
    assert displacements(pair("s", NONE, gap=None)).shape == (0, 3)


@pytest.mark.parametrize(
    ("supports", "all_but_one", "weak"),
    [
        ((9, 7, 6), [0, 1], [0, 1]),  # seven is enough
        ((6, 9), [1], [1]),  # the strongest of all is no exception where another has support
        ((6, 6), [0], []),  # nobody has enough: the strongest, which stands first, or nobody
    ],
)
def test_weak_contacts_are_dropped(supports, all_but_one, weak):
    row = pair("s", ON, a=[(x, 0, 0, n) for x, n in enumerate(supports)])
    assert displacements(row, drop="all but one")[:, 0].tolist() == all_but_one
    assert displacements(row, drop="weak")[:, 0].tolist() == weak


def test_weak_contacts_are_dropped_on_either_side():
    row = pair("s", ON, b=[(3, 0, 0, 2), (4, 0, 0, 2)])
    assert displacements(row, drop="all but one").tolist() == [[-3, 0, 0]]
    assert displacements(row, drop="weak").shape == (0, 3)


def test_each_kernel_has_its_own_contacts():
    row = pair("s", ON)
    row["contacts"]["other"] = {"a": [[7, 0, 0, 9]], "b": [[0, 0, 0, 9]]}
    assert displacements(row).tolist() == [[0, 0, 0]]
    assert displacements(row, "other").tolist() == [[7, 0, 0]]


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


def test_near_votes_weigh_more_by_inverse_distance():
    told = votes_of_neighbours(LINE, Reading(votes="inverse distance"))
    # At 0: on at 1; adjacent at 2 and 3; both at 10. At 10: on at 10 and 9, adjacent at 8 and 7.
    first = np.array([1, 1 / 2 + 1 / 3, 1 / 10, 0])
    last = np.array([1 / 10 + 1 / 9, 1 / 8 + 1 / 7, 0, 0])
    np.testing.assert_allclose(told.shares[0], first / first.sum())
    np.testing.assert_allclose(told.shares[4], last / last.sum())
    assert (told.labels[0], told.labels[4]) == (ON, ADJACENT)


def test_ties_go_to_the_first_by_name():
    rows = one_by_one((ADJACENT, 0), (ON, 1), (NONE, 2), (BOTH, 3))
    assert votes_of_neighbours(rows, Reading(k=1)).labels[0] == ON
    assert votes_of_neighbours(rows, Reading(k=2)).labels[0] == NONE
    assert votes_of_neighbours(rows, Reading(k=3)).labels[0] == BOTH
    # Two at one distance, all of whom are asked, weigh the same.
    rows = one_by_one((ON, 0), (NONE, 1), (ADJACENT, -1))
    told = votes_of_neighbours(rows, Reading(votes="inverse distance"))
    assert told.shares[0].tolist() == [0, 0.5, 0, 0.5]
    assert told.labels[0] == ADJACENT


def test_the_thesis_asks_four():
    assert Reading().k == 4
    rows = one_by_one(
        (ON, 0), (ON, 1), (ON, -1.5), (ON, 2), (ADJACENT, -2.5), *[(ADJACENT, 3 + n) for n in range(5)]
    )
    told = votes_of_neighbours(rows)
    assert told.shares[0].tolist() == [0.75, 0.25, 0, 0]
    # A fifth and sixth would have changed it.
    assert votes_of_neighbours(rows, Reading(k=7)).labels[0] == ADJACENT


def test_nobody_of_the_own_scene_is_asked():
    rows = [at("s", ON, 0), at("s", ON, 0), at("s", ON, 0.1), at("t", ADJACENT, 50), at("u", NONE, 100)]
    told = votes_of_neighbours(rows, Reading(k=1))
    assert told.labels.tolist() == [ADJACENT, ADJACENT, ADJACENT, ON, ADJACENT]


def test_fewer_than_four_and_nobody_to_ask():
    told = votes_of_neighbours([at("s", ON, 0), at("t", ADJACENT, 1)])
    assert told.shares.tolist() == [[0, 1, 0, 0], [1, 0, 0, 0]]
    alone = votes_of_neighbours([at("s", ON, 0, 1)])
    assert alone.labels.tolist() == [NONE, NONE]
    assert not alone.shares.any()
    far = votes_of_neighbours([pair("s", NONE, gap=None), pair("t", ON, gap=None)])
    assert (len(far.row), far.relations(2)) == (0, [NONE, NONE])


def test_long_displacements_are_told_but_not_learnt_from():
    rows = one_by_one((ON, 1), (ON, 2), (ADJACENT, -5), (ADJACENT, -6), (ADJACENT, -7))
    assert votes_of_neighbours(rows).labels[2] == ADJACENT
    told = votes_of_neighbours(rows, Reading(omega=2))
    assert told.row.tolist() == [0, 1, 2, 3, 4]
    assert told.labels.tolist() == [ON] * 5
    # The limit is the whole length, and its own end belongs to it.
    assert votes_of_neighbours(rows, Reading(omega=1.9)).labels.tolist() == [NONE, ON, ON, ON, ON]


def test_only_training_rows_are_asked_and_only_others_told():
    train = np.array([True, False, False, True, False])
    told = votes_of_neighbours(LINE, train=train)
    assert told.row.tolist() == [1, 2, 4]
    assert told.shares.tolist() == [[0.5, 0.5, 0, 0]] * 3


def test_a_scene_on_both_sides_is_still_not_asked():
    rows = [at("s", ON, 0), at("s", ON, 1), at("t", ADJACENT, 9)]
    told = votes_of_neighbours(rows, train=np.array([True, False, True]))
    assert told.labels.tolist() == [ADJACENT]


def naive(rows, reading, train=None) -> list[tuple[int, dict[str, float]]]:
    """Every displacement against every other, sorted; the votes of each."""
    every = [(i, d) for i, row in enumerate(rows) for d in displacements(row, reading.kernel, reading.drop)]
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
    """30 rows of 20 scenes; up to three contacts a side, some weak, in either order, some not near."""
    rng = np.random.default_rng(seed)

    def contacts():
        return [(*rng.normal(size=3).round(6), int(rng.integers(4, 12))) for _ in range(rng.integers(1, 4))]

    return [
        pair(
            f"scene {rng.integers(20)}",
            CORE_RELATIONS[rng.integers(4)],
            contacts(),
            contacts(),
            way=(2, 3) if rng.random() < 0.5 else (3, 2),
            gap=None if rng.random() < 0.1 else 0.01,
        )
        for _ in range(30)
    ]


@pytest.mark.parametrize("block", [1, 300, 4_000_000])
@pytest.mark.parametrize(
    "reading",
    [
        Reading(),
        Reading(drop="weak", k=1),
        Reading(votes="inverse distance", omega=2.0),
        Reading(drop="weak", votes="inverse distance", k=7),
        Reading(omega=0.3, k=5),
    ],
    ids=str,
)
def test_block_by_block_is_what_sorting_all_distances_gives(reading, block, monkeypatch):
    monkeypatch.setattr(pair_validation, "BLOCK", block)
    for seed, train in ((0, None), (1, np.random.default_rng(1).random(30) < 0.6)):
        rows = some_rows(seed)
        told, expected = votes_of_neighbours(rows, reading, train), naive(rows, reading, train)
        assert told.row.tolist() == [i for i, _ in expected]
        for label, shares, (_, votes) in zip(told.labels, told.shares, expected, strict=True):
            np.testing.assert_allclose(shares, [votes.get(name, 0) for name in CORE_RELATIONS], atol=1e-12)
            best = max(votes.values(), default=0)
            assert label == min((name for name, n in votes.items() if n > best - 1e-12), default=NONE)


def test_votes_on_displacements_that_are_known_already_are_the_same():
    rows = some_rows(2)
    each = [displacements(row) for row in rows]
    owner = np.repeat(np.arange(30), [len(one) for one in each])
    told, again = votes_of_neighbours(rows), votes_on(np.concatenate(each), owner, rows, Reading())
    assert np.array_equal(told.shares, again.shares)
    assert np.array_equal(told.row, again.row)


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


def test_a_pair_with_two_contacts_is_both():
    rows = [at(f"on {n}", ON, 0.01 * n) for n in range(4)]
    rows += [at(f"beside {n}", ADJACENT, 9 + 0.01 * n) for n in range(4)]
    rows += [at("two", ON, 0.1, 9.1)]
    told = votes_of_neighbours(rows)
    assert told.row.tolist() == [0, 1, 2, 3, 4, 5, 6, 7, 8, 8]
    assert told.relations(9)[8] == BOTH
    # Of the others each has three or more of its own kind beside it.
    assert told.relations(9)[:8] == [ON] * 4 + [ADJACENT] * 4


def test_what_is_said_stands_beside_what_is_true():
    rows = [pair("s", ON, way=(3, 2)), pair("t", NONE, gap=None)]
    first, second = in_given_order(rows, [ON, ADJACENT])
    assert first.truth == label_of(rows[0]) == PairLabel(3, 2, ON, 3)
    assert first.predicted == Relation(3, 2, ON, 1.0, 0.01)
    assert first.exact
    assert (second.scene, second.exact, second.gap, gap_of(rows[1])) == ("t", False, np.inf, np.inf)
    with pytest.raises(ValueError, match="zip"):
        in_given_order(rows, [ON])


# --- direction inferred -----------------------------------------------------------------------------------


class Parrot:
    """Says the one relation it was made with; remembers what it was given."""

    def __init__(self, log, says=None):
        self.log, self.says = log, says

    def fit_pairs(self, scenes, truths):
        self.log.append((list(scenes), [label for truth in truths for label in truth], []))
        return self

    def predict_pairs(self, scene):
        self.log[-1][2].append(scene)
        return [] if self.says is None else [self.says]


def scenes_of(*names) -> list[dict]:
    return [pair(name, ON) for name in names]


@pytest.mark.parametrize(("folds", "times"), [(None, 4), (2, 2), (3, 3)])
def test_no_scene_is_told_by_a_model_that_saw_it(folds, times):
    log: list = []
    rows = scenes_of("c", "a", "a", "d", "b", "c")
    judged = cross_validated(rows, lambda: Parrot(log), lambda row: row["scene"], folds)
    assert len(log) == times
    assert sorted(scene for _, _, told in log for scene in told) == ["a", "a", "b", "c", "c", "d"]
    for learnt, labels, told in log:
        assert len(learnt) == len(labels)
        assert not set(learnt) & set(told)
        assert len(learnt) + len(told) == 6
    # A model that says nothing says none.
    assert [one.scene for one in judged] == ["c", "a", "a", "d", "b", "c"]
    assert {one.relation for one in judged} == {NONE}


def test_scenes_are_dealt_to_folds_in_turn():
    log: list = []
    cross_validated(scenes_of("c", "a", "d", "b"), lambda: Parrot(log), lambda row: row["scene"], 2)
    assert [(learnt, told) for learnt, _, told in log] == [(["d", "b"], ["c", "a"]), (["c", "a"], ["d", "b"])]


def test_pairs_that_are_not_near_are_neither_shown_nor_learnt_from():
    log: list = []
    rows = [pair("a", ON), pair("b", NONE, gap=None), pair("c", ADJACENT)]
    said = Relation(2, 3, ON, 1.0, 0.01)
    judged = cross_validated(rows, lambda: Parrot(log, said), lambda row: row["scene"])
    assert [learnt for learnt, _, _ in log] == [["c"], ["a"]]
    assert [labels for _, labels, _ in log] == [[PairLabel(2, 3, ADJACENT, 3)], [PairLabel(2, 3, ON, 3)]]
    assert [one.predicted for one in judged] == [said, None, said]
    assert [one.exact for one in judged] == [True, True, False]


def test_the_direction_counts():
    rows = [pair("a", ON, way=(3, 2)), pair("b", ON)]
    judged = cross_validated(rows, lambda: Parrot([], Relation(2, 3, ON, 1.0, 0.01)), lambda row: row["scene"])
    assert [one.exact for one in judged] == [False, True]


def numbered(scene, relation, way, up) -> dict:
    """A row whose displacement in the truth's order is (0, 0, up)."""
    sign = 1 if way == (2, 3) else -1
    row = pair(scene, relation, a=[(0, 0, sign * up, 9)], way=way)
    return row | {"features": np.zeros((2, len(COLUMNS))).tolist()}


def test_a_model_is_shown_the_order_of_the_numbers_only():
    row = numbered("s", ON, (3, 2), 5)
    features = np.arange(2.0 * len(COLUMNS)).reshape(2, -1)
    scene = as_scene(row | {"features": features.tolist()})
    assert scene.features.pairs.tolist() == [[2, 3], [3, 2]]
    assert scene.features.gaps.tolist() == [0.01, 0.01]
    np.testing.assert_array_equal(scene.features.matrix, features)
    assert scene.displacements[0].tolist() == [[0, 0, -5]]
    # The same picture under another truth looks the same.
    other = as_scene({**row, "a": 2, "b": 3, "features": features.tolist()})
    assert other.displacements[0].tolist() == [[0, 0, -5]]


def test_the_thesiss_neighbours_infer_the_direction():
    ways = [(2, 3), (3, 2), (3, 2), (2, 3), (3, 2), (2, 3)]
    rows = [numbered(f"on {n}", ON, way, 1 + 0.01 * n) for n, way in enumerate(ways)]
    rows += [numbered(f"beside {n}", ADJACENT, way, 0.01 * n) for n, way in enumerate(ways)]
    judged = cross_validated(rows, lambda: RelationClassifier("displacement", symmetric=SYMMETRIC), as_scene)
    assert all(one.exact for one in judged)
    assert [(one.predicted.a, one.predicted.b) for one in judged[:6] if one.predicted] == ways


def test_a_peer_sees_what_the_row_keeps_of_it():
    up = [[0.0, 0.0, 1.0], [0.0, 0.0, -1.0]]
    rows = [
        pair("a", ON, way=(3, 2)) | {"peers": {"majority": up[::-1]}},
        pair("b", ON) | {"peers": {"majority": up}},
        pair("c", ON, way=(3, 2)) | {"peers": {"majority": up}},
    ]
    (seen,) = as_seen("majority")(rows[0])
    assert (seen.a, seen.b, seen.gap, seen.rows.tolist()) == (2, 3, 0.01, up[::-1])
    # The majority says on of the higher: true of the first two.
    judged = cross_validated(rows, PEERS["majority"], as_seen("majority"))
    assert [one.exact for one in judged] == [True, True, False]
