"""C5.1: counts, shares and intervals of words on rows made by hand; what must turn from the other side."""

from types import SimpleNamespace

import numpy as np
import pytest

from lifelore.core.errors import InputError
from lifelore.perception.pairs.pair_features import COLUMNS
from lifelore.perception.relations.relation import Relation
from reproduction.chapter2.scoring.relation_scoring import wilson
from reproduction.chapter5.c5_01_more_relations.measure import (
    compound_counts,
    f1,
    measure,
    pairs_by_word,
    precision,
    predicted,
    recall,
    resampled,
    rows,
    scene_of,
    turned_counts,
    word_counts,
)
from reproduction.chapter5.c5_01_more_relations.view_words import WORDS
from reproduction.engine.registry import claim_of

C5_1 = claim_of("C5.1")

ROW = {
    "pairs": [[2, 3], [3, 2]],
    "gaps": [0.01, 0.01],
    "features": np.zeros((2, len(COLUMNS))).tolist(),
    "labelled": [[2, 3], [3, 4]],
    "truth": [[2, 3, "left_of"], [3, 2, "right_of"], [3, 4, "left_of"], [4, 3, "right_of"], [4, 3, "dwarfs"]],
    "by_rule": [],
}


def test_a_word_is_counted_in_both_orders_of_every_labelled_pair():
    said = pairs_by_word([[2, 3, "left_of"], [4, 3, "left_of"], [5, 6, "left_of"], [4, 3, "dwarfs"]])
    # Of left: (2, 3) right, (4, 3) wrong, (3, 4) missed; (5, 6) nobody labelled.
    assert word_counts([ROW], [said], "left_of").tolist() == [[1, 2, 2, 4]]
    assert word_counts([ROW], [said], "right_of").tolist() == [[0, 0, 2, 4]]
    assert word_counts([ROW], [said], "dwarfs").tolist() == [[1, 1, 1, 4]]
    assert word_counts([], [], "dwarfs").shape == (0, 4)


def test_scores_by_hand():
    # Rightly predicted, predicted, true, ordered pairs.
    counts = np.array([[3, 4, 6, 20], [0, 0, 0, 4]], float)
    assert f1(counts) == pytest.approx([6 / 10, 0])
    assert precision(counts) == pytest.approx([3 / 4, 0])
    assert recall(counts) == pytest.approx([3 / 6, 0])
    # The harmonic mean of the two.
    assert f1(counts)[0] == pytest.approx(2 * (3 / 4) * (1 / 2) / (3 / 4 + 1 / 2))
    assert f1(counts.sum(axis=0)) == pytest.approx(0.6)


def test_scenes_are_resampled():
    # Ten scenes, five of them all right and five all wrong, of ten pairs each.
    counts = np.array([[10, 10, 10, 10]] * 5 + [[0, 10, 10, 10]] * 5, float)
    found = resampled(counts, recall, 100)
    assert (found.value, found.n) == (0.5, 100)
    assert found.ci95 is not None
    low, high = found.ci95
    assert low < 0.5 < high
    # Ten fair answers deviate by 0.158, a hundred by 0.05: 95 % intervals 0.62 and 0.2 wide.
    assert 0.5 <= high - low <= 0.7
    assert resampled(counts, recall, 100) == found


def test_scenes_that_all_agree_have_wilsons_interval_and_no_scenes_none():
    found = resampled(np.array([[2, 2, 2, 4]] * 6, float), recall, 12)
    assert (found.value, found.ci95) == (1.0, wilson(12, 12))
    for nothing in (resampled(np.empty((0, 4)), recall, 3), resampled(np.ones((3, 4)), recall, 0)):
        assert nothing.n == 0
        assert nothing.ci95 is None
        assert np.isnan(nothing.value)


def test_what_a_model_says_with_symmetric_words_both_ways():
    said = (
        Relation(3, 2, "under", 0.9, 0.0),
        Relation(2, 3, "dwarfs", 0.9, 0.0),
        Relation(2, 3, "near", 0.9, 0.0),
    )
    model = SimpleNamespace(predict_pairs=lambda scene: said, symmetric_=frozenset({"dwarfs", "near"}))
    found = predicted(model, ROW)  # type: ignore[arg-type]
    assert set(found) == set(WORDS)
    assert found["under"] == {(3, 2)}
    assert found["dwarfs"] == {(2, 3), (3, 2)}
    assert found["left_of"] == frozenset()
    assert not any(predicted(model, {**ROW, "pairs": []}).values())  # type: ignore[arg-type]


def test_a_row_becomes_a_scene_again():
    scene = scene_of({**ROW, "features": (np.arange(2 * len(COLUMNS)) / 7).reshape(2, -1).tolist()})
    assert scene.features.pairs.tolist() == [[2, 3], [3, 2]]
    assert scene.features.gaps.tolist() == [0.01, 0.01]
    assert scene.features.matrix[1, 0] == pytest.approx(len(COLUMNS) / 7)
    assert scene_of({"pairs": [], "gaps": [], "features": []}).features.matrix.shape == (0, len(COLUMNS))


# --- the other side ---------------------------------------------------------------------------------------

FRONT = [[2, 3, "left_of"], [3, 2, "right_of"], [2, 3, "under"]]
BEHIND = [[2, 3, "right_of"], [3, 2, "left_of"], [2, 3, "under"]]


def seen(truth=FRONT, behind=BEHIND, pairs=((2, 3), (3, 2))):
    return {"truth": truth, "other_side": {"pairs": list(map(list, pairs)), "truth": behind}}


