"""Which of a user's relations are symmetric: by what is known, what was written, or whether a direction shows."""

from collections.abc import Sequence

import numpy as np

from lifelore.core.relations import CORE_RELATIONS, SYMMETRIC, PairLabel
from lifelore.perception.pairs.pair_features import TURNING_COLUMNS, VIEW_COLUMNS
from lifelore.perception.pairs.scene_pairs import ScenePairs

FOLDS = 5
FEWEST = 10
"""Examples below which a name counts as directed: with fewer the trees may miss a direction that is there, and a
directed name taken for symmetric loses what it says."""
CHANCE = 1.64
"""Standard deviations above one half from which a direction shows: 5 % of symmetric names pass for directed."""


def symmetric_names(
    scenes: Sequence[ScenePairs],
    truths: Sequence[Sequence[PairLabel]],
    names: Sequence[str],
    least_confidence: int,
) -> frozenset[str]:
    """The symmetric ones of `names`.

    A core relation is what its definition says. Any other is symmetric if it was written of some pair both ways,
    or if trees that saw other scenes cannot tell (a, b) from (b, a) better than a coin.
    """
    sure = [[label for label in truth if label.confidence >= least_confidence] for truth in truths]
    return frozenset(
        name for name in names if _is_symmetric(name, _examples(scenes, truths, name, least_confidence), sure)
    )


def _examples(
    scenes: Sequence[ScenePairs], truths: Sequence[Sequence[PairLabel]], name: str, least_confidence: int
) -> tuple[np.ndarray, np.ndarray]:
    """Rows in the written and in the other order, ``(n, 2, d)``, and the scene of each, ``(n,)``."""
    rows, origin = [], []
    for number, (scene, truth) in enumerate(zip(scenes, truths, strict=True)):
        features = scene.features.columns((*TURNING_COLUMNS, *VIEW_COLUMNS))
        for pair, said in enumerate(scene.labels(truth, least_confidence)):
            for label in said:
                if label.relation == name and not scene.with_table[pair]:
                    turned = int(label.a != scene.features.pairs[2 * pair, 0])
                    rows.append(features[[2 * pair + turned, 2 * pair + 1 - turned]])
                    origin.append(number)
    return np.array(rows), np.array(origin, np.int64)


def _is_symmetric(name: str, known: tuple[np.ndarray, np.ndarray], truths: Sequence[Sequence[PairLabel]]) -> bool:
    if name in CORE_RELATIONS:
        return name in SYMMETRIC
    for truth in truths:
        written = {(label.a, label.b) for label in truth if label.relation == name}
        if any((b, a) in written for a, b in written):
            return True
    rows, scene = known
    if len(rows) < FEWEST or len(np.unique(scene)) < 2:
        return False
    return _told_apart(rows, scene) < len(rows) / 2 + CHANCE * np.sqrt(len(rows)) / 2


def _told_apart(rows: np.ndarray, scene: np.ndarray) -> int:
    """How many held-out pairs the trees put the right way round."""
    from lifelore.perception.trees.tree_classifier import TreeClassifier

    right = 0
    place = np.unique(scene, return_inverse=True)[1]
    folds = min(FOLDS, int(place.max()) + 1)
    for fold in range(folds):
        seen = place % folds != fold
        # All columns at every split: the direction may show in a single one.
        trees = TreeClassifier(50, feature_share=1.0).fit(
            rows[seen].reshape(-1, rows.shape[2]), np.tile([1, 0], seen.sum())
        )
        asked = rows[~seen]
        right += int((trees.predict_proba(asked[:, 0])[:, 1] > trees.predict_proba(asked[:, 1])[:, 1]).sum())
    return right
