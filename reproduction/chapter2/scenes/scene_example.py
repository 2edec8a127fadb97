"""A perceived scene as a row of a result, small enough to be committed, and the picture of such rows."""

import base64
import zlib
from collections.abc import Collection, Mapping, Sequence
from typing import Any

import numpy as np

from lifelore.core.labelled_cloud import TABLE, LabelledCloud
from lifelore.figures.scenes.scene_picture import draw_scene_on
from lifelore.figures.style import Figure, new_figure
from lifelore.perception.clouds.voxel import voxelised
from lifelore.perception.scene import Scene
from lifelore.perception.scene_json import scene_document
from reproduction.chapter2.scenes.perturbation import part_of

MOST_POINTS = 4000
_STEP = 0.0005
"""Metres: places are stored to half a millimetre."""
_AROUND = 0.05
"""Metres of table stored around the objects."""
_WIDTH, _WIDEST, _GUTTER, _CAPTION = 9.2, 4.45, 0.1, 0.26
"""Inches: of a figure, of a picture at most, between pictures, and for a caption above each."""


def scene_row(scene: Scene, caption: str) -> dict:
    """``{"example": caption, "camera", "cloud", "document"}``, plain data of some 30 kB."""
    cloud, whole = _thinned(_trimmed(scene.cloud)), scene_document(scene)
    document: dict[str, Any] = {
        "objects": [
            {
                "id": item["id"],
                "contact_points": [{"xyz": _short(node["xyz"])} for node in item["contact_points"]],
                "edges": item["edges"],
            }
            for item in whole["objects"]
        ],
        "relations": whole["relations"],
        "holes": [{"outline": [_short(place) for place in hole["outline"]]} for hole in whole["holes"]],
        "contact_edges": whole["contact_edges"],
    }
    camera = None if cloud.camera is None else _short(cloud.camera)
    return {"example": caption, "camera": camera, "cloud": _packed(cloud), "document": document}


def scene_of_row(row: Mapping) -> tuple[LabelledCloud, Mapping, str]:
    """The cloud of an example, its document and its caption."""
    table = np.frombuffer(zlib.decompress(base64.b64decode(row["cloud"])), np.int16).reshape(4, -1)
    camera = None if row["camera"] is None else np.array(row["camera"], float)
    cloud = LabelledCloud(np.asarray(table[:3].T * _STEP, np.float64), table[3].astype(np.int64), None, camera)
    return cloud, row["document"], row["example"]


def draw_examples(result: Mapping, layers: Collection[str] = ("cloud", "networks")) -> Figure:
    """The pictures of a result's examples, two a row; `layers` are some of `scene_picture.LAYERS`."""
    return draw_scenes([scene_of_row(row) for row in result["rows"] if "example" in row], 2, layers)


def draw_scenes(
    scenes: Sequence[tuple[LabelledCloud, Mapping, str]], columns: int, layers: Collection[str]
) -> Figure:
    """Clouds with their documents and captions in a grid."""
    columns, rows = min(columns, len(scenes)), -(-len(scenes) // columns)
    wide = min(_WIDEST, (_WIDTH - (columns + 1) * _GUTTER) / columns)
    high = 0.75 * wide
    width, height = columns * (wide + _GUTTER) + _GUTTER, rows * (high + _CAPTION + _GUTTER) + _GUTTER
    figure = new_figure(width, height)
    figure.set_layout_engine("none")
    for place, (cloud, document, caption) in enumerate(scenes):
        left = _GUTTER + place % columns * (wide + _GUTTER)
        top = height - _GUTTER - _CAPTION - place // columns * (high + _CAPTION + _GUTTER)
        axes = figure.add_axes((left / width, (top - high) / height, wide / width, high / height))
        draw_scene_on(axes, cloud, document, (wide, high), layers)
        axes.set_title(caption, fontsize=8.5, pad=4)
    return figure


def _packed(cloud: LabelledCloud) -> str:
    places = np.round(cloud.points / _STEP)
    order = np.lexsort((*places.T, cloud.labels))
    table = np.column_stack([places, cloud.labels])[order].T.astype(np.int16)
    return base64.b64encode(zlib.compress(np.ascontiguousarray(table).tobytes(), 9)).decode()


def _trimmed(cloud: LabelledCloud) -> LabelledCloud:
    """The objects and the table near them."""
    objects = cloud.points[cloud.labels > TABLE][:, :2]
    low, high = objects.min(axis=0) - _AROUND, objects.max(axis=0) + _AROUND
    inside = ((cloud.points[:, :2] >= low) & (cloud.points[:, :2] <= high)).all(axis=1)
    return part_of(cloud, (cloud.labels > TABLE) | ((cloud.labels == TABLE) & inside))


def _thinned(cloud: LabelledCloud) -> LabelledCloud:
    size = 0.002
    while len(cloud.points) > MOST_POINTS:
        cloud, size = voxelised(cloud, size), size * 1.15
    return cloud


def _short(values) -> list[float]:
    return [round(float(value), 4) for value in values]
