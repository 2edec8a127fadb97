"""The verb `perceive`: a cloud in, what bears on what out; as plain data, and as files for planners and people."""

import os
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from numpy.typing import NDArray

from lifelore.core.errors import InputError, StoreError
from lifelore.perception.cloud_file import read_cloud
from lifelore.perception.perceived_scene import perceived_scene
from lifelore.perception.point_cloud import PointCloud
from lifelore.perception.relation_classifier import RelationClassifier
from lifelore.perception.relation_model_file import load_model, shipped_model
from lifelore.perception.scene import Scene
from lifelore.perception.scene_json import scene_document
from lifelore.perception.segmentation import SegmentationSettings
from lifelore.perception.table_frame import Up, to_scene


@dataclass(frozen=True)
class PerceiveSettings:
    """How a cloud is read and judged.

    Parameters
    ----------
    up : "table", "z", or (3,) numbers
        Where up is in the cloud's frame, see `to_scene`.
    units : {"m", "mm"}
    labels : {"auto", "plain", "parts"}
        How a label field becomes objects, see `label_rule`.
    segmentation : SegmentationSettings
        How a cloud without labels is cut; default clusters by distance.
    model : str, optional
        A file of ``learn-relations --out``, or the name of a model in memory; default the shipped one.
    memory : str, optional
        Where a named model is kept.
    """

    up: Up = "table"
    units: str = "m"
    labels: str = "auto"
    segmentation: SegmentationSettings | None = None
    model: str | None = None
    memory: str | None = None


DEFAULT = PerceiveSettings()


def perceive(
    source: str | os.PathLike[str] | NDArray | PointCloud,
    settings: PerceiveSettings = DEFAULT,
    *,
    pddl: str | None = None,
    dot: str | None = None,
    plot: str | None = None,
) -> dict[str, Any]:
    """Perceive a scene.

    Parameters
    ----------
    source : path, (n, 3) array or PointCloud
        A cloud of any kind that `read_cloud` knows; one that was read already (from a rosbag, say) is taken as
        it is.
    settings : PerceiveSettings
    pddl, dot, plot : str, optional
        Files to write: a planning problem (its domain beside it, as ``NAME-domain.pddl``), a graph for Graphviz,
        a picture (PNG).

    Returns
    -------
    dict
        The document of `scene_json`; contact points are those of pairs that bear on or stand beside each other.

    Raises
    ------
    InputError
        The cloud, a setting or a file name breaks its rule.
    NotFoundError
        Memory has no model of that name.
    StoreError
        A file cannot be written.
    """
    for path in (pddl, dot, plot):
        _check_writable(path)
    model = model_of(settings)
    began = time.perf_counter()
    if not isinstance(source, PointCloud):
        source = read_cloud(source, units=settings.units, labels=settings.labels)
    cloud = to_scene(source, settings.up, settings.segmentation)
    # A skeleton shows where a thing is used: near pairs that do not bear on each other have no place in it.
    scene = perceived_scene(cloud, model).bearing
    document = scene_document(scene, seconds=time.perf_counter() - began)
    _write(scene, document, pddl, dot, plot)
    return document


def model_of(settings: PerceiveSettings) -> RelationClassifier:
    """The relation model that the settings name."""
    if settings.model is None:
        return shipped_model()
    if settings.model.endswith(".npz"):
        return load_model(settings.model)
    from lifelore.agent.learn_relations import recall_relations
    from lifelore.memory import open_memory

    with open_memory(settings.memory) as memory:
        return recall_relations(memory, settings.model)


def _write(scene: Scene, document: dict, pddl: str | None, dot: str | None, plot: str | None) -> None:
    if pddl is not None:
        from lifelore.perception.planning_problem import DOMAIN, planning_problem

        _write_text(pddl, planning_problem(scene.relations, scene.objects))
        _write_text(domain_path(pddl), DOMAIN)
    if dot is not None:
        from lifelore.perception.scene_graph import to_dot

        _write_text(dot, to_dot(scene))
    if plot is not None:
        from lifelore.figures.scene_picture import draw_scene
        from lifelore.figures.style import save_figure

        save_figure(draw_scene(scene.cloud, document), plot)


def domain_path(problem: str) -> str:
    """Where the domain of a problem file is written: beside it."""
    path = Path(problem)
    return str(path.with_name(f"{path.stem}-domain.pddl"))


def _check_writable(path: str | None) -> None:
    if path is None:
        return
    if not path or Path(path).is_dir():
        raise InputError(f"the output must be a file, got '{path}', which is {'a folder' if path else 'empty'}")
    folder = Path(path).parent
    if not folder.is_dir() or not os.access(folder, os.W_OK):
        raise InputError(f"'{path}' cannot be written: its folder must exist and be writable")


def _write_text(path: str, text: str) -> None:
    try:
        Path(path).write_text(text, encoding="utf-8")
    except OSError as error:
        raise StoreError(f"cannot write {path}: {error.strerror}; choose another place") from None
