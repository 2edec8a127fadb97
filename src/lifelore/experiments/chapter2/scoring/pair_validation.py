"""Cross-validation of pairs: by the thesis's nearest neighbours with A and B given, and by any relation model.

The thesis gave each picture's two objects an order; a robot has to infer the order. This module does both. No pair
is ever classified by a model that saw its scene. Thesis: §2.3.5, §2.4.1.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.distance import cdist

from lifelore.core.relations import ADJACENT, BOTH, CORE_RELATIONS, NONE, ON, PairLabel
from lifelore.experiments.chapter2.scenes.tabletop_pairs import STANDARD, Row
from lifelore.experiments.chapter2.scoring.relation_scoring import BESIDE, CARRIED, JudgedPair
from lifelore.perception.pairs.pair_features import PairFeatures, column_names
from lifelore.perception.pairs.scene_pairs import ScenePairs
from lifelore.perception.peers.peer import DescribedPair
from lifelore.perception.relations.relation import Relation

THRESHOLD = 7
"""Fewest support vectors of a contact, as the thesis used (§2.3.4)."""
DROPS = ("all but one", "weak")
"""Which contacts are dropped: those below `THRESHOLD` except an object's strongest, or all below it."""
WEIGHTS = ("equal", "inverse distance")
BLOCK = 4_000_000
"""Distances held at a time: without the threshold there are tens of thousands of displacements."""


@dataclass(frozen=True)
class Reading:
    """The choices that the thesis leaves open between a picture and its vote.

    Parameters
    ----------
    kernel : str
        A name of `tabletop_pairs.KERNELS`.
    drop : str
        One of `DROPS`.
    votes : str
        One of `WEIGHTS`; of equal votes the first relation by name wins.
    omega : float, optional
        Longer displacements do not vote, metres.
    k : int
    """

    kernel: str = STANDARD
    drop: str = "all but one"
    votes: str = "equal"
    omega: float | None = None
    k: int = 4


def displacements(row: Row, kernel: str = STANDARD, drop: str = "all but one") -> NDArray[np.float64]:
    """χ_a - χ_b between all contacts of a row in the truth's order, ``(m, 3)``, metres; none for far pairs."""
    if row["gap"] is None:
        return np.empty((0, 3))
    sides = row["contacts"][kernel]
    first, second = (np.array(_kept(sides[side], drop)).reshape(-1, 4)[:, :3] for side in ("a", "b"))
    moved = (first[:, None] - second[None]).reshape(-1, 3)
    return moved if row["a"] == row["pair"][0] else -moved


def _kept(contacts: Sequence[Sequence[float]], drop: str) -> list:
    strong = [contact for contact in contacts if contact[3] >= THRESHOLD]
    return strong or (list(contacts[:1]) if drop == "all but one" else [])


@dataclass(frozen=True, eq=False)
class Votes:
    """The votes of neighbours on displacements.

    Parameters
    ----------
    row : (m,) int64
        The row each displacement is of.
    labels : (m,) str
        The relation that won.
    shares : (m, 4) float64
        Share of the votes for each of `CORE_RELATIONS`; zeros where there is no neighbour.
    """

    row: NDArray[np.int64]
    labels: NDArray[np.str_]
    shares: NDArray[np.float64]

    def relations(self, n_rows: int) -> list[str]:
        """The union of the labels of each row's displacements; *none* where there is none."""
        found: list[set[str]] = [set() for _ in range(n_rows)]
        for row, label in zip(self.row.tolist(), self.labels.tolist(), strict=True):
            found[row].add(label)
        return [united(labels) for labels in found]


def united(labels: set[str]) -> str:
    """*on* and *adjacent* together are *both*; *none* adds nothing.

    Examples
    --------
    >>> united({"on", "adjacent"}), united({"none", "on"}), united(set())
    ('both', 'on', 'none')
    """
    on, adjacent = bool(labels & CARRIED), bool(labels & BESIDE)
    return {(True, True): BOTH, (True, False): ON, (False, True): ADJACENT, (False, False): NONE}[on, adjacent]


def votes_of_neighbours(
    rows: Sequence[Row], reading: Reading = Reading(), train: NDArray[np.bool_] | None = None
) -> Votes:
    """The k nearest displacements of other scenes vote on each displacement, A and B given.

    Parameters
    ----------
    train : (len(rows),) bool, optional
        Rows to learn from; only the others are classified. Default: leave one scene out.
    """
    each = [displacements(row, reading.kernel, reading.drop) for row in rows]
    owner = np.repeat(np.arange(len(rows)), [len(one) for one in each])
    return votes_on(np.concatenate(each), owner, rows, reading, train)


