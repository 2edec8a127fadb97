"""Measures and rows of claim C5.1."""

import json
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from lifelore.core.metrics import Estimate, ratio_estimate
from lifelore.core.streams import stream
from lifelore.experiments.chapter2.relation_scoring import wilson
from lifelore.experiments.chapter5.c5_01_more_relations.run import COMPOUND, HELD_OUT, KINDS, LESSON, labels_of
from lifelore.experiments.chapter5.c5_01_more_relations.view_words import USER_WORD, VIEW_WORDS, WORDS
from lifelore.experiments.engine.cell_store import canonical
from lifelore.experiments.engine.estimates import UNMEASURED
from lifelore.perception.pairs.pair_features import COLUMNS, PairFeatures
from lifelore.perception.pairs.scene_pairs import ScenePairs
from lifelore.perception.relations.relation_classifier import RelationClassifier

OPPOSITE = {"left_of": "right_of", "right_of": "left_of", "behind": "in_front_of", "in_front_of": "behind"}
"""What a word of view becomes, for the same order of the pair, from the other side."""
RESAMPLES = 1000
COMPOUNDS = ("between", "in")
WAYS = ("thesis", "thesis_perceived", "lifelore")
RULE = "rule"
"""The definitions themselves, asked of visible points: a peer that was told what the words mean."""
Ordered = tuple[int, int]
Said = dict[str, frozenset[Ordered]]
"""By word the ordered pairs of a scene that it holds of."""


def scene_of(row: Mapping) -> ScenePairs:
    """A scene's row as the classifier sees a scene."""
    matrix = np.array(row["features"], float).reshape(-1, len(COLUMNS))
    pairs = np.array(row["pairs"], np.int64).reshape(-1, 2)
    return ScenePairs(PairFeatures(COLUMNS, matrix, pairs, np.array(row["gaps"], float)), ())


def taught(lessons: Sequence[Mapping]) -> RelationClassifier:
    """The words of these scenes, each learnt by itself."""
    model = RelationClassifier(multi_label=True)
    return model.fit_pairs([scene_of(one) for one in lessons], [labels_of(one["truth"]) for one in lessons])


def said_by(model: RelationClassifier, row: Mapping) -> Said:
    """What the model says of a scene."""
    found: dict[str, set[Ordered]] = {word: set() for word in WORDS}
    for relation in model.predict_pairs(scene_of(row)) if row["pairs"] else ():
        if relation.relation in found:
            found[relation.relation].add((relation.a, relation.b))
            if relation.relation in model.symmetric:
                found[relation.relation].add((relation.b, relation.a))
    return {word: frozenset(pairs) for word, pairs in found.items()}


def said_in(rows: Sequence[Sequence]) -> Said:
    """What rows ``[a, b, word]`` say."""
    return {word: frozenset((a, b) for a, b, name in rows if name == word) for word in WORDS}


def both_orders(row: Mapping) -> list[Ordered]:
    """Every labelled pair of a scene in both orders."""
    return [order for a, b in row["labelled"] for order in ((a, b), (b, a))]


def word_counts(scenes: Sequence[Mapping], told: Sequence[Said], word: str) -> NDArray[np.float64]:
    """Of each scene: right yes, said yes, true yes, right answers, ordered pairs, ``(n, 5)``."""
    rows = []
    for row, said in zip(scenes, told, strict=True):
        true, orders = said_in(row["truth"])[word], both_orders(row)
        answers = said[word] & set(orders)
        right = sum((order in true) == (order in answers) for order in orders)
        rows.append((len(true & answers), len(answers), len(true), right, len(orders)))
    return np.array(rows, float).reshape(-1, 5)


def f1(counts: NDArray[np.float64]) -> NDArray[np.float64]:
    """2 right / (said + true) of counts ``(…, 5)``; 0 where nothing is said nor true."""
    return 2 * counts[..., 0] / np.maximum(counts[..., 1] + counts[..., 2], 1)


def recall(counts: NDArray[np.float64]) -> NDArray[np.float64]:
    """Right yes of true yes."""
    return counts[..., 0] / np.maximum(counts[..., 2], 1)


