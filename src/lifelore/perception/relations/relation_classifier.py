"""`RelationClassifier`: learns a user's relations from labelled scenes and predicts them for other scenes.

Thesis: §2.3.5. Any set of labels is allowed. The order of a labelled pair carries no information; the direction is
inferred. ``method="displacement"`` is the thesis's own classifier. To scikit-learn (see `Estimator`) a sample is a
scene.
"""

from collections import Counter
from collections.abc import Collection, Mapping, Sequence
from copy import copy
from functools import cache
from pathlib import Path
from typing import Any, Self
from warnings import warn

from lifelore.core.errors import InputError
from lifelore.core.labelled_cloud import LabelledCloud
from lifelore.core.protocols import Progress
from lifelore.core.relations import ADJACENT_GAP, NONE, SYMMETRIC, PairLabel
from lifelore.perception.contacts.contact_settings import ContactSettings
from lifelore.perception.contacts.interface import DEFAULT_CONTACT_SETTINGS, Interface
from lifelore.perception.pairs import gap_rule
from lifelore.perception.pairs.directed_label import LEAST_CONFIDENCE as LEAST_CONFIDENCE
from lifelore.perception.pairs.directed_label import REVERSED, as_directed, pair_class
from lifelore.perception.pairs.pair_features import TURNING_COLUMNS, VIEW_COLUMNS
from lifelore.perception.pairs.scene_pairs import ScenePairs, scene_pairs
from lifelore.perception.relations.displacement_relations import NeighbourSettings, fit_displacements
from lifelore.perception.relations.estimator import Estimator
from lifelore.perception.relations.label_relations import fit_labels, label_shares, stated_names
from lifelore.perception.relations.relation import PairBelief, Relation
from lifelore.perception.relations.symmetric_names import check_directions, symmetric_names
from lifelore.perception.relations.words import Words
from lifelore.perception.trees.tree_relations import Vocabulary, tree_shares
from lifelore.perception.trees.tree_training import TreeSettings, fit_trees

DEFAULT_TREES = TreeSettings()
METHODS = ("trees", "displacement")
OBJECTS, WITH_TABLE = "objects", "table"
"""Names of the two parts of a model with one class a pair: pairs of objects, and pairs with the table."""
SHIPPED = Path(__file__).parent / "models" / "tabletop.npz"


