"""Training of `TreeRelations`: rows in both orders, temperature calibrated on held-out scenes."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from numbers import Integral

import numpy as np
from numpy.typing import NDArray

from lifelore.core.errors import InputError
from lifelore.core.relations import PairLabel
from lifelore.perception.pairs import gap_rule
from lifelore.perception.pairs.directed_label import mirrored, pair_class
from lifelore.perception.pairs.pair_features import GEOMETRY_COLUMNS
from lifelore.perception.pairs.scene_pairs import ScenePairs
from lifelore.perception.trees.tree_ensemble import MOST_TREES, TreeEnsemble
from lifelore.perception.trees.tree_relations import (
    Shares,
    TreeRelations,
    Vocabulary,
    carried_columns,
    inner_symmetric,
    mean_of_both_orders,
    object_shares,
    table_rows,
)

FOLDS = 5
"""Folds of the scenes for calibration; more cost time."""
FEW_ROWS = 40
"""Number of rows below which leaves may hold a single row, so that few examples can be separated."""
TEMPERATURES = np.geomspace(0.3, 2.0, 39)


@dataclass(frozen=True)
class TreeSettings:
    """Settings of the extremely randomised trees.

    Parameters
    ----------
    n_trees, table_trees : int
        Trees for pairs of objects and for pairs with the table, 1 to `MOST_TREES`.
    min_leaf : int
        Least training rows in a leaf, at least 1.
    feature_share : float or "sqrt"
        Share of the columns tried at each split, in (0, 1].
    seed : int
        At least 0.

    Raises
    ------
    InputError
        A number breaks its rule.

    Examples
    --------
    >>> TreeSettings(n_trees=40).seed
    0
    """

    n_trees: int = 200
    table_trees: int = 100
    min_leaf: int = 2
    feature_share: float | str = "sqrt"
    seed: int = 0

    def __post_init__(self) -> None:
        for name, least, most in (
            ("n_trees", 1, MOST_TREES),
            ("table_trees", 1, MOST_TREES),
            ("min_leaf", 1, 2**31 - 1),
            ("seed", 0, 2**32 - 1),
        ):
            value = getattr(self, name)
            if isinstance(value, bool) or not isinstance(value, Integral) or not least <= int(value) <= most:
                raise InputError(f"{name} must be a whole number from {least} to {most}, got {value!r}")
        share = self.feature_share
        if share != "sqrt" and not (isinstance(share, float) and 0 < share <= 1):
            raise InputError(f"feature_share must be 'sqrt' or a share in (0, 1] such as 0.5, got {share!r}")


@dataclass(frozen=True, eq=False)
class TrainingRows:
    """Training rows, their classes, and the scene of each row."""

    matrix: NDArray[np.float64]
    classes: NDArray[np.str_]
    scene: NDArray[np.int64]


def fit_trees(
    scenes: Sequence[ScenePairs],
    truths: Sequence[Sequence[PairLabel]],
    vocabulary: Vocabulary,
    columns: Sequence[str],
    settings: TreeSettings,
    least_confidence: int,
) -> tuple[TreeRelations | None, TreeRelations | None]:
    """Models for pairs of objects and for pairs with the table; None where the truths have no such pair."""
    rows = _object_rows(scenes, truths, vocabulary, columns, least_confidence)
    objects, seen = None, [{} for _ in scenes]
    if len(rows.scene):
        objects = grow_trees(rows, columns, settings, settings.n_trees)
        held_out = _held_out(rows, columns, settings, len(scenes))
        objects = _calibrated(objects, held_out, rows, inner_symmetric(vocabulary.symmetric))
        seen = [
            object_shares(model or objects, scene, vocabulary.symmetric, vocabulary.adjacent_gap)
            for model, scene in zip(held_out, scenes, strict=True)
        ]
    return objects, _fit_table(scenes, truths, vocabulary, settings, least_confidence, seen)


def _object_rows(
    scenes: Sequence[ScenePairs],
    truths: Sequence[Sequence[PairLabel]],
    vocabulary: Vocabulary,
    columns: Sequence[str],
    least_confidence: int,
) -> TrainingRows:
    """Two rows for each labelled pair of objects: in both orders, each with its class."""
    symmetric = inner_symmetric(vocabulary.symmetric)
    matrix, classes, origin = [], [], []
    for number, (scene, truth) in enumerate(zip(scenes, truths, strict=True)):
        features = scene.features.columns(columns)
        for pair, (pair_labels, table) in enumerate(
            zip(scene.labels(truth, least_confidence), scene.with_table, strict=True)
        ):
            if table or not pair_labels:
                continue
            name = pair_class(pair_labels, int(scene.features.pairs[2 * pair, 0]), vocabulary.symmetric)
            if vocabulary.adjacent_gap is not None:
                name = gap_rule.inner_label(name, float(scene.features.gaps[2 * pair]), vocabulary.adjacent_gap)
            matrix += [features[2 * pair], features[2 * pair + 1]]
            classes += [name, mirrored(name, symmetric)]
            origin += [number, number]
    return TrainingRows(
        np.array(matrix).reshape(-1, len(columns)), np.array(classes, str), np.array(origin, np.int64)
    )


def grow_trees(rows: TrainingRows, columns: Sequence[str], settings: TreeSettings, n_trees: int) -> TreeRelations:
    """Trees over these rows, not calibrated."""
    few = len(rows.classes) < FEW_ROWS
    own = replace(settings, n_trees=n_trees, min_leaf=1 if few else settings.min_leaf)
    classes, trees = extra_trees(rows.matrix, rows.classes, own)
    return TreeRelations(classes, tuple(columns), trees)


def extra_trees(
    rows: NDArray[np.float64], classes: NDArray[np.str_], settings: TreeSettings
) -> tuple[tuple[str, ...], TreeEnsemble]:
    """The classes (sorted) and the `TreeSettings.n_trees` trees that scikit-learn trains on rows ``(n, d)``."""
    from sklearn.ensemble import ExtraTreesClassifier

    forest = ExtraTreesClassifier(
        n_estimators=settings.n_trees,
        min_samples_leaf=settings.min_leaf,
        max_features=settings.feature_share,  # type: ignore[arg-type]
        random_state=settings.seed,
    ).fit(rows, classes)
    return tuple(map(str, forest.classes_)), TreeEnsemble.from_forest(forest)


def _held_out(
    rows: TrainingRows, columns: Sequence[str], settings: TreeSettings, n_scenes: int
) -> list[TreeRelations | None]:
    """For each scene a model trained without it; None where there are too few scenes."""
    models: list[TreeRelations | None] = [None] * n_scenes
    if n_scenes < 2:
        return models
    folds = min(FOLDS, n_scenes)
    for fold in range(folds):
        kept = rows.scene % folds != fold
        if kept.any():
            part = TrainingRows(rows.matrix[kept], rows.classes[kept], rows.scene[kept])
            model = grow_trees(part, columns, settings, max(settings.n_trees // 2, 1))
            models[fold::folds] = [model] * len(models[fold::folds])
    return models


def _calibrated(
    model: TreeRelations, held_out: Sequence[TreeRelations | None], rows: TrainingRows, symmetric: frozenset[str]
) -> TreeRelations:
    """The model with the temperature of least log loss on the held-out scenes."""
    right = []
    for number in np.unique(rows.scene):
        one = held_out[number]
        if one is None:
            continue
        mine = rows.scene == number
        shares = mean_of_both_orders(one, rows.matrix[mine], symmetric)
        truth = rows.classes[mine][::2]
        for row, name in zip(shares, truth, strict=True):
            right.append((row, one.classes.index(str(name)) if str(name) in one.classes else None))
    temperature = best_temperature([(row, at) for row, at in right if at is not None])
    return TreeRelations(model.classes, model.columns, model.trees, temperature)


def best_temperature(answers: Sequence[tuple[NDArray[np.float64], int]]) -> float:
    """The temperature of least log loss over (shares, number of the true class); 1 for none."""
    if not answers:
        return 1.0
    loss = np.zeros(len(TEMPERATURES))
    for row, true in answers:
        # A true class without a vote would have infinite loss at any temperature.
        logs = np.log(np.maximum(row, 1e-3))[None] / TEMPERATURES[:, None]
        loss += np.log(np.exp(logs - logs[:, [true]]).sum(axis=1))
    return float(TEMPERATURES[loss.argmin()])


def _fit_table(
    scenes: Sequence[ScenePairs],
    truths: Sequence[Sequence[PairLabel]],
    vocabulary: Vocabulary,
    settings: TreeSettings,
    least_confidence: int,
    seen: Sequence[Shares],
) -> TreeRelations | None:
    columns = GEOMETRY_COLUMNS
    matrix, classes, origin = [], [], []
    for number, (scene, truth) in enumerate(zip(scenes, truths, strict=True)):
        at = np.flatnonzero(scene.with_table)
        rows = table_rows(scene, seen[number], vocabulary.names, vocabulary.symmetric, columns)
        labels = scene.labels(truth, least_confidence)
        for row, pair in zip(rows, at, strict=True):
            if labels[pair]:
                matrix.append(row)
                classes.append(
                    pair_class(labels[pair], int(scene.features.pairs[2 * pair, 0]), vocabulary.symmetric)
                )
                origin.append(number)
    if not matrix:
        return None
    rows = TrainingRows(np.array(matrix), np.array(classes, str), np.array(origin, np.int64))
    names = (*columns, *carried_columns(vocabulary.names, vocabulary.symmetric))
    return grow_trees(rows, names, settings, settings.table_trees)
