"""Measures and rows of claim C5.1: F1 of learnt words, their change from the other side, compound relations."""

from collections import Counter
from collections.abc import Callable, Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from lifelore.core.metrics import Estimate
from lifelore.core.streams import stream
from lifelore.perception.pairs.pair_features import COLUMNS, PairFeatures
from lifelore.perception.pairs.scene_pairs import ScenePairs
from lifelore.perception.relations.relation_classifier import RelationClassifier
from reproduction.chapter2.scoring.relation_scoring import share_over_scenes, wilson
from reproduction.chapter5.c5_01_more_relations.run import COMPOUND, HELD_OUT, KINDS, LESSON, labels_of
from reproduction.chapter5.c5_01_more_relations.view_words import USER_WORD, VIEW_WORDS, WORDS
from reproduction.engine.estimates import UNMEASURED
from reproduction.engine.results_table import computed_once

OPPOSITE = {"left_of": "right_of", "right_of": "left_of", "behind": "in_front_of", "in_front_of": "behind"}
"""The word of view that holds, for the same order of the pair, from the other side."""
RESAMPLES = 1000
COMPOUNDS = ("between", "in")
WAYS = ("thesis", "thesis_perceived", "lifelore")
RULE, OTHER_SIDE = "rule", "other side"
"""The definitions of the words applied to visible points, a baseline; and scenes seen from the other side."""
PairsByWord = dict[str, frozenset[tuple[int, int]]]
"""By word the ordered pairs of a scene for which it holds."""
Counts = NDArray[np.float64]


@computed_once
def answers(settings: Mapping, results: Sequence[Mapping]) -> dict[str, tuple[list[dict], list[PairsByWord]]]:
    """Held-out scenes and their predicted words by number of lessons (as text), by `RULE`, and from `OTHER_SIDE`.

    From the other side the model of the most lessons predicts.
    """
    lessons, scenes = (
        [scene for result in results if result["kind"] == kind for scene in result["scenes"]]
        for kind in (LESSON, HELD_OUT)
    )
    behind = [scene["other_side"] for scene in scenes if scene["other_side"]]
    models = {
        str(n): RelationClassifier(multi_label=True).fit_pairs(
            [scene_of(row) for row in lessons[:n]], [labels_of(row["truth"]) for row in lessons[:n]]
        )
        for n in settings["lessons"]
    }
    last = models[str(settings["lessons"][-1])]
    return {
        RULE: (scenes, [pairs_by_word(scene["by_rule"]) for scene in scenes]),
        **{n: (scenes, [predicted(model, scene) for scene in scenes]) for n, model in models.items()},
        OTHER_SIDE: (behind, [predicted(last, scene) for scene in behind]),
    }


def scene_of(row: Mapping) -> ScenePairs:
    """A scene's row as the classifier sees a scene."""
    matrix = np.array(row["features"], float).reshape(-1, len(COLUMNS))
    pairs = np.array(row["pairs"], np.int64).reshape(-1, 2)
    return ScenePairs(PairFeatures(COLUMNS, matrix, pairs, np.array(row["gaps"], float)), ())


def predicted(model: RelationClassifier, row: Mapping) -> PairsByWord:
    """The words that the model predicts for a scene; symmetric words in both orders."""
    relations = model.predict_pairs(scene_of(row)) if row["pairs"] else ()
    turned = [[r.b, r.a, r.relation] for r in relations if r.relation in model.symmetric_]
    return pairs_by_word([*([r.a, r.b, r.relation] for r in relations), *turned])


def pairs_by_word(rows: Sequence[Sequence]) -> PairsByWord:
    """Rows ``[a, b, word]`` by word."""
    return {word: frozenset((a, b) for a, b, name in rows if name == word) for word in WORDS}


def word_counts(scenes: Sequence[Mapping], predictions: Sequence[PairsByWord], word: str) -> Counts:
    """Of each scene the ordered pairs with the word rightly predicted, predicted, true; and all, ``(n, 4)``."""
    rows = []
    for row, words in zip(scenes, predictions, strict=True):
        orders = {order for a, b in row["labelled"] for order in ((a, b), (b, a))}
        true, answered = pairs_by_word(row["truth"])[word], words[word] & orders
        rows.append((len(true & answered), len(answered), len(true), len(orders)))
    return np.array(rows, float).reshape(-1, 4)


def compound_counts(results: Sequence[Mapping], kind: str, way: str, word: str) -> Counts:
    """Of each compound scene of a kind (or "all"): rightly predicted, predicted, true, ``(n, 3)``."""
    rows = []
    for result in results:
        for scene in result["scenes"] if result["kind"] == COMPOUND and kind in (result["of"], "all") else ():
            facts, true = ({tuple(fact) for fact in scene[key] if fact[0] == word} for key in (way, "true"))
            rows.append((len(facts & true), len(facts), len(true)))
    return np.array(rows, float).reshape(-1, 3)


