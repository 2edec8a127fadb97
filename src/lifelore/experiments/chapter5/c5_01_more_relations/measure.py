"""Measures and rows of claim C5.1: F1 of learnt words, their change from the other side, compound relations."""

from collections import Counter
from collections.abc import Callable, Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from lifelore.core.metrics import Estimate
from lifelore.core.streams import stream
from lifelore.experiments.chapter2.scoring.relation_scoring import share_over_scenes, wilson
from lifelore.experiments.chapter5.c5_01_more_relations.run import COMPOUND, HELD_OUT, KINDS, LESSON, labels_of
from lifelore.experiments.chapter5.c5_01_more_relations.view_words import USER_WORD, VIEW_WORDS, WORDS
from lifelore.experiments.engine.estimates import UNMEASURED
from lifelore.experiments.engine.results_table import computed_once
from lifelore.perception.pairs.pair_features import COLUMNS, PairFeatures
from lifelore.perception.pairs.scene_pairs import ScenePairs
from lifelore.perception.relations.relation_classifier import RelationClassifier

OPPOSITE = {"left_of": "right_of", "right_of": "left_of", "behind": "in_front_of", "in_front_of": "behind"}
"""The word of view that holds, for the same order of the pair, from the other side."""
RESAMPLES = 1000
COMPOUNDS = ("between", "in")
WAYS = ("thesis", "thesis_perceived", "lifelore")
RULE, OTHER_SIDE = "rule", "other side"
"""The definitions of the words applied to visible points, a baseline; and scenes seen from the other side."""
Ordered = tuple[int, int]
PairsByWord = dict[str, frozenset[Ordered]]
"""By word the ordered pairs of a scene for which it holds."""
Answers = tuple[list[dict], list[PairsByWord]]
"""Scenes, and the predicted words of each."""


@computed_once
def answers(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Answers]:
    """Held-out scenes and predictions by number of lessons (as text), by the `RULE`, and from the `OTHER_SIDE`.

    From the other side the model of the most lessons predicts.
    """
    lessons, scenes = (
        [scene for result in results if result["kind"] == kind for scene in result["scenes"]]
        for kind in (LESSON, HELD_OUT)
    )
    found: dict[str, Answers] = {RULE: (scenes, [pairs_by_word(scene["by_rule"]) for scene in scenes])}
    for n in settings["lessons"]:
        model = RelationClassifier(multi_label=True)
        model.fit_pairs([scene_of(one) for one in lessons[:n]], [labels_of(one["truth"]) for one in lessons[:n]])
        found[str(n)] = scenes, [predicted(model, scene) for scene in scenes]
        if n == settings["lessons"][-1]:
            behind = [scene["other_side"] for scene in scenes if scene["other_side"]]
            found[OTHER_SIDE] = behind, [predicted(model, scene) for scene in behind]
    return found


def scene_of(row: Mapping) -> ScenePairs:
    """A scene's row as the classifier sees a scene."""
    matrix = np.array(row["features"], float).reshape(-1, len(COLUMNS))
    pairs = np.array(row["pairs"], np.int64).reshape(-1, 2)
    return ScenePairs(PairFeatures(COLUMNS, matrix, pairs, np.array(row["gaps"], float)), ())


def predicted(model: RelationClassifier, row: Mapping) -> PairsByWord:
    """The words that the model predicts for a scene; symmetric words in both orders."""
    found: dict[str, set[Ordered]] = {word: set() for word in WORDS}
    for relation in model.predict_pairs(scene_of(row)) if row["pairs"] else ():
        if relation.relation in found:
            found[relation.relation].add((relation.a, relation.b))
            if relation.relation in model.symmetric:
                found[relation.relation].add((relation.b, relation.a))
    return {word: frozenset(pairs) for word, pairs in found.items()}


def pairs_by_word(rows: Sequence[Sequence]) -> PairsByWord:
    """Rows ``[a, b, word]`` by word."""
    return {word: frozenset((a, b) for a, b, name in rows if name == word) for word in WORDS}


# --- counts and scores ------------------------------------------------------------------------------------


def word_counts(scenes: Sequence[Mapping], predictions: Sequence[PairsByWord], word: str) -> NDArray[np.float64]:
    """Of each scene the ordered pairs with the word rightly predicted, predicted, true; and all, ``(n, 4)``."""
    rows = []
    for row, words in zip(scenes, predictions, strict=True):
        orders = {order for a, b in row["labelled"] for order in ((a, b), (b, a))}
        true, answers = pairs_by_word(row["truth"])[word], words[word] & orders
        rows.append((len(true & answers), len(answers), len(true), len(orders)))
    return np.array(rows, float).reshape(-1, 4)