@pytest.mark.parametrize(
    ("word", "there", "kept"),
    [
        ("left_of", BEHIND, 1),
        # Said as from the front; said both ways; said not at all.
        ("left_of", FRONT, 0),
        ("left_of", [*FRONT, *BEHIND], 0),
        ("left_of", [], 0),
        # A word that is not of the view must stay.
        ("under", BEHIND, 1),
        ("under", [[3, 2, "under"]], 0),
    ],
)
def test_words_of_view_turn_and_others_stay(word, there, kept):
    found = turned_counts([seen()], [pairs_by_word(FRONT)], {0: pairs_by_word(there)}, word)
    assert [counts.tolist() for counts in found] == [[kept], [1]]


def test_only_what_was_rightly_said_and_can_be_asked_again_counts():
    ways = [
        # Not said from the front; said wrongly; the pair not near from there; not true from there.
        (seen(), pairs_by_word([])),
        (seen(truth=[]), pairs_by_word(FRONT)),
        (seen(pairs=()), pairs_by_word(FRONT)),
        (seen(behind=[]), pairs_by_word(FRONT)),
        (seen(), pairs_by_word(FRONT)),
    ]
    scenes, told = [list(part) for part in zip(*ways, strict=True)]
    found = turned_counts(scenes, told, dict.fromkeys(range(5), pairs_by_word(BEHIND)), "left_of")
    assert [counts.tolist() for counts in found] == [[0, 0, 0, 0, 1], [0, 0, 0, 0, 1]]
    # A scene that cannot be seen from there has no part.
    kept, n = turned_counts(
        [{**seen(), "other_side": None}, seen()], told[3:], {1: pairs_by_word(BEHIND)}, "left_of"
    )
    assert (kept.tolist(), n.tolist()) == ([1], [1])


# --- between and in ---------------------------------------------------------------------------------------


def test_compounds_by_hand():
    row = {"true": [["between", 3, 2, 4], ["in", 2, 3]], "thesis": [["between", 3, 2, 4], ["between", 5, 2, 4]]}
    corner = {"true": [], "thesis": [["in", 3, 2]]}
    results = [
        {"kind": "compound", "of": "row", "scenes": [row, row]},
        {"kind": "compound", "of": "corner", "scenes": [corner]},
        {"kind": "lesson", "of": "", "scenes": [{}]},
    ]
    between = compound_counts(results, "all", "thesis", "between")
    assert between.tolist() == [[1, 2, 1], [1, 2, 1], [0, 0, 0]]
    assert (precision(between.sum(axis=0)), recall(between.sum(axis=0))) == (0.5, 1.0)
    assert compound_counts(results, "corner", "thesis", "in").tolist() == [[0, 1, 0]]
    assert compound_counts(results, "row", "thesis", "in").tolist() == [[0, 0, 1]] * 2
    assert compound_counts(results, "cup", "thesis", "in").shape == (0, 3)


def lesson(number: int) -> dict:
    """Two pairs of things whose first feature alone says which is left."""
    left = 1 if number % 2 else -1
    matrix = np.zeros((2, len(COLUMNS)))
    matrix[:, COLUMNS.index("right")] = [-0.1 * left, 0.1 * left]
    a, b = (2, 3) if left > 0 else (3, 2)
    truth = [[a, b, "left_of"], [b, a, "right_of"]]
    return {**ROW, "features": matrix.tolist(), "labelled": [[2, 3]], "truth": truth, "by_rule": truth[:1]}


def test_measures_of_a_word_that_can_be_learnt():
    held_out = [{**lesson(number), "other_side": lesson(number + 1)} for number in range(4)]
    compound = {way: [["in", 2, 3]] for way in ("thesis", "thesis_perceived", "lifelore", "true")}
    results = [
        {"kind": "lesson", "of": "", "scenes": [lesson(number) for number in range(40)]},
        {"kind": "held-out", "of": "", "scenes": held_out},
        {"kind": "compound", "of": "cup", "scenes": [compound]},
    ]
    settings = {"lessons": [40], "scenes": 4, "compound": 1}
    found = measure(settings, results)
    values = {name: one.value for name, one in found.items()}
    scores = {(row["word"], row["lessons"]): row for row in rows(settings, results) if "word" in row}
    for word in ("left_of", "right_of"):
        assert scores[word, "40"]["f1"]["value"] == values[f"turned_{word}"] == 1.0
        # Four scenes; the word holds of one of the two ordered pairs of each.
        assert (scores[word, "40"]["true"], scores[word, "40"]["pairs"]) == (4, 8)
    # The rule, here, holds only for one of the two.
    assert [scores[word, "rule"]["f1"]["value"] for word in ("left_of", "right_of")] == [1.0, 0.0]
    assert values["left_and_right_change_places"] == 1.0
    assert found["left_and_right_change_places"].n == 8
    assert found["left_and_right_change_places"].ci95 == wilson(8, 8)
    assert (scores["under", "40"]["f1"]["n"], found["stays_under"].n) == (0, 0)
    # A word that was never asked is not the least.
    assert values["least_f1_of_the_five"] == 1.0
    assert values["precision_in_thesis"] == values["recall_in_thesis"] == 1.0
    assert found["precision_between_thesis"].n == 0


def test_lessons_must_rise():
    with pytest.raises(InputError, match="lessons must rise"):
        C5_1.settings("quick", {"lessons": [20, 10]})
