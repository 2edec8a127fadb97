"""The methods of `bench relations`, and scenes with the descriptors of all of them, each computed once."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from lifelore.core.labelled_cloud import LabelledCloud
from lifelore.core.relations import PairLabel
from lifelore.perception.pairs.scene_pairs import ScenePairs, scene_pairs
from lifelore.perception.pairs.side_faces import pairs_beside
from lifelore.perception.peers import PEERS
from lifelore.perception.reasoning.scene_logic import alternatives, most_likely_scene
from lifelore.perception.relations.relation import Relation
from lifelore.perception.relations.relation_classifier import RelationClassifier
from reproduction.chapter2.scoring.relation_scoring import JudgedPair, judged_scene

THESIS, OURS, SHIPPED = "thesis's displacements", "ours", "ours as shipped"
LOGIC = " with scene logic"
CONTACTS = "contacts"
"""Under this name a scene keeps what our own two methods see of it."""


@dataclass(frozen=True)
class Learner:
    """A method: what it sees a scene as, by the name under which scenes keep it, and a fresh model of it."""

    sees: str
    new: Callable[[], Any]


LEARNERS: dict[str, Learner] = {
    **{name: Learner(name, new) for name, new in PEERS.items()},
    THESIS: Learner(CONTACTS, lambda: RelationClassifier("displacement")),
    OURS: Learner(CONTACTS, RelationClassifier),
}


@dataclass(frozen=True, eq=False)
class SeenScene:
    """A scene without its points.

    Parameters
    ----------
    name : str
    truth : sequence of PairLabel
    objects : tuple of int
    seen : mapping
        What each `Learner.sees` saw.
    gaps : mapping, optional
        True visible gaps of ``{a, b}``, metres, where they are known.
    """

    name: str
    truth: Sequence[PairLabel]
    objects: tuple[int, ...]
    seen: Mapping[str, Any]
    gaps: Mapping[frozenset[int], float] | None = None

    def judged(self, said: Sequence[Relation]) -> list[JudgedPair]:
        """Each labelled pair beside what was said of it."""
        return judged_scene(self.name, self.truth, said, self.gaps)


def seen_scene(
    name: str,
    cloud: LabelledCloud,
    truth: Sequence[PairLabel],
    gaps: Mapping[frozenset[int], float] | None = None,
    contacts: ScenePairs | None = None,
) -> SeenScene:
    """A scene as everybody sees it; `contacts` where they are known already."""
    seen: dict[str, Any] = {peer: new().describe_pairs(cloud) for peer, new in PEERS.items()}
    seen[CONTACTS] = contacts or scene_pairs(cloud)
    return SeenScene(name, truth, cloud.objects, seen, gaps)


def taught(learner: str, scenes: Sequence[SeenScene]) -> Any:
    """A fresh model of a learner that has learnt from `scenes`."""
    entry = LEARNERS[learner]
    return entry.new().fit_pairs([scene.seen[entry.sees] for scene in scenes], [scene.truth for scene in scenes])


def asked(learner: str, model: Any, scenes: Sequence[SeenScene]) -> dict[str, list[JudgedPair]]:
    """What a model says of scenes, judged; for our own classifier also after scene logic."""
    sees = LEARNERS[learner].sees if learner in LEARNERS else CONTACTS
    answers = {learner: [pair for scene in scenes for pair in scene.judged(model.predict_pairs(scene.seen[sees]))]}
    if sees == CONTACTS:
        answers[learner + LOGIC] = [
            pair
            for scene in scenes
            for pair in scene.judged(reconciled(model, scene.seen[CONTACTS], scene.objects))
        ]
    return answers


def reconciled(model: RelationClassifier, contacts: ScenePairs, objects: Sequence[int]) -> tuple[Relation, ...]:
    """The most likely consistent scene of what a model believes."""
    beliefs = alternatives(model.beliefs_of(contacts))
    return most_likely_scene(beliefs, objects, beside=pairs_beside(contacts)).relations