def compound_counts(results: Sequence[Mapping], kind: str, way: str, word: str) -> NDArray[np.float64]:
    """Of each compound scene of a kind (or "all"): rightly predicted, predicted, true, ``(n, 3)``."""
    rows = []
    for result in results:
        if result["kind"] == COMPOUND and kind in (result["of"], "all"):
            for scene in result["scenes"]:
                facts, true = ({tuple(fact) for fact in scene[key] if fact[0] == word} for key in (way, "true"))
                rows.append((len(facts & true), len(facts), len(true)))
    return np.array(rows, float).reshape(-1, 3)


def f1(counts: NDArray[np.float64]) -> NDArray[np.float64]:
    """2 right / (predicted + true) of counts ``(…, 3 or more)``; 0 where nothing is predicted nor true."""
    return 2 * counts[..., 0] / np.maximum(counts[..., 1] + counts[..., 2], 1)


def recall(counts: NDArray[np.float64]) -> NDArray[np.float64]:
    """Share of the true that is predicted."""
    return counts[..., 0] / np.maximum(counts[..., 2], 1)


def precision(counts: NDArray[np.float64]) -> NDArray[np.float64]:
    """Share of the predicted that is true."""
    return counts[..., 0] / np.maximum(counts[..., 1], 1)


def resampled(
    counts: NDArray[np.float64], statistic: Callable[[NDArray[np.float64]], NDArray[np.float64]], n: int
) -> Estimate:
    """A statistic of summed counts, scenes resampled (percentiles); `n` counts its denominator."""
    if not len(counts) or n == 0:
        return UNMEASURED
    value = float(statistic(counts.sum(axis=0)))
    draws = stream(len(counts), "words resampled").multinomial(
        len(counts), np.full(len(counts), 1 / len(counts)), size=RESAMPLES
    )
    low, high = np.quantile(statistic(draws @ counts), [0.025, 0.975])
    ends = (float(low), float(high)) if low < high else wilson(round(value * n), n)
    return Estimate(value, value, ends, n)


def f1_estimate(counts: NDArray[np.float64]) -> Estimate:
    """F1 of `word_counts`; `n` counts the pairs for which the word is true."""
    return resampled(counts, f1, int(counts[:, 2].sum()))


# --- measures ---------------------------------------------------------------------------------------------


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
    found = {
        f"{'turned' if word in VIEW_WORDS else 'stays'}_{word}": _share_of_asked(*pair)
        for word, pair in counts.items()
    }
    both = (left + right for left, right in zip(counts["left_of"], counts["right_of"], strict=True))
    return found | {"left_and_right_change_places": _share_of_asked(*both)}


def turned_counts(
    scenes: Sequence[Mapping], predictions: Sequence[PairsByWord], behind: Mapping[int, PairsByWord], word: str
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """How often a word rightly predicted from the front is predicted as it must be from the other side.

    Returns
    -------
    kept, n : (scenes,) float64
        Words of view must change into their opposites; others must stay.
    """
    kept, n = [], []
    for number, (row, words) in enumerate(zip(scenes, predictions, strict=True)):
        if number not in behind:
            continue
        near = {tuple(pair) for pair in row["other_side"]["pairs"]}
        true_there, there = pairs_by_word(row["other_side"]["truth"]), behind[number]
        must = OPPOSITE.get(word, word)
        right = pairs_by_word(row["truth"])[word] & words[word]
        orders = [order for order in right if order in near and order in true_there[must]]
        kept.append(sum(o in there[must] and (must == word or o not in there[word]) for o in orders))
        n.append(len(orders))
    return np.array(kept, float), np.array(n, float)


def _share_of_asked(kept: NDArray[np.float64], n: NDArray[np.float64]) -> Estimate:
    return share_over_scenes(kept[n > 0], n[n > 0])


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """Of each word and number of lessons the scores; of each kind of scene the counts of between and in."""
    found = []
    for learner, (scenes, predictions) in answers(settings, results).items():
        for word in WORDS:
            counts = word_counts(scenes, predictions, word)
            right, yes, true, pairs = counts.sum(axis=0).astype(int).tolist()
            line = {"word": word, "lessons": learner, "right": right, "said": yes, "true": true, "pairs": pairs}
            found.append(line | {"f1": f1_estimate(counts).to_dict()})
    for kind in KINDS:
        for word in COMPOUNDS:
            for way in WAYS:
                right, yes, true = compound_counts(results, kind, way, word).sum(axis=0).astype(int).tolist()
                line = {"compound": word, "scenes": kind, "way": way, "right": right}
                found.append(line | {"said": yes, "true": true})
    drawn = Counter(result["of"] for result in results if result["kind"] == COMPOUND for _ in result["scenes"])
    return [*found, {"compound_scenes": dict(drawn)}]