def votes_on(
    moved: NDArray[np.float64],
    owner: NDArray[np.int64],
    rows: Sequence[Row],
    reading: Reading,
    train: NDArray[np.bool_] | None = None,
) -> Votes:
    """As `votes_of_neighbours`, from displacements ``(m, 3)`` and the row of each."""
    scene = np.unique([row["scene"] for row in rows], return_inverse=True)[1][owner]
    code = np.array([CORE_RELATIONS.index(row["relation"]) for row in rows])[owner]
    known = np.ones(len(moved), bool) if train is None else train[owner]
    if reading.omega is not None:
        known &= np.linalg.norm(moved, axis=1) <= reading.omega
    asked = np.flatnonzero(np.full(len(moved), True) if train is None else ~train[owner])
    nearest, away = _nearest(moved, asked, scene, known, reading.k)
    weight = np.isfinite(away).astype(float)
    if reading.votes != "equal":
        weight /= np.maximum(away, 1e-9)
    shares = np.zeros((len(asked), len(CORE_RELATIONS)))
    np.add.at(shares, (np.arange(len(asked))[:, None], code[nearest]), weight)
    shares /= np.maximum(shares.sum(axis=1, keepdims=True), 1e-300)
    order = np.argsort(CORE_RELATIONS)
    winner = order[shares[:, order].argmax(axis=1)]
    labels = np.where(shares.any(axis=1), np.array(CORE_RELATIONS)[winner], NONE)
    return Votes(owner[asked], labels, shares)


def _nearest(
    moved: NDArray[np.float64],
    asked: NDArray[np.int64],
    scene: NDArray[np.int64],
    known: NDArray[np.bool_],
    k: int,
) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
    """The k nearest known displacements of other scenes, and how far; infinitely far where there are fewer."""
    k = min(k, len(moved))
    nearest = np.empty((len(asked), k), np.int64)
    away = np.empty((len(asked), k))
    lot = max(1, BLOCK // max(len(moved), 1))
    for start in range(0, len(asked), lot):
        mine = asked[start : start + lot]
        distance = cdist(moved[mine], moved)
        distance[(scene[mine][:, None] == scene[None]) | ~known[None]] = np.inf
        few = np.sort(np.argpartition(distance, k - 1, axis=1)[:, :k], axis=1)
        near = np.take_along_axis(distance, few, axis=1)
        order = np.argsort(near, axis=1, kind="stable")
        nearest[start : start + lot] = np.take_along_axis(few, order, axis=1)
        away[start : start + lot] = np.take_along_axis(near, order, axis=1)
    return nearest, away


def in_given_order(rows: Sequence[Row], relations: Sequence[str]) -> list[JudgedPair]:
    """Predicted relations of pairs whose order was given, beside the true ones."""
    return [
        JudgedPair(row["scene"], label_of(row), Relation(row["a"], row["b"], name, 1.0, gap_of(row)), gap_of(row))
        for row, name in zip(rows, relations, strict=True)
    ]


# --- models that infer the direction ----------------------------------------------------------------------


def cross_validated(
    rows: Sequence[Row], new_model: Callable[[], Any], look: Callable[[Row], Any], folds: int | None = None
) -> list[JudgedPair]:
    """Every row classified by a model that learnt from the scenes of the other folds.

    Parameters
    ----------
    new_model : callable
        A fresh `RelationClassifier` or peer.
    look : callable
        A row as the model sees a scene: `as_scene`, or `as_seen` of a peer's name.
    folds : int, optional
        Scenes are dealt to so many folds in turn; default: one scene a fold.
    """
    scene = np.unique([row["scene"] for row in rows], return_inverse=True)[1]
    fold = scene if folds is None else scene % folds
    near = np.array([row["gap"] is not None for row in rows])
    views = [look(row) if row["gap"] is not None else None for row in rows]
    truths = [[label_of(row)] for row in rows]
    predicted: list[Relation | None] = [None] * len(rows)
    for number in np.unique(fold):
        train, test = np.flatnonzero((fold != number) & near), np.flatnonzero((fold == number) & near)
        if len(train) and len(test):
            model = new_model().fit_pairs([views[i] for i in train], [truths[i] for i in train])
            for i in test:
                predicted[i] = next(iter(model.predict_pairs(views[i])), None)
    return [
        JudgedPair(row["scene"], label_of(row), relation, gap_of(row))
        for row, relation in zip(rows, predicted, strict=True)
    ]


def as_scene(row: Row, kernel: str = STANDARD) -> ScenePairs:
    """A near row as `RelationClassifier` sees a scene; the order of its two things is that of their numbers."""
    a, b = row["pair"]
    matrix = np.array(row["features"])
    features = PairFeatures(column_names(2), matrix, np.array([[a, b], [b, a]]), np.full(2, row["gap"]))
    moved = displacements(row, kernel)
    return ScenePairs(features, (moved if row["a"] == a else -moved,))


def as_seen(name: str) -> Callable[[Row], tuple[DescribedPair, ...]]:
    """How the peer called `name` sees a near row."""

    def look(row: Row) -> tuple[DescribedPair, ...]:
        a, b = row["pair"]
        return (DescribedPair(a, b, row["gap"], np.array(row["peers"][name])),)

    return look


def label_of(row: Mapping) -> PairLabel:
    """The true label of a row."""
    return PairLabel(row["a"], row["b"], row["relation"], row["confidence"])


def gap_of(row: Mapping) -> float:
    """Visible gap, metres; infinite for a pair that is not near."""
    return np.inf if row["gap"] is None else row["gap"]
