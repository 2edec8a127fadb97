"""A scene as its camera saw it, with contact point networks and relations drawn upon it (thesis Figs 2.1, 2.7)."""

from collections.abc import Collection, Mapping
from typing import TYPE_CHECKING

import numpy as np

from lifelore.core.labelled_cloud import LabelledCloud
from lifelore.figures.label_placement import place_labels
from lifelore.figures.scenes.camera_projection import PictureCamera, camera_of
from lifelore.figures.scenes.cloud_image import CloudImage, render_cloud
from lifelore.figures.scenes.object_palette import object_palette
from lifelore.figures.scenes.relation_list import draw_relation_list
from lifelore.figures.scenes.scene_document import SceneDocument, read_document
from lifelore.figures.scenes.scene_marks import (
    LABEL_TEXT,
    bends,
    draw_arrow,
    draw_holes,
    draw_label,
    draw_networks,
    label_size,
)
from lifelore.figures.style import house_style, new_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_PICTURE, _LIST, _GUTTER = (6.4, 4.8), 2.5, 0.15
"""Inches: the picture's width and height, the list's width, and the space about both."""
LAYERS = ("cloud", "networks", "relations")
"""The three layers of a scene's description (thesis Fig 2.8)."""
_CROWD = 9
"""Objects beyond which marks are drawn smaller."""
_GHOST = 0.16
"""Opacity of the cloud under other layers."""
_RESOLUTION = 180
"""Pixels an inch of the picture: as many as the file's, so that its tones stay few and the file small."""


def draw_scene(cloud: LabelledCloud, document: Mapping, *, title: str | None = None) -> "Figure":
    """The figure of `lifelore perceive --plot`.

    Each object in a colour of its own; contact points as open circles, the edges of its network as thick lines,
    contacts between objects dashed, holes hatched. A relation is drawn between the objects' labels: *on* a solid
    arrow, *adjacent* a double dash, *both* the two together, surer ones darker; beside the picture is the list.

    Parameters
    ----------
    cloud : LabelledCloud
        Seen from its camera; from the front right and above if it names none.
    document : mapping
        What `lifelore perceive --json` prints, and optionally ``"contact_edges"``: pairs of
        ``[object, contact point]``. Objects are numbered as in `cloud`, the table is ``"table"``.
    title : str, optional
        Heading of the list; by default the number of objects and relations.

    Raises
    ------
    InputError
        An edge of the document names a contact point that it does not hold.
    """
    scene = read_document(document)
    palette = _palette(cloud, scene)
    with house_style():
        figure = new_figure(_PICTURE[0] + _LIST + 3 * _GUTTER, _PICTURE[1] + 2 * _GUTTER)
        figure.set_layout_engine("none")
        picture = _place(figure, _GUTTER, _PICTURE[0])
        _draw(picture, cloud, scene, palette, _PICTURE)
        listing = _place(figure, 2 * _GUTTER + _PICTURE[0], _LIST)
        size = (72 * _LIST, 72 * _PICTURE[1])
        draw_relation_list(listing, scene.bonds, palette, size, title or _heading(palette, scene))
    return figure


def draw_scene_on(
    axes: "Axes",
    cloud: LabelledCloud,
    document: Mapping,
    size: tuple[float, float],
    layers: Collection[str] = LAYERS,
) -> None:
    """The picture alone, within a larger figure.

    Parameters
    ----------
    axes : matplotlib axes
    cloud, document
        As of `draw_scene`.
    size : (width, height)
        Of the axes, inches; fixes how finely the cloud is drawn and how far labels keep apart.
    layers : collection of str
        Which of `LAYERS` to draw; without the cloud the others stand on its ghost.
    """
    scene = read_document(document)
    _draw(axes, cloud, scene, _palette(cloud, scene), size, layers)


def _draw(
    axes: "Axes", cloud: LabelledCloud, scene: SceneDocument, palette: dict[int, str], inches: tuple[float, float],
    layers: Collection[str] = LAYERS,
) -> None:  # fmt: skip
    size = (round(inches[0] * _RESOLUTION), round(inches[1] * _RESOLUTION))
    contacts = np.vstack([np.empty((0, 3)), *(network.at for network in scene.networks.values())])
    camera = camera_of(cloud, size, contacts)
    image = render_cloud(cloud, camera, palette)
    crowd = np.sqrt(_CROWD / max(_CROWD, len(palette)))
    scale = float(np.clip(crowd * inches[0] / _PICTURE[0], 0.65, 1))
    opacity = 1.0 if "cloud" in layers else _GHOST
    axes.imshow(
        image.colours, extent=(0, size[0], size[1], 0), interpolation="antialiased", zorder=0, alpha=opacity
    )
    axes.set(xlim=(0, size[0]), ylim=(size[1], 0), aspect="equal")
    axes.set_axis_off()
    if "networks" in layers:
        draw_holes(axes, scene, camera)
        draw_networks(axes, scene, camera, palette, scale)
    if "relations" in layers:
        _draw_relations(axes, image, scene, camera, palette, scale)


def _draw_relations(
    axes: "Axes",
    image: CloudImage,
    scene: SceneDocument,
    camera: PictureCamera,
    palette: dict[int, str],
    scale: float,
) -> None:
    labels = _labels_at(image, scene, camera, palette, scale)
    between = [bond for bond in scene.bonds if {bond.a, bond.b} <= labels.keys()]
    for bond, bend in zip(between, bends(between), strict=True):
        draw_arrow(axes, labels[bond.a], labels[bond.b], bond, bend=bend, scale=scale)
    for number, at in labels.items():
        draw_label(axes, at, str(number), palette[number], size=LABEL_TEXT * scale)


def _labels_at(
    image: CloudImage, scene: SceneDocument, camera: PictureCamera, palette: dict[int, str], scale: float
) -> dict[int, np.ndarray]:
    """Where each object's label goes; an object of which nothing is seen has none."""
    anchors = {}
    for number in palette:
        seen = np.argwhere(image.labels == number)
        if len(seen):
            anchors[number] = np.median(seen, axis=0)[::-1]
    points = _RESOLUTION / 72
    sizes = [np.array(label_size(str(number), LABEL_TEXT * scale)) * points for number in anchors]
    marks = [camera.project(network.at)[0] for network in scene.networks.values()]
    at = place_labels(
        list(anchors.values()), sizes, camera.size,
        marks=np.vstack([np.empty((0, 2)), *marks]), grounds=image.labels, owners=list(anchors),
    )  # fmt: skip
    return dict(zip(anchors, at, strict=True))


def _palette(cloud: LabelledCloud, scene: SceneDocument) -> dict[int, str]:
    return object_palette(set(cloud.objects) | set(scene.networks))


def _heading(palette: dict[int, str], scene: SceneDocument) -> str:
    n_objects, n_relations = len(palette), len(scene.bonds)
    return f"{n_objects} object{'s' * (n_objects != 1)}, {n_relations} relation{'s' * (n_relations != 1)}"


def _place(figure: "Figure", left: float, width: float) -> "Axes":
    total, height = figure.get_size_inches()
    return figure.add_axes((left / total, _GUTTER / height, width / total, _PICTURE[1] / height))
