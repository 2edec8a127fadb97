"""Perceives a cloud or a depth image that arrives as bytes; the planning problem and graph come back as text."""

from collections.abc import Mapping
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from lifelore.agent.perceive.perceive import PerceiveSettings, perceive
from lifelore.agent.perceive.scene_files import domain_path
from lifelore.agent.perceive.source_files import SourceFiles
from lifelore.core.errors import NotFoundError

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
        ``cloud``; or ``depth`` with ``intrinsics`` (JSON or YAML) and, if known, ``colour``.
    options : mapping
        Fields of `PerceiveSettings`: ``up``, ``units``, ``labels``, ``min_confidence``, ``goal``.
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
    if kind != "depth" and kind not in KINDS:
        raise NotFoundError(f"format must be one of {', '.join(KINDS)}, got '{kind[:40]}'")
    with TemporaryDirectory() as folder:
        names = {
            "cloud": KINDS.get(kind, ""),
            "depth": "depth.png",
            "intrinsics": "intrinsics",
            "colour": "colour",
        }
        paths = {part: str(Path(folder) / names[part]) for part in parts}
        for part, path in paths.items():
            Path(path).write_bytes(parts[part])
        beside = SourceFiles(paths.get("intrinsics"), paths.get("colour"), depth_scale)
        problem, graph = f"{folder}/problem.pddl", f"{folder}/graph.dot"
        settings = PerceiveSettings(beside=beside, **options)
        document = perceive(paths["cloud" if kind != "depth" else "depth"], settings, pddl=problem, dot=graph)
        document["pddl"] = {"domain": _text(domain_path(problem)), "problem": _text(problem)}
        document["dot"] = _text(graph)
    return document


def _text(path: str) -> str:
    return Path(path).read_text(encoding="utf-8")
