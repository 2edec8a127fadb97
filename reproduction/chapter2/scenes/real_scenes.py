"""Real scenes for evaluation: Kinect clouds with hand-made labels, in the folder that LIFELORE_DATA names."""

import os
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

from lifelore.core.errors import InputError
from lifelore.core.labelled_cloud import LabelledCloud
from lifelore.core.relations import PairLabel
from lifelore.perception.clouds.cloud_file import read_cloud
from lifelore.perception.relations.relation_truth import read_relations
from lifelore.perception.segmentation.table_frame import to_scene

VARIABLE = "LIFELORE_DATA"


@dataclass(frozen=True, eq=False)
class RealScene:
    """A labelled cloud in the table's frame and the hand-made labels of its pairs."""

    name: str
    cloud: LabelledCloud
    truth: tuple[PairLabel, ...]


def real_scenes_folder() -> Path | None:
    """The folder of the real scenes; None where LIFELORE_DATA is not set or has no such folder."""
    folder = Path(os.environ.get(VARIABLE, "")) / "osd"
    return folder if VARIABLE in os.environ and (folder / "relations.csv").is_file() else None


def real_scenes() -> tuple[RealScene, ...]:
    """All of them, by name; raises `InputError` if they are not there, or a file is damaged."""
    folder = real_scenes_folder()
    if folder is None:
        raise InputError(f"{VARIABLE} must name a folder with osd/relations.csv and its clouds; set it")
    return _read(folder)


@lru_cache(maxsize=1)
def _read(folder: Path) -> tuple[RealScene, ...]:
    truths = read_relations(folder / "relations.csv")
    return tuple(
        RealScene(name, to_scene(read_cloud(folder / f"{name}.pcd")), truths[name]) for name in sorted(truths)
    )
