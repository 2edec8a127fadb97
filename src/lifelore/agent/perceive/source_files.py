"""Files beside a cloud: the camera's intrinsics and colours of a depth image, and masks of objects."""

import os
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

from lifelore.agent.perceive.scene_files import NAME
from lifelore.core.errors import InputError
from lifelore.perception.clouds.cloud_file import read_cloud
from lifelore.perception.clouds.point_cloud import PointCloud

if TYPE_CHECKING:
    from lifelore.perception.segmentation.table_frame import Up

CLOUD_SUFFIXES = (".pcd", ".ply", ".npz")


@dataclass(frozen=True)
class SourceFiles:
    """Files that belong to a cloud or a depth image.

    In the names of files, ``{name}`` stands for the name of the cloud's or depth image's file without its suffix.

    Parameters
    ----------
    intrinsics : str, optional
        Makes the source a depth image, see `depth_file.read_depth_image`.
    colour : str, optional
        Colour image aligned with the depth image.
    depth_scale : float, optional
        Metres for each unit of depth.
    masks : str, optional
        Masks of the objects, see `mask_file.read_masks`.
    table_mask : int, optional
        Number of the table's mask. Default: the table is searched for among the points without a mask.

    Raises
    ------
    InputError
        `colour` or `depth_scale` without `intrinsics`, or `table_mask` without `masks`, or a number out of range.
    """

    intrinsics: str | None = None
    colour: str | None = None
    depth_scale: float | None = None
    masks: str | None = None
    table_mask: int | None = None

    def __post_init__(self) -> None:
        for option, flag in (("colour", "--colour"), ("depth_scale", "--set depth_scale=S")):
            if getattr(self, option) is not None and self.intrinsics is None:
                raise InputError(
                    f"{option} ({flag}) belongs to a depth image: give its intrinsics"
                    " (--intrinsics FILE), or leave it out"
                )
        if self.table_mask is not None and self.masks is None:
            raise InputError(
                "table_mask (--set table_mask=N) is the number of a mask: give --masks FILE, or leave it out"
            )
        if self.table_mask is not None and self.table_mask < 1:
            raise InputError(f"table_mask must be the number of a mask, from 1, got {self.table_mask}")

    @property
    def paths(self) -> tuple[str, ...]:
        """All files."""
        return tuple(path for path in (self.intrinsics, self.colour, self.masks) if path is not None)

    def of(self, source: object) -> "SourceFiles":
        """The files of a source: ``{name}`` is replaced by the name of its file without suffix."""
        if not any(NAME in path for path in self.paths):
            return self
        if not isinstance(source, str | os.PathLike):
            raise InputError(f"{NAME} in a file's name needs a cloud from a file: write the name")
        stem = Path(source).stem

        def named(path: str | None) -> str | None:
            return None if path is None else path.replace(NAME, stem)

        return replace(self, intrinsics=named(self.intrinsics), colour=named(self.colour), masks=named(self.masks))

    def check_for_many(self) -> None:
        """Refuse a colour image or masks that would be the same for several clouds."""
        for option, path in (("colour", self.colour), ("masks", self.masks)):
            if path is not None and NAME not in path:
                raise InputError(
                    f"{option} names one file for many clouds, '{path}': write {NAME} for the name of each cloud,"
                    f" such as --{option} {option}/{NAME}.png"
                )


NO_SOURCE_FILES = SourceFiles()


def read_source(source: object, units: str, labels: str, up: "Up", files: SourceFiles) -> PointCloud:
    """Read a cloud or a depth image, with its colours and masks.

    Parameters
    ----------
    source : path, array or PointCloud
    units, labels : str
        As in `read_cloud`; a depth image has neither.
    up : "table", "z" or (3,) numbers
        As in `to_scene`.
    files : SourceFiles

    Raises
    ------
    InputError
        A file breaks its rule, or intrinsics are given for a source that is no depth image.
    """
    files = files.of(source)
    if files.intrinsics is not None:
        cloud = _depth_image(source, units, files)
    elif isinstance(source, PointCloud):
        cloud = source
    else:
        cloud = read_cloud(source, units=units, labels=labels)  # type: ignore[arg-type]
    if files.masks is None:
        return cloud
    from lifelore.perception.clouds.mask_file import read_masks

    masked = read_masks(files.masks, cloud, files.table_mask)
    if files.table_mask is not None:
        return masked
    from lifelore.perception.segmentation.table_labels import with_table

    return with_table(masked, up)


def _depth_image(source: object, units: str, files: SourceFiles) -> PointCloud:
    if not isinstance(source, str | os.PathLike) or Path(source).suffix.lower() in CLOUD_SUFFIXES:
        named = f"'{source}'" if isinstance(source, str | os.PathLike) else "this source"
        raise InputError(
            f"intrinsics (--intrinsics) belong to a depth image, a 16-bit PNG or an npy file, but {named} is a"
            " cloud: leave them out"
        )
    if units != "m":
        raise InputError(f"units (--units {units}) are for clouds: give a depth image --set depth_scale=S instead")
    from lifelore.perception.clouds.depth_file import read_depth_image

    return read_depth_image(source, str(files.intrinsics), colour=files.colour, depth_scale=files.depth_scale)
