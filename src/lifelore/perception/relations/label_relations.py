"""Multi-label relations: one yes-or-no model per label, for every ordered pair.

*under*, *left_of* and *in_front_of* are learned like any other name; none is built in. View-dependent names need a
camera in the clouds.
"""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from lifelore.core.relations import NONE, PairLabel
from lifelore.perception.pairs.directed_label import REVERSED, as_directed, mirrored
from lifelore.perception.pairs.scene_pairs import ScenePairs
from lifelore.perception.trees.tree_relations import TreeRelations, Vocabulary
from lifelore.perception.trees.tree_training import TrainingRows, TreeSettings, grow_trees

NO, YES = "0", "1"
ON_TABLE = "with table: "
FEATURE_SHARE = 0.5
"""Share of columns tried at each split; large, because one column may decide (*left_of*: "right")."""


def fit_labels(
    scenes: Sequence[ScenePairs],
    truths: Sequence[Sequence[PairLabel]],
    vocabulary: Vocabulary,
    columns: Sequence[str],
    settings: TreeSettings,
    least_confidence: int,
) -> dict[str, TreeRelations]:
    """A yes-or-no model for each name except *none*, from both orders of every labelled pair.

    Pairs of objects and pairs with the table have separate models; the latter are named `ON_TABLE` + name. They
    use the order (object, table) alone, so a label with the table first has its own model, named `ON_TABLE` +
    ``~`` + name.
    """
    rows: dict[bool, list[tuple[NDArray[np.float64], frozenset[str], int]]] = {False: [], True: []}
    for number, (scene, truth) in enumerate(zip(scenes, truths, strict=True)):
        features = scene.features.columns(columns)
        for pair, pair_labels in enumerate(scene.labels(truth, least_confidence)):
            for row in _rows_of(scene, pair) if pair_labels else ():
                holds = _names_in_order(pair_labels, int(scene.features.pairs[row, 0]), vocabulary.symmetric)
                rows[bool(scene.with_table[pair])].append((features[row], holds, number))
    settings = replace(settings, feature_share=FEATURE_SHARE)
    return {
        prefix + name: grow_trees(_yes_and_no(rows[table], name), columns, settings, settings.n_trees)
        for table, prefix in ((False, ""), (True, ON_TABLE))
        for name in (*vocabulary.names, *(_turned(rows[True]) if table else ()))
        if name != NONE and rows[table]
    }


def _yes_and_no(rows: Sequence[tuple[NDArray[np.float64], frozenset[str], int]], name: str) -> TrainingRows:
    matrix, pair_labels, origin = zip(*rows, strict=True)
    holds = np.array([YES if name in names else NO for names in pair_labels])
    return TrainingRows(np.array(matrix), holds, np.array(origin, np.int64))


def _turned(rows: Sequence[tuple[NDArray[np.float64], frozenset[str], int]]) -> list[str]:
    """Names that hold in the other order for some row, sorted."""
    return sorted(
        {name for _, names, _ in rows for name in names if name.startswith(REVERSED)} - {REVERSED + NONE}
    )


def _rows_of(scene: ScenePairs, pair: int) -> tuple[int, ...]:
    """The feature rows of a pair: both orders among objects, (object, table) with the table."""
    return (2 * pair,) if scene.with_table[pair] else (2 * pair, 2 * pair + 1)


def _names_in_order(pair_labels: Sequence[PairLabel], first: int, symmetric: frozenset[str]) -> frozenset[str]:
    """Names that hold for the pair in the order that starts with `first`; ``~`` marks the other order."""
    return frozenset(as_directed(label, first, symmetric) for label in pair_labels)


def label_shares(
    models: Mapping[str, TreeRelations], scene: ScenePairs, symmetric: frozenset[str]
) -> list[dict[str, float]]:
    """Probability of each name for each pair; ``~`` marks the other order, symmetric names stand once."""
    found: list[dict[str, float]] = [{} for _ in scene.with_table]
    for key, model in models.items():
        name, table = key.removeprefix(ON_TABLE), key.startswith(ON_TABLE)
        rows = model.shares(scene.features.columns(model.columns))
        yes = rows[:, model.classes.index(YES)] if YES in model.classes else np.zeros(len(rows))
        for pair in np.flatnonzero(scene.with_table == table):
            forward, backward = float(yes[2 * pair]), float(yes[2 * pair + 1])
            if table:
                found[pair][name] = forward
            elif name in symmetric:
                found[pair][name] = (forward + backward) / 2
            else:
                found[pair][name], found[pair][REVERSED + name] = forward, backward
    return found


def stated_names(shares: Mapping[str, float], symmetric: Collection[str]) -> tuple[str, ...]:
    """The names that hold of a pair: a share of at least 0.5, and of two opposite directions the likelier.

    A name that is not symmetric holds in one direction at most; with equal shares it is the written order.

    Examples
    --------
    >>> stated_names({"under": 0.6, "~under": 0.7, "near": 0.9, "left_of": 0.2}, {"near"})
    ('~under', 'near')
    """
    stated = []
    for name, share in shares.items():
        turned = mirrored(name, symmetric)
        other = shares.get(turned, 0.0) if turned != name else 0.0
        loses = share < other or (share == other and name.startswith(REVERSED))
        if share >= 0.5 and not loses:
            stated.append(name)
    return tuple(stated)
