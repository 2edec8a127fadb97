"""`ScenePairs`: features and displacements of the near pairs of a scene, and the labels of each pair."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lifelore.core.labelled_cloud import TABLE, LabelledCloud
from lifelore.core.relations import PairLabel
from lifelore.perception.contacts.contact_settings import ContactSettings
from lifelore.perception.contacts.interface import DEFAULT_CONTACT_SETTINGS, Interface, interfaces
from lifelore.perception.pairs.pair_features import PairFeatures, pair_features


@dataclass(frozen=True, eq=False)
class ScenePairs:
    """The near pairs of a scene: features of both orders, and displacements χ_a - χ_b between all contact points.

    Parameters
    ----------
    features : PairFeatures
    displacements : tuple of (m, 3) float64
        One for each pair in the order (a, b), metres.
    """

    features: PairFeatures
    displacements: tuple[NDArray[np.float64], ...]

    @property
    def with_table(self) -> NDArray[np.bool_]:
        """Whether each pair is of an object with the table, ``(n_pairs,)``."""
        return self.features.pairs[::2, 1] == TABLE

    def labels(self, truth: Sequence[PairLabel], least_confidence: int) -> list[list[PairLabel]]:
        """The labels in `truth` of each pair with at least that confidence; empty where there are none."""
        by_pair: dict[frozenset[int], list[PairLabel]] = {}
        for label in truth:
            if label.confidence >= least_confidence:
                by_pair.setdefault(frozenset((label.a, label.b)), []).append(label)
        return [by_pair.get(frozenset(map(int, pair)), []) for pair in self.features.pairs[::2]]


def scene_pairs(
    cloud: LabelledCloud,
    found: Sequence[Interface] | None = None,
    settings: ContactSettings = DEFAULT_CONTACT_SETTINGS,
) -> ScenePairs:
    """The near pairs of a scene; `found` are its interfaces, if already computed."""
    if found is None:
        found = interfaces(cloud, settings)
    return ScenePairs(pair_features(cloud, found), tuple(_displacements(one) for one in found))


def _displacements(one: Interface) -> NDArray[np.float64]:
    first = np.array([contact.position for contact in one.contacts_a]).reshape(-1, 3)
    second = np.array([contact.position for contact in one.contacts_b]).reshape(-1, 3)
    return (first[:, None] - second[None]).reshape(-1, 3)