def f1(counts: Counts) -> Counts:
    """2 right / (predicted + true) of counts ``(…, 3 or more)``; 0 where nothing is predicted nor true."""
    return 2 * counts[..., 0] / np.maximum(counts[..., 1] + counts[..., 2], 1)


def recall(counts: Counts) -> Counts:
    """Share of the true that is predicted."""
    return counts[..., 0] / np.maximum(counts[..., 2], 1)


def precision(counts: Counts) -> Counts:
    """Share of the predicted that is true."""
    return counts[..., 0] / np.maximum(counts[..., 1], 1)


def resampled(counts: Counts, statistic: Callable[[Counts], Counts], n: int) -> Estimate:
    """A statistic of summed counts, scenes resampled (percentiles); `n` counts its denominator."""
    if not len(counts) or n == 0:
        return UNMEASURED
    value, even = float(statistic(counts.sum(axis=0))), np.full(len(counts), 1 / len(counts))
    draws = stream(len(counts), "words resampled").multinomial(len(counts), even, size=RESAMPLES)
    low, high = np.quantile(statistic(draws @ counts), [0.025, 0.975])
    ends = (float(low), float(high)) if low < high else wilson(round(value * n), n)
    return Estimate(value, value, ends, n)


def f1_estimate(counts: Counts) -> Estimate:
    """F1 of `word_counts`; `n` counts the pairs for which the word is true."""
    return resampled(counts, f1, int(counts[:, 2].sum()))


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """F1 of the user's word and least F1 of the five; the other side; precision and recall of between and in."""
    found_answers = answers(settings, results)
    most = found_answers[str(settings["lessons"][-1])]
    learnt = {word: f1_estimate(word_counts(*most, word)) for word in WORDS}
    found = {f"f1_{USER_WORD}": learnt.pop(USER_WORD)}
    found["least_f1_of_the_five"] = min(learnt.values(), key=lambda score: score.value if score.n else 2.0)
    found |= side_measures(*most, found_answers[OTHER_SIDE][1])
    for word in COMPOUNDS:
        counts = compound_counts(results, "all", "thesis", word)
        for name, statistic, column in (("precision", precision, 1), ("recall", recall, 2)):
            found[f"{name}_{word}_thesis"] = resampled(counts, statistic, int(counts[:, column].sum()))
    return found


def side_measures(
    scenes: Sequence[Mapping], predictions: Sequence[PairsByWord], from_behind: Sequence[PairsByWord]
) -> dict[str, Estimate]:
    """By word how often a right prediction turns, or stays, from the other side; left and right together."""
    there = iter(from_behind)
    behind = {number: next(there) for number, scene in enumerate(scenes) if scene["other_side"]}
    counts = {word: turned_counts(scenes, predictions, behind, word) for word in WORDS}
    both = np.add(counts["left_of"], counts["right_of"])
    named = {f"{'turned' if word in VIEW_WORDS else 'stays'}_{word}": pair for word, pair in counts.items()}
    return {
        name: share_over_scenes(right[n > 0], n[n > 0])
        for name, (right, n) in {**named, "left_and_right_change_places": both}.items()
    }


def turned_counts(
    scenes: Sequence[Mapping], predictions: Sequence[PairsByWord], behind: Mapping[int, PairsByWord], word: str
) -> tuple[Counts, Counts]:
    """How often a word rightly predicted from the front is predicted as it must be from the other side.

    Words of view must change into their opposites; others must stay. Returns right answers and all, ``(scenes,)``.
    """
    must, right, n = OPPOSITE.get(word, word), [], []
    for number, there in behind.items():
        row = scenes[number]
        asked = pairs_by_word(row["truth"])[word] & predictions[number][word]
        asked &= {tuple(pair) for pair in row["other_side"]["pairs"]}
        asked &= pairs_by_word(row["other_side"]["truth"])[must]
        right.append(len((asked & there[must]) - (there[word] if must != word else set())))
        n.append(len(asked))
    return np.array(right, float), np.array(n, float)


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """Of each word and number of lessons the scores; of each kind of scene the counts of between and in."""
    found = []
    for learner, (scenes, predictions) in answers(settings, results).items():
        for word in WORDS:
            counts = word_counts(scenes, predictions, word)
            sums = zip(("right", "said", "true", "pairs"), counts.sum(axis=0).astype(int).tolist(), strict=True)
            found.append({"word": word, "lessons": learner, **dict(sums), "f1": f1_estimate(counts).to_dict()})
    for kind in KINDS:
        for word in COMPOUNDS:
            for way in WAYS:
                counts = compound_counts(results, kind, way, word).sum(axis=0).astype(int).tolist()
                sums = zip(("right", "said", "true"), counts, strict=True)
                found.append({"compound": word, "scenes": kind, "way": way, **dict(sums)})
    drawn = Counter(result["of"] for result in results if result["kind"] == COMPOUND for _ in result["scenes"])
    return [*found, {"compound_scenes": dict(drawn)}]
