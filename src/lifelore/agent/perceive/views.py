"""Perceives several views of one scene as one cloud (`lifelore perceive A B --poses FILE`, or `--register`)."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any, Unpack

import numpy as np
from numpy.typing import NDArray

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
from lifelore.agent.perceive.scene_files import FileNames, SceneFiles, check_scene_files
from lifelore.agent.perceive.source_files import NO_SOURCE_FILES
from lifelore.core.errors import InputError
from lifelore.core.protocols import Progress
from lifelore.perception.clouds.fused_views import fused
from lifelore.perception.clouds.point_cloud import PointCloud
from lifelore.perception.clouds.pose_file import read_poses

POSE_DIGITS, SHARE_DIGITS = 6, 3


def perceive_views(
    sources: Sequence[str],
    settings: PerceiveSettings = DEFAULT,
    *,
    poses: str | None = None,
    read: Callable[[str], Source] | None = None,
    progress: Progress | None = None,
    notice: Callable[[str], None] | None = None,
    **files: Unpack[FileNames],
) -> dict[str, Any]:
    """Perceive a scene seen in several clouds.

    Parameters
    ----------
    sources : sequence of str
        Two or more clouds or depth images, as for `perceive`. Their labels, if any, name the same objects.
    settings : PerceiveSettings
        `up` is a direction in the first view's frame. Masks are refused: each view has its own numbers.
    poses : str, optional
        File of the views' poses, see `read_poses`. Default: the views are registered, see `registered_views`.
    progress, notice, pddl, dot, plot, log, recorder
        As for `perceive`.
    read : callable, optional
        Maps one of `sources` to a source for `perceive`.

    Returns
    -------
    dict
        As of `perceive`, and ``views``: for each view ``source``, ``points`` (number of measured points) and
        ``pose`` (4 × 4, from the view's frame to the first view's). Registered views also have ``registered_to``,
        the source of the view that this one was laid over, and ``agreement``, the share of the cells with objects
        that both show alike; both are None for the first.

    Raises
    ------
    InputError
        As for `perceive`; fewer than two views, a label image is asked for (`masks_out`), only some of them
        have labels, or no poses are given and the views cannot be registered surely.
    """
    if len(sources) < 2:
        option = "registration (--register)" if poses is None else "poses (--poses)"
        raise InputError(f"{option} joins two or more clouds, got {len(sources)}: leave it out")
    if settings.beside.masks is not None:
        raise InputError(
            "masks number the objects of each view differently: leave out --masks, or give labelled clouds"
        )
    settings.beside.check_for_many()
    asked = SceneFiles(**files)
    if asked.masks_out is not None:
        raise InputError("masks_out (--set masks_out=FILE) is of one image, and views have several: leave it out")
    check_settings(settings, asked.pddl)
    check_scene_files([asked], [*files_read(sources, settings), *([] if poses is None else [poses])])
    given = None if poses is None else read_poses(poses, len(sources))
    model = model_of(settings)
    clouds = [_read(source, settings, read) for source in sources]
    places, beside = (given, []) if given is not None else _registered(clouds, sources, settings, notice)
    whole = fused(clouds, places)
    document = perceived(whole, model, replace(settings, beside=NO_SOURCE_FILES), asked, progress, notice)
    to_first = np.linalg.inv(places[0]) @ places
    document["views"] = [
        {
            "source": source,
            "points": int(np.count_nonzero(cloud.measured)),
            "pose": pose.round(POSE_DIGITS).tolist(),
        }
        for source, cloud, pose in zip(sources, clouds, to_first, strict=True)
    ]
    for view, more in zip(document["views"], beside, strict=False):
        view.update(more)
    return document


def _registered(
    clouds: Sequence[PointCloud],
    sources: Sequence[str],
    settings: PerceiveSettings,
    notice: Callable[[str], None] | None,
) -> tuple[NDArray[np.float64], list[dict[str, Any]]]:
    """Poses (k, 4, 4) from each view's frame to the first's, and what the document says of each registration."""
    from lifelore.perception.registration.registered_views import registered_views
    from lifelore.perception.registration.tabletop_view import tabletop_view
    from lifelore.perception.segmentation.region import Region, inside
    from lifelore.perception.segmentation.table_frame import EVERYWHERE

    views = []
    for source, cloud in zip(sources, clouds, strict=True):
        # A direction and a box are in the first view's frame; a range is from each camera.
        region = settings.region or EVERYWHERE
        own = (settings.up, region) if not views else ("table", Region(max_range=region.max_range))
        try:
            views.append(tabletop_view(inside(cloud, own[1]), own[0]))
        except InputError as error:
            raise InputError(
                f"the view {source} cannot be registered: {error}; give poses (--poses FILE)"
            ) from None
    placed = registered_views(views, sources)
    beside = []
    for source, place in zip(sources, placed, strict=True):
        to = None if place.to is None else sources[place.to]
        share = None if place.agreement is None else round(place.agreement, SHARE_DIGITS)
        beside.append({"registered_to": to, "agreement": share})
        if to is not None and notice is not None:
            notice(f"{source} is registered to {to}: {share:.1%} of what both show agrees")
    return np.stack([place.pose for place in placed]), beside


def _read(source: str, settings: PerceiveSettings, read: Callable[[str], Source] | None) -> PointCloud:
    return read_scene(source if read is None else read(source), settings)
