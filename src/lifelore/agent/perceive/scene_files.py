"""Writes the files of a perceived scene: a planning problem with its domain, a graph, a picture."""

import os
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from lifelore.core.errors import InputError, StoreError

if TYPE_CHECKING:
    from lifelore.perception.reasoning.planning_goal import Statement
    from lifelore.perception.scene import Scene

NAME = "{name}"
"""Placeholder in the name of a file for the name of the cloud."""


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
    """

    pddl: str | None = None
    dot: str | None = None
    plot: str | None = None

    @property
    def paths(self) -> tuple[str, ...]:
        """All files to write, with the domain."""
        domain = None if self.pddl is None else domain_path(self.pddl)
        return tuple(path for path in (self.pddl, domain, self.dot, self.plot) if path is not None)


def domain_path(problem: str) -> str:
    """Path of the domain of a problem file: ``NAME-domain.pddl`` in the same folder."""
    path = Path(problem)
    return str(path.with_name(f"{path.stem}-domain.pddl")) if path.name else ""


def named_files(name: str, pddl: str | None, dot: str | None, plot: str | None) -> SceneFiles:
    """The files of a cloud: the placeholder `NAME` is replaced by the name of the cloud's file without suffix.

    >>> named_files("clouds/cup.pcd", None, "graphs/{name}.dot", None).dot
    'graphs/cup.dot'
    """
    stem = Path(name).stem
    return SceneFiles(*(None if path is None else path.replace(NAME, stem) for path in (pddl, dot, plot)))


def check_names(files: SceneFiles) -> None:
    """Refuse a file name without placeholder, which would be the same for all clouds."""
    for option, path in (("pddl", files.pddl), ("dot", files.dot), ("plot", files.plot)):
        if path is not None and NAME not in path:
            raise InputError(
                f"{option} names one file for many clouds, '{path}': write {NAME} for the name of each cloud,"
                f" such as --{option} {NAME}.{'png' if option == 'plot' else option}"
            )


def check_scene_files(files: SceneFiles, sources: Sequence[str | os.PathLike[str]]) -> None:
    """Refuse files that cannot be written, or that would overwrite each other or the `sources`.

    Raises
    ------
    InputError
        The message names the file.
    """
    check_files_of_scenes([files], sources)


def check_files_of_scenes(many: Iterable[SceneFiles], sources: Sequence[str | os.PathLike[str]]) -> None:
    """As `check_scene_files`, for the files of several scenes."""
    many = [files for files in many if files.paths]
    for files in many:
        for path in files.paths:
            _check_writable(path)
        if files.plot is not None and not files.plot.lower().endswith(".png"):
            raise InputError(f"plot must name a PNG file, such as scene.png, got '{files.plot}'")
    used = {os.path.realpath(path) for path in sources if many}
    for path in (path for files in many for path in files.paths):
        if os.path.realpath(path) in used:
            raise InputError(
                f"'{path}' would be overwritten: the cloud, the model, plot, dot, pddl and the domain beside it"
                " must be different files"
            )
        used.add(os.path.realpath(path))


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
        The goal names a predicate or an object that does not exist; no file is written.
    StoreError
        A file cannot be written.
    """
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


def _write_text(path: str, text: str) -> None:
    try:
        Path(path).write_text(text, encoding="utf-8")
    except OSError as error:
        raise StoreError(f"cannot write {path}: {error.strerror}; choose another folder") from None
