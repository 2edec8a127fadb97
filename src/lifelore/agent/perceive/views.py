"""Perceives several views of one scene as one cloud (`lifelore perceive A B --poses FILE`)."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from lifelore.agent.perceive.perceive import (
    DEFAULT,
    PerceiveSettings,
    Source,
    check_settings,
    files_read,
    model_of,
    perceived,
    read_scene,
)
from lifelore.agent.perceive.scene_files import SceneFiles, check_scene_files
from lifelore.agent.perceive.source_files import NO_SOURCE_FILES
from lifelore.core.errors import InputError
from lifelore.core.protocols import Progress
from lifelore.perception.clouds.fused_views import fused
from lifelore.perception.clouds.point_cloud import PointCloud
from lifelore.perception.clouds.pose_file import read_poses

POSE_DIGITS = 6


def perceive_views(
    sources: Sequence[str],
    settings: PerceiveSettings = DEFAULT,
    *,
    poses: str,
    pddl: str | None = None,
    dot: str | None = None,
    plot: str | None = None,
    read: Callable[[str], Source] | None = None,
    progress: Progress | None = None,
    notice: Callable[[str], None] | None = None,
) -> dict[str, Any]:
    """Perceive a scene seen in several clouds.

    Parameters
    ----------
    sources : sequence of str
        Two or more clouds or depth images, as for `perceive`. Their labels, if any, name the same objects.
    settings : PerceiveSettings
        `up` is a direction in the first view's frame. Masks are refused: each view has its own numbers.
    poses : str
        File of the views' poses, see `read_poses`.
    pddl, dot, plot, progress, notice
        As for `perceive`.
    read : callable, optional
        Maps one of `sources` to a source for `perceive`.

    Returns
    -------
    dict
        As of `perceive`, and ``views``: for each view ``source``, ``points`` (number of measured points) and
        ``pose`` (4 × 4, from the view's frame to the first view's).

    Raises
    ------
    InputError
        As for `perceive`; fewer than two views, or only some of them have labels.
    """
    if len(sources) < 2:
        raise InputError(f"poses (--poses) join two or more clouds, got {len(sources)}: leave them out")
    if settings.beside.masks is not None:
        raise InputError(
            "masks number the objects of each view differently: leave out --masks, or give labelled clouds"
        )
    settings.beside.check_for_many()
    files = SceneFiles(pddl, dot, plot)
    check_settings(settings, pddl)
    check_scene_files(files, [*files_read(sources, settings), poses])
    given = read_poses(poses, len(sources))
    model = model_of(settings)
    clouds = [_read(source, settings, read) for source in sources]
    whole = fused(clouds, given)
    document = perceived(whole, model, replace(settings, beside=NO_SOURCE_FILES), files, progress, notice)
    to_first = np.linalg.inv(given[0]) @ given
    document["views"] = [
        {
            "source": source,
            "points": int(np.count_nonzero(cloud.measured)),
            "pose": pose.round(POSE_DIGITS).tolist(),
        }
        for source, cloud, pose in zip(sources, clouds, to_first, strict=True)
    ]
    return document


def _read(source: str, settings: PerceiveSettings, read: Callable[[str], Source] | None) -> PointCloud:
    return read_scene(source if read is None else read(source), settings)
