"""Twelve of our pairs of objects, as the left camera of a stereo pair sees them (thesis Fig 2.3).

``python -m docs.pictures.object_pairs`` draws ``docs/pictures/object_pairs.png``; it needs the
extra ``sim``. The pairs are of the kind and the mix of relations of claims C2.1 to C2.3.
"""

from pathlib import Path

from lifelore.core.labelled_cloud import TABLE, LabelledCloud
from lifelore.domains.tabletop.tabletop import TabletopSettings, sample_scene
from lifelore.figures.style import house_style, save_figure
from reproduction.chapter2.scenes.scene_example import draw_scenes
from reproduction.chapter2.scenes.tabletop_pairs import LEAST_CONFIDENCE, MIX

PATH = Path("docs/pictures/object_pairs.png")
PAIRS, COLUMNS = 12, 4
SETTINGS = TabletopSettings(arrangement="pair", mix=MIX, camera="stereo", shapes="all")
NOTHING = {"objects": [], "relations": []}
"""A scene's document without marks."""


def pairs(seed: int = 0, n: int = PAIRS) -> list[tuple[LabelledCloud, str]]:
    """The first `n` simulated pairs whose relation is beyond doubt, each with it."""
    found: list[tuple[LabelledCloud, str]] = []
    number = 0
    while len(found) < n:
        scene = sample_scene(seed, number, SETTINGS)
        relations = [
            label.relation
            for label in scene.truth
            if TABLE not in (label.a, label.b) and label.confidence >= LEAST_CONFIDENCE
        ]
        if relations:
            found.append((scene.cloud, relations[0]))
        number += 1
    return found


@house_style()
def draw_pairs(seen: list[tuple[LabelledCloud, str]]):
    """The pictures in rows of four, each under its relation."""
    return draw_scenes([(cloud, NOTHING, words) for cloud, words in seen], COLUMNS, ("cloud",))


if __name__ == "__main__":
    print(save_figure(draw_pairs(pairs()), PATH))