def precision(counts: NDArray[np.float64]) -> NDArray[np.float64]:
    """Right yes of said yes."""
    return counts[..., 0] / np.maximum(counts[..., 1], 1)


def accuracy(counts: NDArray[np.float64]) -> NDArray[np.float64]:
    """Right answers of all ordered pairs."""
    return counts[..., 3] / np.maximum(counts[..., 4], 1)


def resampled(
    counts: NDArray[np.float64], statistic: Callable[[NDArray[np.float64]], NDArray[np.float64]], n: int
) -> Estimate:
    """A statistic of summed counts, scenes resampled (percentiles); `n` is what it is a share of."""
    if not len(counts) or n == 0:
        return UNMEASURED
    value = float(statistic(counts.sum(axis=0)))
    draws = stream(len(counts), "words resampled").multinomial(
        len(counts), np.full(len(counts), 1 / len(counts)), size=RESAMPLES
    )
    low, high = np.quantile(statistic(draws @ counts), [0.025, 0.975])
    ends = (float(low), float(high)) if low < high else None
    return Estimate(value, value, ends or _of_one_kind(value, n), n)


def _of_one_kind(value: float, n: int) -> tuple[float, float]:
    """Wilson's interval where all scenes agree."""
    return wilson(round(value * n), n)


@lru_cache(maxsize=2)
def _told(lessons: tuple[int, ...], results: str) -> dict[str, tuple[list[dict], list[Said]]]:
    """Held-out scenes and what is said of them, by the number learnt from (as text), and by the rule.

    With ``"other side"``, the scenes and answers from there after the most lessons. Kept, since measures and
    rows ask.
    """
    read = json.loads(results)
    learnt = [scene for r in read if r["kind"] == LESSON for scene in r["scenes"]]
    scenes = [scene for r in read if r["kind"] == HELD_OUT for scene in r["scenes"]]
    found: dict[str, tuple[list[dict], list[Said]]] = {RULE: (scenes, [said_in(one["by_rule"]) for one in scenes])}
    for n in lessons:
        model = taught(learnt[:n])
        found[str(n)] = scenes, [said_by(model, one) for one in scenes]
        if n == lessons[-1]:
            behind = [one["other_side"] for one in scenes if one["other_side"]]
            found["other side"] = behind, [said_by(model, one) for one in behind]
    return found


def _words(settings: Mapping, results: Sequence[Mapping]) -> dict[str, tuple[list[dict], list[Said]]]:
    return _told(tuple(settings["lessons"]), canonical(list(results)))