class RelationClassifier(Estimator):
    """Learns relations from labelled scenes and predicts them for others.

    Parameters
    ----------
    method : {"trees", "displacement"}
        Trees on pair features, or the thesis's nearest neighbours among displacements.
    adjacent_gap : float, optional
        Metres; where *adjacent* and *none* are both learned, neighbours are adjacent up to this visible gap. May
        be changed on a fitted classifier. None learns the limit from the examples.
    multi_label : bool
        Every relation is learned separately, and several may hold for a pair (``under`` and ``left_of``). A
        labelled pair is a counterexample for all relations that its labels do not name.
    symmetric : collection of str, optional
        Relations that hold for (b, a) when they hold for (a, b); all others then have a direction, and never
        hold in both. *adjacent* and *none* are always symmetric. None infers them from the examples.
    omega, weights, k
        Settings of the thesis's method, see `NeighbourSettings`.
    settings : ContactSettings
        Settings of the search for contacts, the same in training and prediction.
    trees : TreeSettings

    Attributes
    ----------
    names_ : tuple of str
        The learned relations, sorted.
    symmetric_ : frozenset of str
        The symmetric ones of them, declared or inferred.
    models_ : dict
        The learned parts; empty before `fit`.
    learnt_from_ : dict of str to int
        Number of training labels by relation: labels of near pairs with enough confidence. Empty for a loaded
        model.

    Raises
    ------
    InputError
        A setting breaks its rule.

    Examples
    --------
    >>> import numpy as np
    >>> from lifelore import LabelledCloud, PairLabel
    >>> plane = np.stack(np.meshgrid(np.linspace(0, 1, 30), np.linspace(0, 1, 30)), -1).reshape(-1, 2)
    >>> sizes = ((1, 0), (0.1, 0.05), (0.1, 0.06))  # the table, and two plates above each other
    >>> points = [np.column_stack([side * plane, np.full(900, height)]) for side, height in sizes]
    >>> cloud = LabelledCloud(np.concatenate(points), np.repeat([1, 2, 3], 900))
    >>> mine = RelationClassifier(method="displacement", k=1).fit([cloud], [[PairLabel(3, 2, "above")]])
    >>> [(found.a, found.b, found.relation) for found in mine.predict(cloud) if found.relation == "above"]
    [(3, 2, 'above')]
    """

    def __init__(
        self,
        method: str = "trees",
        *,
        adjacent_gap: float | None = ADJACENT_GAP,
        multi_label: bool = False,
        symmetric: Collection[str] | None = None,
        omega: float | None = None,
        weights: str = "uniform",
        k: int = 4,
        settings: ContactSettings = DEFAULT_CONTACT_SETTINGS,
        trees: TreeSettings = DEFAULT_TREES,
    ) -> None:
        self.method = method
        self.adjacent_gap = adjacent_gap
        self.multi_label = multi_label
        self.symmetric = symmetric
        self.omega = omega
        self.weights = weights
        self.k = k
        self.settings = settings
        self.trees = trees
        self._check_settings()
        self.names_: tuple[str, ...] = ()
        self.symmetric_: frozenset[str] = frozenset()
        self.models_: dict[str, Any] = {}
        self.learnt_from_: dict[str, int] = {}

    def _check_settings(self) -> None:
        if self.method not in METHODS:
            raise InputError(f"method must be one of {', '.join(METHODS)}, got {self.method!r}")
        if self.multi_label and self.method != "trees":
            raise InputError("multi_label needs method 'trees', got 'displacement'; drop one of the two")
        gap = self.adjacent_gap
        if gap is not None and not 0 < gap < 1:
            raise InputError(f"adjacent_gap must be metres in (0, 1), got {gap!r}; 0.0225 is 22.5 mm")
        _ = self.neighbours

    @property
    def neighbours(self) -> NeighbourSettings:
        """The settings of the thesis's method."""
        return NeighbourSettings(self.k, self.omega, self.weights)

    def fit(
        self,
        clouds: Sequence[LabelledCloud | ScenePairs],
        truths: Sequence[Sequence[PairLabel]],
        progress: Progress | None = None,
    ) -> Self:
        """Learn from scenes and the labels of their pairs with confidence 2 or more.

        A scene is a cloud, or the result of `scene_pairs` for it, which spares a search over settings the search
        for contacts. With trees, a relation that every labelled pair of objects has brings a warning: it would be
        predicted for every near pair.

        Raises
        ------
        InputError
            `clouds` and `truths` differ in number; no label is of a near pair; without `multi_label`, one pair has
            two relations; a pair has a relation in both directions that is not symmetric; a name starts with ``~``
            or ends with ``=``; a setting breaks its rule.
        """
        if len(clouds) != len(truths):
            raise InputError(f"truths must be one for each cloud, got {len(truths)} for {len(clouds)} clouds")
        self._check_settings()
        scenes = []
        for number, cloud in enumerate(clouds):
            scenes.append(self._pairs(cloud))
            if progress is not None:
                progress(number + 1, len(clouds), "scenes")
        near = [
            label
            for scene, truth in zip(scenes, truths, strict=True)
            for pair_labels in scene.labels(truth, LEAST_CONFIDENCE)
            for label in pair_labels
        ]
        if not near:
            raise InputError("truths must label a near pair of clouds with confidence 2 or 3; check their numbers")
        learnt_from = Counter(label.relation for label in near)
        self.names_ = tuple(sorted(learnt_from))
        if odd := [name for name in self.names_ if name.startswith(REVERSED) or name.endswith("=")]:
            raise InputError(f"a relation's name must neither start with ~ nor end with =, got {odd[0]!r}")
        if self.symmetric is None:
            self.symmetric_ = symmetric_names(scenes, truths, self.names_, LEAST_CONFIDENCE)
        else:
            self.symmetric_ = frozenset(self.symmetric) | (SYMMETRIC & frozenset(self.names_))
        if self.multi_label:
            check_directions(truths, self.symmetric_, LEAST_CONFIDENCE)
        else:
            self._check_one_class(scenes, truths)
            if self.method == "trees" and (always := self._without_counterexample(scenes, truths)):
                warn(
                    f"every labelled pair of objects is '{always[0]}', and so will be every near pair predicted: "
                    f"label pairs without it, too, as '{NONE}'",
                    stacklevel=2,
                )
        self.models_ = self._fitted(scenes, truths)
        self.learnt_from_ = dict(sorted(learnt_from.items()))
        return self

    def _pairs(self, scene: LabelledCloud | ScenePairs, found: Sequence[Interface] | None = None) -> ScenePairs:
        return scene if isinstance(scene, ScenePairs) else scene_pairs(scene, found, self.settings)

    def _check_one_class(self, scenes: Sequence[ScenePairs], truths: Sequence[Sequence[PairLabel]]) -> None:
        # Before training, so that a contradiction is reported at once and not after minutes.
        for scene, truth in zip(scenes, truths, strict=True):
            for first, pair_labels in zip(
                scene.features.pairs[::2, 0], scene.labels(truth, LEAST_CONFIDENCE), strict=True
            ):
                if pair_labels:
                    pair_class(pair_labels, int(first), self.symmetric_)

    def _without_counterexample(
        self, scenes: Sequence[ScenePairs], truths: Sequence[Sequence[PairLabel]]
    ) -> list[str]:
        """The relations, without *none*, that every labelled pair of objects has."""
        named = [
            {label.relation for label in labels}
            for scene, truth in zip(scenes, truths, strict=True)
            for labels, table in zip(scene.labels(truth, LEAST_CONFIDENCE), scene.with_table, strict=True)
            if labels and not table
        ]
        return sorted(set.intersection(*named) - {NONE}) if named else []

    def _fitted(self, scenes: Sequence[ScenePairs], truths: Sequence[Sequence[PairLabel]]) -> dict[str, Any]:
        words = self.vocabulary
        if self.multi_label:
            columns = (*TURNING_COLUMNS, *VIEW_COLUMNS)
            return dict(fit_labels(scenes, truths, words, columns, self.trees, LEAST_CONFIDENCE))
        if self.method == "displacement":
            objects, table = (
                fit_displacements(scenes, truths, self.symmetric_, LEAST_CONFIDENCE, table, self.neighbours)
                for table in (False, True)
            )
        else:
            objects, table = fit_trees(scenes, truths, words, TURNING_COLUMNS, self.trees, LEAST_CONFIDENCE)
        return {kind: model for kind, model in ((OBJECTS, objects), (WITH_TABLE, table)) if model is not None}

    @property
    def vocabulary(self) -> Vocabulary:
        """The learned names, which are symmetric, and the limit of *adjacent* where it applies."""
        one_class = self.method == "trees" and not self.multi_label
        applies = one_class and gap_rule.applies(self.names_, self.adjacent_gap)
        return Vocabulary(self.names_, self.symmetric_, self.adjacent_gap if applies else None)

    @property
    def words(self) -> Words:
        """The learned relations outside the core vocabulary."""
        return Words.outside_core(self.names_, self.symmetric_)

    def predict(
        self, cloud: LabelledCloud | ScenePairs, found: Sequence[Interface] | None = None
    ) -> tuple[Relation, ...]:
        """The relation of every near pair, *none* included; then of every object with the table.

        With `multi_label` every relation with a probability of at least 0.5; of the two directions of a relation
        that is not symmetric only the likelier. Pairs that are not near are left out.

        Parameters
        ----------
        cloud : LabelledCloud or ScenePairs
            A cloud, or the result of `scene_pairs` for it.
        found : sequence of Interface, optional
            The interfaces of the cloud, if already computed.
        """
        beliefs = self.beliefs(cloud, found)
        if not self.multi_label:
            return tuple(belief.best() for belief in beliefs)
        return tuple(
            belief.relation(name) for belief in beliefs for name in stated_names(belief.shares, self.symmetric_)
        )

    def score(self, clouds: Sequence[LabelledCloud | ScenePairs], truths: Sequence[Sequence[PairLabel]]) -> float:
        """Share of the labelled near pairs (confidence 2 or more) of which all relations and directions are right.

        Raises
        ------
        InputError
            `clouds` and `truths` differ in number, or no label is of a near pair.
        """
        right = []
        for cloud, truth in zip(clouds, truths, strict=True):
            scene = self._pairs(cloud)
            predicted: dict[frozenset[int], list[PairLabel]] = {}
            for r in self.predict(scene):
                predicted.setdefault(frozenset((r.a, r.b)), []).append(PairLabel(r.a, r.b, r.relation))
            for labels in filter(None, scene.labels(truth, LEAST_CONFIDENCE)):
                answers = predicted.get(frozenset((labels[0].a, labels[0].b)), [])
                right.append(self._directed(labels, labels[0].a) == self._directed(answers, labels[0].a))
        if not right:
            raise InputError("truths must label a near pair of clouds with confidence 2 or 3; check their numbers")
        return sum(right) / len(right)

    def _directed(self, labels: Sequence[PairLabel], first: int) -> set[str]:
        """Directed classes of a pair's labels; with `multi_label` without *none*, which is never predicted."""
        names = {as_directed(label, first, self.symmetric_) for label in labels}
        return names - {NONE} if self.multi_label else names

    def beliefs(
        self, cloud: LabelledCloud | ScenePairs, found: Sequence[Interface] | None = None
    ) -> tuple[PairBelief, ...]:
        """Probability of each relation for every near pair; arguments and order are those of `predict`."""
        if not self.models_:
            raise InputError("a classifier must be fitted before it predicts; call fit or load a model")
        scene = self._pairs(cloud, found)
        shares = self._shares(scene)
        return tuple(
            PairBelief(int(a), int(b), float(gap), mine)
            for (a, b), gap, mine in zip(scene.features.pairs[::2], scene.features.gaps[::2], shares, strict=True)
            if mine
        )

    def _shares(self, scene: ScenePairs) -> list[dict[str, float]]:
        """Shares of each pair; empty for pairs of a kind without training labels, and without any displacement."""
        if self.multi_label:
            return label_shares(self.models_, scene, self.symmetric_)
        if self.method == "displacement":
            kinds = [WITH_TABLE if table else OBJECTS for table in scene.with_table]
            return [
                self.models_[kind].shares(moved) if kind in self.models_ and len(moved) else {}
                for kind, moved in zip(kinds, scene.displacements, strict=True)
            ]
        return tree_shares(self.models_.get(OBJECTS), self.models_.get(WITH_TABLE), scene, self.vocabulary)

    def save(self, path: str | Path, about: Mapping[str, Any] | None = None) -> None:
        """Write the fitted classifier to an npz file; `about` holds notes for people, as JSON values.

        Raises
        ------
        InputError
            The classifier is not fitted.
        StoreError
            The disk refuses.
        """
        from lifelore.perception.relations.relation_model_file import write_model

        write_model(self, path, about)

    @classmethod
    def load(cls, path: str | Path) -> "RelationClassifier":
        """Read the classifier that `save` wrote.

        Raises
        ------
        InputError
            The file is missing, damaged, newer, or no relation model.
        """
        from lifelore.perception.relations.relation_model_file import read_model

        return read_model(path)


def shipped_model() -> RelationClassifier:
    """The classifier that comes with the package, trained on simulated tabletop scenes alone."""
    return copy(_shipped())


@cache
def _shipped() -> RelationClassifier:
    return RelationClassifier.load(SHIPPED)
