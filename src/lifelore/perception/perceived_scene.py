"""`perceived_scene`: the whole way from labelled points to a consistent scene (thesis §2.3, Algorithm 1)."""

from lifelore.core.labelled_cloud import LabelledCloud
from lifelore.core.relations import CORE_RELATIONS
from lifelore.perception.contacts.interface import interfaces
from lifelore.perception.reasoning.scene_logic import alternatives, most_likely_scene
from lifelore.perception.relations.relation_classifier import RelationClassifier, shipped_model
from lifelore.perception.scene import Scene


def perceived_scene(
    cloud: LabelledCloud, model: RelationClassifier | None = None, *, consistent: bool = True
) -> Scene:
    """What a cloud shows: contacts, networks, relations; `Scene.optimal` is False where logic ran out of bounds.

    Parameters
    ----------
    cloud : LabelledCloud
        Of any number of objects, none included.
    model : RelationClassifier, optional
        Names the relations; default the one shipped with the package.
    consistent : bool
        Whether relations are reconciled by logic (see `scene_logic`). Only for models whose words are *on*,
        *adjacent*, *both* and *none*: of other words nothing is known that could contradict.
    """
    model = model or shipped_model()
    found = interfaces(cloud, model.settings)
    if not consistent or model.multi_label or not set(model.names) <= set(CORE_RELATIONS):
        return Scene(cloud, found, model.predict(cloud, found))
    decided = most_likely_scene(alternatives(model.beliefs(cloud, found)), cloud.objects)
    return Scene(cloud, found, decided.relations, decided.optimal)
