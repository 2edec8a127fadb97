"""Relations of pairs by the thesis's nearest neighbours, A and B given as in its pictures.

No pair is ever classified by displacements of its own scene. Thesis: §2.3.5, §2.4.1.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import product

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.distance import cdist

from lifelore.core.relations import ADJACENT, BOTH, CORE_RELATIONS, NONE, ON
from reproduction.chapter2.scenes.tabletop_pairs import KERNEL_NAMES, STANDARD, Row
from reproduction.chapter2.scoring.relation_scoring import BESIDE, CARRIED

THRESHOLD = 7
"""Fewest support vectors of a contact, as the thesis used (§2.3.4)."""
THRESHOLDS = SCALED, FIXED = "scaled", "7"
"""Which contacts are dropped. The thesis's 7 "is somewhat dependent on the resolution". *Scaled*, it is 7 on
points 3 mm apart, but never above the support of an object's strongest contact; a fixed 7 may drop all."""
WEIGHTS = ("equal", "inverse distance")
Rows = NDArray[np.int64]
Points = NDArray[np.float64]


@dataclass(frozen=True)
class Reading:
    """The choices that the thesis leaves open between a picture and its vote.

    The kernel's name; a rule of `THRESHOLDS`; a weight of `WEIGHTS` (of equal votes the first relation by name
    wins); the length above which displacements do not vote, metres; and the number of neighbours.
    """

    kernel: str = STANDARD
    threshold: str = SCALED
    votes: str = "equal"
    omega: float | None = None
    k: int = 4


CONTACT_READINGS = [Reading(*choice) for choice in product(KERNEL_NAMES, THRESHOLDS)]
"""Every kernel with every threshold."""


def displacements(row: Row, kernel: str = STANDARD, threshold: str = SCALED) -> Points:
    """χ_a - χ_b between all contacts of a row, ``(m, 3)``, metres; none for far pairs."""
    if row["gap"] is None:
        return np.empty((0, 3))
    places = []
    for side in ("a", "b"):
        contacts = row["contacts"][kernel][side]
        strong = [contact for contact in contacts if contact[3] >= THRESHOLD]
        kept = strong or (contacts[:1] if threshold == SCALED else [])
        places.append(np.array(kept).reshape(-1, 4)[:, :3])
    return (places[0][:, None] - places[1][None]).reshape(-1, 3)


def joined_displacements(rows: Sequence[Row], kernel: str, threshold: str) -> tuple[Points, Rows]:
    """The displacements of all rows, ``(m, 3)``, and the number of the row of each, ``(m,)``."""
    each = [displacements(row, kernel, threshold) for row in rows]
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
    """The k nearest displacements of other scenes vote on each displacement.

    `train` ``(rows,)`` names the rows to learn from; only the others are classified. Default: leave one scene out.
    """
    return votes_on(*joined_displacements(rows, reading.kernel, reading.threshold), rows, reading, train)


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


def _nearest(
    moved: Points, asked: Rows, scene: Rows, known: NDArray[np.bool_], k: int
) -> tuple[Rows, NDArray[np.floating]]:
    """The k nearest known displacements of other scenes, and how far; infinitely far where there are fewer."""
    k, distance = min(k, len(moved)), cdist(moved[asked], moved)
    distance[(scene[asked][:, None] == scene[None]) | ~known[None]] = np.inf
    few = np.sort(np.argpartition(distance, k - 1, axis=1)[:, :k], axis=1)
    near = np.take_along_axis(distance, few, axis=1)
    order = np.argsort(near, axis=1, kind="stable")
    return np.take_along_axis(few, order, axis=1), np.take_along_axis(near, order, axis=1)
