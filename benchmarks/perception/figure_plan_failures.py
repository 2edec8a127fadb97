"""Real scenes with an object that no valid plan fetches: as labelled and as cut, with the reasons."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from lifelore.core.labelled_cloud import TABLE, LabelledCloud
from lifelore.figures.scenes.object_palette import object_palette
from lifelore.figures.scenes.scene_marks import draw_label
from lifelore.figures.scenes.segmentation_panels import segments_picture
from lifelore.figures.style import house_style, new_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_ACROSS = 2
"""Scenes a row, two panels each."""
_PANEL = (2.4, 1.9)
"""Inches: width and height of a picture; the reasons stand below it."""
_SIZE = (216, 171)
"""Pixels of a picture."""
_LINE = 0.16
"""Inches: height of a reason."""


@dataclass(frozen=True, eq=False)
class FailedScene:
    """A scene and what cannot be fetched in it.

    Parameters
    ----------
    name : str
    truth : (n,) int64
        True labels of the points.
    clouds : (labels given, without labels)
        The scene both ways, points in the order of `truth`; None where it could not be cut.
    failures : (labels given, without labels)
        The reason for each object without a valid plan.
    """

    name: str
    truth: NDArray[np.int64]
    clouds: tuple[LabelledCloud, LabelledCloud | None]
    failures: tuple[Mapping[int, str], Mapping[int, str]]


def draw_plan_failures(scenes: Sequence[FailedScene]) -> "Figure":
    """The figure: for each scene the labelled objects and the objects as cut, with the reasons below."""
    rows = -(-len(scenes) // _ACROSS)
    most = max(len(reasons) for scene in scenes for reasons in scene.failures)
    with house_style():
        figure = new_figure(2 * _ACROSS * _PANEL[0], rows * (_PANEL[1] + _LINE * (most + 1.5)) + 0.4)
        places = np.reshape(np.asarray(figure.subplots(rows, 2 * _ACROSS)), (-1, 2))
        for place in places.ravel():
            place.set_axis_off()
        for pair, scene in zip(places, scenes, strict=False):
            for place, how, cloud, reasons in zip(
                pair, ("labels given", "without labels"), scene.clouds, scene.failures, strict=True
            ):
                _panel(place, scene.truth, cloud)
                place.set_title(f"{scene.name}, {how}", fontsize=8)
                place.text(
                    0, -0.04, _listed(reasons, most), va="top", fontsize=7, transform=place.transAxes,
                )  # fmt: skip
        figure.suptitle("Objects that no valid plan fetches, and the reasons")
    return figure


def _panel(place: "Axes", truth: NDArray[np.int64], cloud: LabelledCloud | None) -> None:
    """A scene with the numbers of its true objects."""
    if cloud is None:
        return
    picture, camera = segments_picture(truth, cloud, _SIZE)
    place.imshow(picture)
    things = [int(thing) for thing in np.unique(truth) if thing > TABLE]
    palette = object_palette(range(2, 2 + max(things)))
    for thing in things:
        pixels, _ = camera.project(cloud.points[truth == thing])
        draw_label(place, np.nanmedian(pixels, axis=0), str(thing), palette[thing], size=6)


def _listed(reasons: Mapping[int, str], most: int) -> str:
    """A line for each object, filled up to `most` lines, so that all panels take the same space."""
    lines = [f"{thing}: {reason}" for thing, reason in sorted(reasons.items())] or ["all fetched"]
    return "\n".join(lines + [" "] * (most - len(lines)))
