"""Perceives a cloud or a depth image that arrives as bytes; the planning problem and graph come back as text."""

from collections.abc import Mapping
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any

from lifelore.agent.perceive.perceive import PerceiveSettings, scene_and_document
from lifelore.agent.perceive.scene_bytes import scene_bytes
from lifelore.agent.perceive.source_files import SourceFiles
from lifelore.core.errors import NotFoundError
from lifelore.perception.reasoning.planning_domain import planning_domain
from lifelore.perception.reasoning.planning_problem import scene_problem
from lifelore.perception.reasoning.planning_state import PLAN_CONFIDENCE
from lifelore.perception.scene_graph import to_dot

if TYPE_CHECKING:
    from lifelore.perception.scene import Scene

KINDS = {"pcd": "cloud.pcd", "ply": "cloud.ply", "npz": "cloud.npz", "npy": "cloud.npy"}
"""Names of uploaded clouds by their kind."""


def perceive_upload(
    kind: str, parts: Mapping[str, bytes], options: Mapping[str, Any], depth_scale: float | None = None
) -> dict[str, Any]:
    """Perceive a scene from uploaded files.

    Parameters
    ----------
    kind : str
        One of `KINDS`, or ``depth``.
    parts : mapping of str to bytes
        ``cloud``; or ``depth`` with ``intrinsics`` (JSON or YAML) and, if known, ``colour`` and ``masks``.
    options : mapping
        Fields of `PerceiveSettings`: ``up``, ``units``, ``labels``, ``min_confidence``, ``goal``,
        ``with_masks``, ``planner``, ``region``.
    depth_scale : float, optional
        Metres for each unit of depth.

    Returns
    -------
    dict
        The document of `perceive`, and ``pddl`` with ``domain`` and ``problem``, and ``dot``.

    Raises
    ------
    NotFoundError
        There is no such kind.
    InputError
        An upload or option breaks its rule.
    """
    return _perceived(kind, parts, options, depth_scale)[1]


def perceive_upload_with_points(
    kind: str, parts: Mapping[str, bytes], options: Mapping[str, Any], depth_scale: float | None = None
) -> bytes:
    """The points of an uploaded scene and its document, see `scene_bytes`; errors as in `perceive_upload`."""
    return scene_bytes(*_perceived(kind, parts, options, depth_scale))


def _perceived(
    kind: str, parts: Mapping[str, bytes], options: Mapping[str, Any], depth_scale: float | None
) -> "tuple[Scene, dict[str, Any]]":
    if kind != "depth" and kind not in KINDS:
        raise NotFoundError(f"format must be one of {', '.join(KINDS)}, got '{kind[:40]}'")
    with TemporaryDirectory() as folder:
        names = {
            "cloud": KINDS.get(kind, ""),
            "depth": "depth.png",
            "intrinsics": "intrinsics",
            "colour": "colour",
            "masks": "masks",
        }
        paths = {part: str(Path(folder) / names[part]) for part in parts}
        for part, path in paths.items():
            Path(path).write_bytes(parts[part])
        beside = SourceFiles(paths.get("intrinsics"), paths.get("colour"), depth_scale, paths.get("masks"))
        settings = PerceiveSettings(beside=beside, **options)
        source = paths["cloud" if kind != "depth" else "depth"]
        _, scene, document = scene_and_document(source, settings=settings)
    least = PLAN_CONFIDENCE if settings.min_confidence is None else settings.min_confidence
    problem = scene_problem(scene, least, settings.statements)
    document["pddl"] = {"domain": planning_domain(scene.words), "problem": problem}
    document["dot"] = to_dot(scene, settings.min_confidence or 0.0)
    return scene, document
