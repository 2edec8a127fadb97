"""Writes the files of a perceived scene: a planning problem with its domain, graph, picture, label image, log."""

import os
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, TypedDict

from lifelore.core.atomic_write import refused_writes
from lifelore.core.errors import InputError

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from lifelore.perception.reasoning.planning_goal import Statement
    from lifelore.perception.scene import Scene

NAME = "{name}"
"""Placeholder in the name of a file for the name of the cloud."""


Recorder = Callable[[str, "Scene", Mapping], None]
"""Writes a log of a scene and its document to a path, such as `bridges.viewer_log.write_scene_log`."""
ENDINGS = {"plot": (".png",), "masks_out": (".png",), "log": (".mcap", ".rrd")}
"""Endings of the files that have them."""


class FileNames(TypedDict, total=False):
    """The fields of `SceneFiles`, as keyword arguments of a function."""

    pddl: str | None
    dot: str | None
    plot: str | None
    masks_out: str | None
    log: str | None
    recorder: Recorder | None


@dataclass(frozen=True)
class SceneFiles:
    """Files to write; None: do not write.

    Parameters
    ----------
    pddl : str, optional
        A planning problem; its domain is written beside it, see `domain_path`.
    dot : str, optional
        A graph for Graphviz.
    plot : str, optional
        A picture, ``NAME.png``.
    masks_out : str, optional
        A label image of 16 bits, ``NAME.png``: 0 nothing, 1 the table, 2 … the objects.
    log : str, optional
        A log of the scene, ``NAME.mcap`` or ``NAME.rrd``, by the `recorder`.
    recorder : callable, optional
        Needed for a log.

    Raises
    ------
    InputError
        A log without a recorder.
    """

    pddl: str | None = None
    dot: str | None = None
    plot: str | None = None
    masks_out: str | None = None
    log: str | None = None
    recorder: Recorder | None = None

    def __post_init__(self) -> None:
        if self.log is not None and self.recorder is None:
            raise InputError("log needs a recorder: give bridges.viewer_log.write_scene_log")

    @property
    def options(self) -> dict[str, str]:
        """The files that are asked for, by their options."""
        paths = {name: getattr(self, name) for name in ("pddl", "dot", "plot", "masks_out", "log")}
        return {name: path for name, path in paths.items() if path is not None}

    @property
    def paths(self) -> tuple[str, ...]:
        """All files to write, with the domain."""
        domain = () if self.pddl is None else (domain_path(self.pddl),)
        return (*self.options.values(), *domain)

    def of(self, source: str) -> "SceneFiles":
        """The files of a cloud: the placeholder `NAME` is replaced by the name of its file without suffix.

        >>> SceneFiles(dot="graphs/{name}.dot").of("clouds/cup.pcd").dot
        'graphs/cup.dot'
        """
        return replace(
            self, **{name: path.replace(NAME, Path(source).stem) for name, path in self.options.items()}
        )


def domain_path(problem: str) -> str:
    """Path of the domain of a problem file: ``NAME-domain.pddl`` in the same folder."""
    path = Path(problem)
    return str(path.with_name(f"{path.stem}-domain.pddl")) if path.name else ""


def check_names(files: SceneFiles) -> None:
    """Refuse a file name without placeholder, which would be the same for all clouds."""
    for option, path in files.options.items():
        if NAME not in path:
            ending = ENDINGS.get(option, (f".{option}",))[0]
            raise InputError(
                f"{option} names one file for many clouds, '{path}': write {NAME} for the name of each cloud,"
                f" such as --{option.replace('_', '-')} {NAME}{ending}"
            )


def check_scene_files(scenes: Iterable[SceneFiles], sources: Sequence[str | os.PathLike[str]]) -> None:
    """Refuse files of scenes that cannot be written, or that would overwrite each other or the `sources`.

    Raises
    ------
    InputError
        The message names the file.
    """
    scenes = [files for files in scenes if files.paths]
    for files in scenes:
        for path in files.paths:
            _check_writable(path)
        for option, path in files.options.items():
            _check_ending(option, path)
    used = {os.path.realpath(path) for path in sources if scenes}
    for path in (path for files in scenes for path in files.paths):
        if os.path.realpath(path) in used:
            raise InputError(
                f"'{path}' would be overwritten: the cloud, the model, plot, dot, masks_out, log, pddl and the"
                " domain beside it must be different files"
                + ("; rename clouds of one name, or perceive them one by one" if len(scenes) > 1 else "")
            )
        used.add(os.path.realpath(path))


def _check_ending(option: str, path: str) -> None:
    endings = ENDINGS.get(option, ("",))
    if not path.lower().endswith(endings):
        kinds = " or ".join(ending[1:].upper() for ending in endings)
        raise InputError(f"{option} must name a {kinds} file, such as scene{endings[0]}, got '{path}'")


def _check_writable(path: str) -> None:
    if not path or os.path.isdir(path):
        raise InputError(f"the output must be a file, got '{path}', which is {'a folder' if path else 'empty'}")
    folder = os.path.dirname(path) or "."
    if not os.path.isdir(folder) or not os.access(folder, os.W_OK):
        raise InputError(f"'{path}' cannot be written: its folder must exist and be writable")


def write_scene_files(
    files: SceneFiles,
    scene: "Scene",
    document: Mapping,
    min_confidence: float | None = None,
    goal: Sequence["Statement"] = (),
) -> None:
    """Write the files of a scene.

    Parameters
    ----------
    files : SceneFiles
    scene : Scene
    document : mapping
        The document of `scene_json`, for the picture.
    min_confidence : float, optional
        Least probability of what the graph and the planning problem state; default: 0 for the graph,
        `PLAN_CONFIDENCE` for the problem.
    goal : sequence of Statement
        The goal of the planning problem.

    Raises
    ------
    InputError
        The goal names a predicate or an object that does not exist, or a label image is asked for and the cloud
        has no image; no file is written.
    StoreError
        A file cannot be written.
    """
    labels = None
    if files.masks_out is not None:
        from lifelore.perception.places.object_mask import label_image

        labels = label_image(scene.cloud)
    if files.pddl is not None:
        from lifelore.perception.reasoning.planning_domain import planning_domain
        from lifelore.perception.reasoning.planning_problem import scene_problem
        from lifelore.perception.reasoning.planning_state import PLAN_CONFIDENCE

        least = PLAN_CONFIDENCE if min_confidence is None else min_confidence
        _write_text(files.pddl, scene_problem(scene, least, goal))
        _write_text(domain_path(files.pddl), planning_domain(scene.words))
    if files.dot is not None:
        from lifelore.perception.scene_graph import to_dot

        _write_text(files.dot, to_dot(scene, min_confidence or 0.0))
    if files.plot is not None:
        from lifelore.figures.scenes.scene_picture import draw_scene
        from lifelore.figures.style import save_figure

        save_figure(draw_scene(scene.cloud, document), files.plot)
    if files.masks_out is not None and labels is not None:
        _write_image(files.masks_out, labels)
    if files.log is not None and files.recorder is not None:
        with refused_writes(files.log):
            files.recorder(files.log, scene, document)


def _write_text(path: str, text: str) -> None:
    with refused_writes(path):
        Path(path).write_text(text, encoding="utf-8")


def _write_image(path: str, numbers: "NDArray[np.uint16]") -> None:
    from PIL import Image

    with refused_writes(path):
        Image.fromarray(numbers).save(path)
