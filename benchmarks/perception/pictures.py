"""`bench pictures`: ten real scenes drawn with all that is perceived of them, and what is missing or wrong there.

The scenes are the ten with the most hand-labelled pairs of confidence 2 or 3, ties by name; pairs with the table
count. *Expected* is every *on*, *adjacent* and *both* of that confidence, with its direction. *Wrong* is a
relation drawn that contradicts such a label, or joins two things whose pair the annotator did not list as near.
Labels of confidence 1 are neither. Written are a picture of each scene and ``result.json``, both under
``results/real_scenes``.
"""

import io
import json
from collections.abc import Mapping, Sequence
from pathlib import Path

from benchmarks.rounds import at_most, row
from lifelore.core.labelled_cloud import TABLE
from lifelore.core.protocols import Progress
from lifelore.core.relations import NONE, SYMMETRIC, PairLabel
from lifelore.perception.perceived_scene import perceived_scene
from lifelore.perception.relations.relation import Relation
from lifelore.perception.relations.relation_classifier import shipped_model
from lifelore.perception.scene import object_name
from lifelore.perception.scene_json import scene_document
from reproduction.chapter2.scenes.real_scenes import RealScene, real_scenes, real_scenes_folder
from reproduction.engine.cell_store import write_atomically

SCENES = 10
LEAST_CONFIDENCE = 2
OUT = Path("benchmarks/results/real_scenes")
COLOURS = 256
Drawn = tuple[str, int, int]
"""A relation and its two, the lower number first where it has no direction."""


def bench_pictures(repeats: int, progress: Progress, out: Path = OUT) -> dict:
    """Rows and goals; see `benchmarks.bench`. Nothing here is random: `repeats` changes nothing.

    Without the real scenes nothing is drawn and the goals stay open.
    """
    chosen = most_labelled(real_scenes()) if real_scenes_folder() else []
    judged = []
    for number, scene in enumerate(chosen):
        judged.append(draw_and_judge(scene, out))
        progress(number + 1, len(chosen), scene.name)
    if judged:
        lines = ",\n".join(f"  {json.dumps(one)}" for one in judged)
        write_atomically(
            out / "result.json", f'{{\n "rule": {json.dumps(_rule())},\n "scenes": [\n{lines}\n ]\n}}\n'
        )
    return {"rows": _rows(judged), "goals": _goals(judged)}


def most_labelled(scenes: Sequence[RealScene], n: int = SCENES) -> list[RealScene]:
    """The scenes with the most pairs of confidence 2 or 3, ties by name."""
    return sorted(scenes, key=lambda scene: (-_labelled(scene.truth), scene.name))[:n]


def _labelled(truth: Sequence[PairLabel]) -> int:
    return sum(label.confidence >= LEAST_CONFIDENCE for label in truth)


def draw_and_judge(scene: RealScene, out: Path) -> dict:
    """Perceive a scene, write its picture, and say what it shows."""
    from lifelore.figures.scenes.scene_picture import draw_scene
    from lifelore.figures.style import save_figure

    perceived = perceived_scene(scene.cloud, shipped_model()).without_unrelated_contacts
    figure = draw_scene(scene.cloud, scene_document(perceived), title=scene.name)
    _fewer_colours(save_figure(figure, out / f"{scene.name}.png"))
    return {"scene": scene.name, **judge(scene.truth, perceived.relations)}


def _fewer_colours(path: Path) -> None:
    """The same picture in a palette: ten of them are committed."""
    from PIL import Image

    few = io.BytesIO()
    Image.open(path).convert("RGB").quantize(COLOURS).save(few, format="png", optimize=True)
    if few.tell() < path.stat().st_size:
        path.write_bytes(few.getvalue())


def judge(truth: Sequence[PairLabel], said: Sequence[Relation]) -> dict[str, list[str] | int]:
    """``{"pairs", "expected", "found", "missing", "wrong"}``, relations in words such as ``on(3, 2)``."""
    sure = {frozenset((t.a, t.b)): _drawn(t) for t in truth if t.confidence >= LEAST_CONFIDENCE}
    listed = {frozenset((t.a, t.b)) for t in truth}
    expected = {label for label in sure.values() if label[0] != NONE}
    drawn = {_drawn(relation) for relation in said if relation.relation != NONE}
    wrong = {one for one in drawn if _contradicts(one, sure, listed)}
    return {
        "pairs": len(sure),
        "expected": _in_words(expected),
        "found": _in_words(expected & drawn),
        "missing": _in_words(expected - drawn),
        "wrong": _in_words(wrong),
    }


def _drawn(one: PairLabel | Relation) -> Drawn:
    a, b = sorted((one.a, one.b)) if one.relation in SYMMETRIC else (one.a, one.b)
    return one.relation, a, b


def _contradicts(one: Drawn, sure: Mapping[frozenset[int], Drawn], listed: set[frozenset[int]]) -> bool:
    pair = frozenset(one[1:])
    return sure[pair] != one if pair in sure else pair not in listed


def _in_words(labels: set[Drawn]) -> list[str]:
    return [f"{name}({object_name(a)}, {object_name(b)})" for name, a, b in sorted(labels, key=_order)]


def _order(label: Drawn) -> tuple:
    name, a, b = label
    return TABLE in (a, b), name, a, b


def _rule() -> str:
    return (
        f"the {SCENES} scenes with the most hand-labelled pairs of confidence {LEAST_CONFIDENCE} or 3, ties by "
        "name; wrong: contradicts such a label, or joins two that the annotator did not list as near"
    )


def _rows(judged: Sequence[Mapping]) -> list[dict]:
    found = [row(f"{one['scene']}, {key}", len(one[key]), "relations") for one in judged for key in _KEYS]
    return [
        *found,
        *(row(f"all, {key}", sum(len(one[key]) for one in judged), "relations") for key in _KEYS if judged),
    ]


_KEYS = ("expected", "found", "missing", "wrong")


def _goals(judged: Sequence[Mapping]) -> list[dict]:
    """Nothing missing and nothing wrong, each with the scenes that fail."""
    goals = []
    for key, name in (("missing", "expected relations not shown"), ("wrong", "wrong relations shown")):
        failing = [f"{one['scene']}: {', '.join(one[key])}" for one in judged if one[key]]
        told = f"{name} ({'; '.join(failing)})" if failing else name
        goals.append(at_most(told, 0, sum(len(one[key]) for one in judged) if judged else None))
    return goals
