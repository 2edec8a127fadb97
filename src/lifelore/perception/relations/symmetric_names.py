"""Symmetric relations among a user's names: by definition, by labels in both orders, or by a test on features."""

from collections.abc import Sequence

import numpy as np

from lifelore.core.errors import InputError
from lifelore.core.relations import CORE_RELATIONS, SYMMETRIC, PairLabel
from lifelore.perception.pairs.pair_features import TURNING_COLUMNS, VIEW_COLUMNS
from lifelore.perception.pairs.scene_pairs import ScenePairs
from lifelore.perception.trees.tree_training import TreeSettings, extra_trees

FOLDS = 5
DIRECTION_TREES = TreeSettings(n_trees=50, feature_share=1.0)
"""All columns are tried at every split, because a single one may show the direction."""
FEWEST = 10
"""Least number of examples for the test; with fewer a name counts as directed, because the trees may miss its
direction."""
CHANCE = 1.64
"""Standard deviations above one half that count as a direction: 5 % of symmetric names pass for directed."""


def symmetric_names(
    scenes: Sequence[ScenePairs],
    truths: Sequence[Sequence[PairLabel]],
    names: Sequence[str],
    least_confidence: int,
) -> frozenset[str]:
    """The symmetric ones of `names`.

    A core relation follows its definition. Any other is symmetric if some pair is labelled in both orders, or if
    trees trained on other scenes cannot distinguish (a, b) from (b, a) better than chance.
    """
    sure = [[label for label in truth if label.confidence >= least_confidence] for truth in truths]
    return frozenset(
        name for name in names if _is_symmetric(name, _examples(scenes, truths, name, least_confidence), sure)
    )


def check_directions(
    truths: Sequence[Sequence[PairLabel]], symmetric: frozenset[str], least_confidence: int
) -> None:
    """Refuse a pair that is labelled in both directions with a name that is not symmetric.

    Raises
    ------
    InputError
        The message names the pair.
    """
    for truth in truths:
        written = {(label.relation, label.a, label.b) for label in truth if label.confidence >= least_confidence}
        for name, a, b in sorted(written):
            if name not in symmetric and (name, b, a) in written:
                raise InputError(
                    f"truths must not state {name}({a}, {b}) and {name}({b}, {a}), as {name} is not symmetric:"
                    " declare it symmetric, or leave one of the two out"
                )


def _examples(
    scenes: Sequence[ScenePairs], truths: Sequence[Sequence[PairLabel]], name: str, least_confidence: int
) -> tuple[np.ndarray, np.ndarray]:
    """Rows in the written and in the other order, ``(n, 2, d)``, and the scene of each, ``(n,)``."""
    rows, origin = [], []
    for number, (scene, truth) in enumerate(zip(scenes, truths, strict=True)):
        features = scene.features.columns((*TURNING_COLUMNS, *VIEW_COLUMNS))
        for pair, pair_labels in enumerate(scene.labels(truth, least_confidence)):
            for label in pair_labels:
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
    return _right_directions(rows, scene) < len(rows) / 2 + CHANCE * np.sqrt(len(rows)) / 2


def _right_directions(rows: np.ndarray, scene: np.ndarray) -> int:
    """Number of held-out pairs whose direction the trees predict right."""
    right = 0
    place = np.unique(scene, return_inverse=True)[1]
    folds = min(FOLDS, int(place.max()) + 1)
    for fold in range(folds):
        seen = place % folds != fold
        _, trees = extra_trees(
            rows[seen].reshape(-1, rows.shape[2]), np.tile(["written", "turned"], seen.sum()), DIRECTION_TREES
        )
        held_out = rows[~seen]
        written, turned = (trees.predict_proba(held_out[:, order])[:, 1] for order in (0, 1))
        right += int((written > turned).sum())
    return right
