"""`perceived_scene`: from labelled points to a consistent scene with relations (thesis §2.3, Algorithm 1)."""

from lifelore.core.labelled_cloud import LabelledCloud
from lifelore.core.relations import CORE_RELATIONS
from lifelore.perception.contacts.interface import interfaces
from lifelore.perception.pairs.scene_pairs import scene_pairs
from lifelore.perception.pairs.side_faces import pairs_beside
from lifelore.perception.reasoning.scene_logic import alternatives, most_likely_scene
from lifelore.perception.relations.relation_classifier import RelationClassifier, shipped_model
from lifelore.perception.scene import Scene


def perceived_scene(
    cloud: LabelledCloud, model: RelationClassifier | None = None, *, consistent: bool = True
) -> Scene:
    """Contacts, networks and relations of a cloud; `Scene.optimal` is False where the solver reached its bound.

    Parameters
    ----------
    cloud : LabelledCloud
        With any number of objects, also without any.
    model : RelationClassifier, optional
        Predicts the relations; default: the shipped classifier.
    consistent : bool
        Whether logic makes the relations consistent (see `scene_logic`). Applies only to models whose names are
        *on*, *adjacent*, *both* and *none*; no rules are known for other names.
    """
    model = model or shipped_model()
    found = interfaces(cloud, model.settings)
    if not consistent or model.multi_label or not set(model.names) <= set(CORE_RELATIONS):
        return Scene(cloud, found, model.predict(cloud, found))
    pairs = scene_pairs(cloud, found, model.settings)
    beliefs = alternatives(model.beliefs_of(pairs))
    decided = most_likely_scene(beliefs, cloud.objects, beside=pairs_beside(pairs))
    return Scene(cloud, found, decided.relations, decided.optimal)
