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
from lifelore.perception.pairs.pair_features import PairFeatures, column_names
from lifelore.perception.pairs.scene_pairs import ScenePairs
from lifelore.perception.peers.peer import DescribedPair
from lifelore.perception.relations.relation import Relation
from reproduction.chapter2.scenes.tabletop_pairs import STANDARD, Row
from reproduction.chapter2.scoring.relation_scoring import BESIDE, CARRIED, JudgedPair

THRESHOLD = 7
"""Fewest support vectors of a contact, as the thesis used (§2.3.4)."""
DROPS = ("all but one", "weak")
"""Which contacts are dropped: those below `THRESHOLD` except an object's strongest, or all below it."""
WEIGHTS = ("equal", "inverse distance")
BLOCK = 4_000_000
"""Distances held at a time: without the threshold there are tens of thousands of displacements."""
Rows = NDArray[np.int64]
Points = NDArray[np.float64]


@dataclass(frozen=True)
class Reading:
    """The choices that the thesis leaves open between a picture and its vote.

    The kernel's name; a rule of `DROPS`; a weight of `WEIGHTS` (of equal votes the first relation by name wins);
    the length above which displacements do not vote, metres; and the number of neighbours.
    """

    kernel: str = STANDARD
    drop: str = "all but one"
    votes: str = "equal"
    omega: float | None = None
    k: int = 4


AS_PRINTED = Reading(drop="weak")
"""Every contact of fewer than `THRESHOLD` support vectors is dropped, as the thesis says, whatever is left."""


def displacements(row: Row, kernel: str = STANDARD, drop: str = "all but one") -> Points:
    """χ_a - χ_b between all contacts of a row in the truth's order, ``(m, 3)``, metres; none for far pairs."""
    if row["gap"] is None:
        return np.empty((0, 3))
    places = []
    for side in ("a", "b"):
        contacts = row["contacts"][kernel][side]
        strong = [contact for contact in contacts if contact[3] >= THRESHOLD]
        kept = strong or (contacts[:1] if drop == "all but one" else [])
        places.append(np.array(kept).reshape(-1, 4)[:, :3])
    moved = (places[0][:, None] - places[1][None]).reshape(-1, 3)
    return moved if row["a"] == row["pair"][0] else -moved


def joined_displacements(rows: Sequence[Row], kernel: str, drop: str) -> tuple[Points, Rows]:
    """The displacements of all rows, ``(m, 3)``, and the number of the row of each, ``(m,)``."""
    each = [displacements(row, kernel, drop) for row in rows]
    return np.concatenate(each), np.repeat(np.arange(len(rows)), [len(moved) for moved in each])


@dataclass(frozen=True, eq=False)
class Votes:
    """The votes of neighbours on m displacements: the row of each, the relation that won, and shares of the votes.

    `shares` ``(m, 4)`` are those of `CORE_RELATIONS`; zeros where there is no neighbour.
    """

    row: Rows
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

    `train` ``(rows,)`` names the rows to learn from; only the others are classified. Default: leave one scene out.
    """
    return votes_on(*joined_displacements(rows, reading.kernel, reading.drop), rows, reading, train)


def votes_on(
    moved: Points, owner: Rows, rows: Sequence[Row], reading: Reading, train: NDArray[np.bool_] | None = None
) -> Votes:
    """As `votes_of_neighbours`, from displacements ``(m, 3)`` and the row of each."""
    scene = np.unique([row["scene"] for row in rows], return_inverse=True)[1][owner]
    code = np.array([CORE_RELATIONS.index(row["relation"]) for row in rows])[owner]
    known = np.ones(len(moved), bool) if train is None else train[owner]
    asked = np.flatnonzero(known if train is None else ~known)
    if reading.omega is not None:
        known = known & (np.linalg.norm(moved, axis=1) <= reading.omega)
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


def _nearest(moved: Points, asked: Rows, scene: Rows, known: NDArray[np.bool_], k: int) -> tuple[Rows, Points]:
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


def judged_row(row: Row, predicted: Relation | None) -> JudgedPair:
    """A row beside its predicted relation."""
    return JudgedPair(row["scene"], label_of(row), predicted, gap_of(row))


def in_given_order(rows: Sequence[Row], relations: Sequence[str]) -> list[JudgedPair]:
    """Predicted relations of pairs whose order was given, beside the true ones."""
    pairs = zip(rows, relations, strict=True)
    return [judged_row(row, Relation(row["a"], row["b"], name, 1.0, gap_of(row))) for row, name in pairs]


def cross_validated(
    rows: Sequence[Row], new_model: Callable[[], Any], look: Callable[[Row], Any], folds: int | None = None
) -> list[JudgedPair]:
    """Every row classified by a model that learnt from the scenes of the other folds; the direction is inferred.

    ``new_model()`` is a fresh `RelationClassifier` or peer; ``look(row)`` is a row as the model sees a scene,
    `as_scene` or `as_seen` of a peer's name. Scenes are dealt to the folds in turn; default: one scene a fold.
    """
    scene = np.unique([row["scene"] for row in rows], return_inverse=True)[1]
    fold = scene if folds is None else scene % folds
    views = [look(row) if row["gap"] is not None else None for row in rows]
    found = {}
    for number in np.unique(fold):
        train, test = (np.flatnonzero(own).tolist() for own in (fold != number, fold == number))
        lessons, asked = ([(rows[i], views[i]) for i in chosen] for chosen in (train, test))
        found |= dict(zip(test, classified(new_model(), lessons, asked), strict=True))
    return [found[i] for i in range(len(rows))]


def classified(
    model: Any, lessons: Sequence[tuple[Row, Any]], asked: Sequence[tuple[Row, Any]]
) -> list[JudgedPair]:
    """The rows `asked` as the model classifies them that learnt the lessons; far pairs are not predicted.

    Each is a row and its view, as the model sees it; the view of a far pair is None.
    """
    near = [(view, [label_of(row)]) for row, view in lessons if view is not None]
    if near and any(view is not None for _, view in asked):
        model.fit_pairs(*map(list, zip(*near, strict=True)))
        return [
            judged_row(row, None if view is None else next(iter(model.predict_pairs(view)), None))
            for row, view in asked
        ]
    return [judged_row(row, None) for row, _ in asked]


def as_scene(row: Row, kernel: str = STANDARD) -> ScenePairs:
    """A near row as `RelationClassifier` sees a scene; the order of its two objects is that of their numbers."""
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