def turned_counts(
    scenes: Sequence[Mapping], told: Sequence[Said], behind: Mapping[int, Said], word: str
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """How often a word that was rightly said from the front is said as it must be from the other side.

    Returns
    -------
    kept, n : (scenes,) float64
        Words of view must change into their opposites and leave; others must stay.
    """
    kept, n = [], []
    for number, (row, said) in enumerate(zip(scenes, told, strict=True)):
        if number not in behind:
            continue
        asked = {tuple(pair) for pair in row["other_side"]["pairs"]}
        true_there = said_in(row["other_side"]["truth"])
        must = OPPOSITE.get(word, word)
        orders = [o for o in said_in(row["truth"])[word] & said[word] if o in asked and o in true_there[must]]
        there = behind[number]
        kept.append(sum(o in there[must] and (must == word or o not in there[word]) for o in orders))
        n.append(len(orders))
    return np.array(kept, float), np.array(n, float)


def _share(kept: NDArray[np.float64], n: NDArray[np.float64]) -> Estimate:
    """Share over scenes, scenes resampled; Wilson's interval where all agree."""
    asked = n > 0
    if not asked.any():
        return UNMEASURED
    found = ratio_estimate(kept[asked], n[asked])
    total, right = int(n.sum()), int(kept.sum())
    interval = found.ci95 if 0 < right < total else None
    return Estimate(found.value, found.median, interval or wilson(right, total), total)


def compound_counts(results: Sequence[Mapping], kind: str, way: str, word: str) -> NDArray[np.float64]:
    """Of each scene: right, said, true, two zeros: as `word_counts`, where nobody counts what is neither."""
    rows = []
    for result in results:
        if result["kind"] == COMPOUND and kind in (result["of"], "all"):
            for scene in result["scenes"]:
                said, true = ({tuple(fact) for fact in scene[key] if fact[0] == word} for key in (way, "true"))
                rows.append((len(said & true), len(said), len(true), 0, 0))
    return np.array(rows, float).reshape(-1, 5)


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """Of each word accuracy, F1, recall and precision; the least F1; the other side; between and in."""
    told = _words(settings, results)
    most = str(settings["lessons"][-1])
    found: dict[str, Estimate] = {}
    for word in WORDS:
        found |= _word_measures(word_counts(*told[most], word), word)
        found[f"f1_of_the_rule_{word}"] = _f1_estimate(word_counts(*told[RULE], word))
    learnt = [found[f"f1_{word}"] for word in WORDS if word != USER_WORD]
    found["least_f1_of_the_five"] = min(learnt, key=lambda one: one.value if one.n else 2.0)
    found |= _side_measures(told, most)
    for word in COMPOUNDS:
        for way in WAYS:
            counts = compound_counts(results, "all", way, word)
            said, true = (int(counts[:, column].sum()) for column in (1, 2))
            found[f"precision_{word}_{way}"] = resampled(counts, precision, said)
            found[f"recall_{word}_{way}"] = resampled(counts, recall, true)
    return found


def _f1_estimate(counts: NDArray[np.float64]) -> Estimate:
    return resampled(counts, f1, int(counts[:, 2].sum())) if len(counts) else UNMEASURED


def _word_measures(counts: NDArray[np.float64], word: str) -> dict[str, Estimate]:
    _, said, true, _, pairs = counts.sum(axis=0).astype(int)
    never = 1 - true / max(pairs, 1)
    return {
        f"accuracy_{word}": resampled(counts, accuracy, int(pairs)),
        f"accuracy_of_never_{word}": Estimate(never, never, None, int(pairs)),
        f"f1_{word}": _f1_estimate(counts),
        f"recall_{word}": resampled(counts, recall, int(true)),
        f"precision_{word}": resampled(counts, precision, int(said)),
    }


def _side_measures(told: Mapping[str, tuple[list[dict], list[Said]]], most: str) -> dict[str, Estimate]:
    scenes, said = told[most]
    there = iter(told["other side"][1])
    behind = {number: next(there) for number, one in enumerate(scenes) if one["other_side"]}
    found, of_view = {}, []
    for word in WORDS:
        kept, n = turned_counts(scenes, said, behind, word)
        found[f"{'turned' if word in VIEW_WORDS else 'stays'}_{word}"] = _share(kept, n)
        if word in ("left_of", "right_of"):
            of_view.append((kept, n))
    (kept_left, n_left), (kept_right, n_right) = of_view
    found["left_and_right_change_places"] = _share(kept_left + kept_right, n_left + n_right)
    for word in WORDS:
        found[f"f1_from_the_other_side_{word}"] = _f1_estimate(word_counts(*told["other side"], word))
    return found


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """Of each word and number of lessons the scores; of each kind of scene what between and in counted."""
    found = []
    for who, (scenes, said) in _words(settings, results).items():
        for word in WORDS:
            counts = word_counts(scenes, said, word)
            right, yes, true, _, pairs = counts.sum(axis=0).astype(int).tolist() if len(counts) else [0] * 5
            line = {"word": word, "lessons": who, "right": right, "said": yes, "true": true, "pairs": pairs}
            found.append(line | {"f1": _f1_estimate(counts).to_dict()})
    for kind in KINDS:
        for word in COMPOUNDS:
            for way in WAYS:
                counts = compound_counts(results, kind, way, word).sum(axis=0).astype(int).tolist()
                line = {"compound": word, "scenes": kind, "way": way, "right": counts[0]}
                found.append(line | {"said": counts[1], "true": counts[2]})
    drawn = Counter(r["of"] for r in results if r["kind"] == COMPOUND for _ in r["scenes"])
    return [*found, {"compound_scenes": dict(drawn)}]
