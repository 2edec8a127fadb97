"""The three layers of one scene: its cloud, its contact point networks, its predicates (thesis Fig 2.8).

``python -m docs.pictures.scene_layers`` draws a simulated scene to ``docs/pictures``; it needs the
extra ``sim``.
"""

from collections.abc import Mapping
from pathlib import Path

from lifelore.core.labelled_cloud import TABLE, LabelledCloud
from lifelore.figures.scenes.scene_document import TABLE_NAME, Bond, read_document
from lifelore.figures.scenes.scene_picture import draw_scene_on
from lifelore.figures.style import GREY, LIGHT, house_style, new_figure, save_figure

PATH = Path("docs/pictures/scene_layers.png")
_PICTURE = (2.95, 2.21)
_GUTTER, _HEAD, _MOST = 0.12, 0.3, 14


def draw_layers(cloud: LabelledCloud, document: Mapping):
    """The figure, the lowest layer first; arguments as of `scene_picture.sample_scene`."""
    bonds = read_document(document).bonds
    text = 0.15 * ((min(len(bonds), 2 * _MOST) + 1) // 2) + 0.15
    width, height = 3 * (_PICTURE[0] + _GUTTER) + _GUTTER, _HEAD + _PICTURE[1] + text + _GUTTER
    panels = (
        ("1  point cloud", ("cloud",)),
        ("2  contact point networks", ("networks",)),
        ("3  predicates", ("relations",)),
    )
    with house_style():
        figure = new_figure(width, height)
        figure.set_layout_engine("none")
        for place, (title, layers) in enumerate(panels):
            left = _GUTTER + place * (_PICTURE[0] + _GUTTER)
            low = height - _HEAD - _PICTURE[1]
            axes = figure.add_axes((left / width, low / height, _PICTURE[0] / width, _PICTURE[1] / height))
            draw_scene_on(axes, cloud, document, _PICTURE, layers)
            axes.set_title(title, fontsize=9.5, pad=5)
            axes.set_axis_on()
            axes.set(xticks=[], yticks=[])
            axes.spines[:].set(visible=True, color=LIGHT)
            if "relations" in layers:
                _write(axes, bonds)
            else:
                axes.text(0, -0.03, _summary(cloud, document, layers), transform=axes.transAxes, fontsize=7.5,
                          color=GREY, va="top")  # fmt: skip
    return figure


def predicate(bond: Bond) -> str:
    """``relation(a, b)``, the table by its name."""
    a, b = (TABLE_NAME if number == TABLE else str(number) for number in (bond.a, bond.b))
    return f"{bond.relation}({a}, {b})"


def _write(axes, bonds: tuple[Bond, ...]) -> None:
    """The predicates in two columns under their picture."""
    rows = (min(len(bonds), 2 * _MOST) + 1) // 2
    for place, bond in enumerate(bonds[: 2 * _MOST]):
        at = (0.0 if place < rows else 0.5, -0.03)
        axes.annotate(
            predicate(bond), at, (0, -10.8 * (place % rows)), xycoords="axes fraction", textcoords="offset points",
            fontsize=7.5, va="top", family="DejaVu Sans Mono", alpha=0.45 + 0.55 * bond.confidence,
        )  # fmt: skip


def _summary(cloud: LabelledCloud, document: Mapping, layers: tuple[str, ...]) -> str:
    if "cloud" in layers:
        return f"{len(cloud.points):,} points of {len(cloud.objects)} objects"
    scene = read_document(document)
    nodes = sum(len(network.at) for network in scene.networks.values())
    edges = sum(len(network.edges) for network in scene.networks.values())
    return f"{nodes} contact points, {edges} edges within objects, {len(scene.contact_edges)} between"


def simulated_scene(seed: int = 3, objects: int = 4) -> tuple[LabelledCloud, dict]:
    """A simulated cloud of some objects, and its perceived scene as a document."""
    from lifelore.domains.tabletop.tabletop import TabletopSettings, sample_scene
    from lifelore.perception.scene_json import scene_document
    from lifelore.perception.scene_perception import perceived_scene

    cloud = sample_scene(seed, 0, TabletopSettings(n_objects=(objects, objects), shapes="all")).cloud
    return cloud, scene_document(perceived_scene(cloud).without_unrelated_contacts)


if __name__ == "__main__":
    print(save_figure(draw_layers(*simulated_scene()), PATH))
