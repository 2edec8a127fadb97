"""Marks on the picture of a scene: networks, contacts, holes, labels, and arrows for relations."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.figures.scenes.camera_projection import PictureCamera
from lifelore.figures.scenes.object_palette import mixed
from lifelore.figures.scenes.scene_document import Bond, SceneDocument
from lifelore.figures.style import INK, PAPER, YELLOW

if TYPE_CHECKING:
    from matplotlib.axes import Axes

LABEL_TEXT, LABEL_RADIUS = 8.5, 7.5
"""Height of a label's text and half that of its patch, points."""
_HALO = 1.4
"""Points of light on each side of a line, so that it reads on any ground."""


def draw_networks(
    axes: "Axes", scene: SceneDocument, camera: PictureCamera, palette: Mapping[int, str], scale: float = 1.0
) -> None:
    """Contact points as open circles, each network's edges as thick lines, contacts between objects dashed."""
    for ends in scene.contact_edges:
        _line(axes, camera.project(ends)[0], INK, 1.1 * scale, linestyle=(0, (2.2, 1.4)), zorder=4)
    for number, network in scene.networks.items():
        at, _ = camera.project(network.at)
        colour = mixed(palette.get(number, INK), INK, 0.45)
        for edge in network.edges:
            _line(axes, at[edge], colour, 2.6 * scale, zorder=5)
        axes.plot(*at.T, "o", ms=9.6 * scale, color=PAPER, mew=0, alpha=0.85, zorder=5.5)
        axes.plot(*at.T, "o", ms=6.6 * scale, mfc="none", mec=colour, mew=1.7 * scale, zorder=6)


def draw_holes(axes: "Axes", scene: SceneDocument, camera: PictureCamera) -> None:
    """Each hole as a shaded, hatched face."""
    from matplotlib.patches import Polygon

    for corners in scene.holes:
        at, _ = camera.project(corners)
        if len(at) >= 3 and np.isfinite(at).all():
            axes.add_patch(Polygon(at, facecolor=YELLOW, edgecolor="none", alpha=0.45, zorder=3))
            axes.add_patch(Polygon(at, facecolor="none", edgecolor=INK, hatch="////", lw=0, alpha=0.5, zorder=3.1))


def draw_label(axes: "Axes", at: ArrayLike, text: str, colour: str, *, size: float = LABEL_TEXT) -> None:
    """A name on a rounded patch of its object's colour."""
    x, y = np.asarray(at, float)
    axes.text(
        x, y, text, ha="center", va="center_baseline", fontsize=size, fontweight="bold", color=PAPER, zorder=9,
        clip_on=False,
        bbox={"boxstyle": "circle,pad=0.22" if len(text) < 2 else "round,pad=0.22,rounding_size=0.75",
              "facecolor": mixed(colour, INK, 0.3), "edgecolor": PAPER, "linewidth": 1.2},
    )  # fmt: skip


def label_size(text: str, size: float = LABEL_TEXT) -> tuple[float, float]:
    """Width and height of `draw_label`'s patch, points."""
    return max(1.75 * size, (0.72 * len(text) + 0.6) * size), 1.75 * size


def draw_arrow(
    axes: "Axes", start: ArrayLike, end: ArrayLike, bond: Bond, *,
    shrink: float = LABEL_RADIUS + 2, bend: float = 0.0, scale: float = 1.0,
) -> None:  # fmt: skip
    """One relation from `start` to `end`: *on* a solid arrow, *adjacent* a double dash, *both* the two together.

    Surer is darker and thicker. Any other relation is a dotted arrow.
    """
    from matplotlib.patheffects import Normal, Stroke

    colour, width = mixed(INK, PAPER, 0.65 * (1 - bond.confidence)), scale * (0.6 + 0.9 * bond.confidence)
    shrink = shrink * scale
    shape: dict[str, Any] = {"shrinkA": shrink, "shrinkB": shrink, "connectionstyle": f"arc3,rad={bend}"}
    if bond.relation in ("adjacent", "both"):
        apart = scale * (3.6 if bond.relation == "both" else 1.6)
        dashes = (0, (5 / (2 * width + apart), 2.2 / (2 * width + apart)))
        _arrow(axes, start, end, "-", PAPER, 2 * width + apart + 2, 7, alpha=0.85, **shape)
        _arrow(axes, start, end, "-", colour, 2 * width + apart, 7.1, linestyle=dashes, **shape)
        _arrow(axes, start, end, "-", PAPER, apart, 7.2, **shape)
    if bond.relation != "adjacent":
        style = "-" if bond.relation in ("on", "both") else (0, (1, 1.5))
        halo = [Stroke(linewidth=width + 2 * _HALO, foreground=PAPER, alpha=0.85), Normal()]
        _arrow(axes, start, end, "-|>", colour, width, 7.3, linestyle=style, path_effects=halo, **shape)
        # The head's halo cuts the shaft; drawn again, they meet.
        _arrow(axes, start, end, "-", colour, width, 7.4, linestyle=style, **shape | {"shrinkB": shrink + 4})


def _arrow(
    axes: "Axes",
    start: ArrayLike,
    end: ArrayLike,
    style: str,
    colour: str,
    width: float,
    order: float,
    **shape: Any,
) -> None:
    from matplotlib.patches import FancyArrowPatch

    patch = FancyArrowPatch(
        tuple(np.asarray(start, float)), tuple(np.asarray(end, float)), arrowstyle=style, mutation_scale=8,
        color=colour, linewidth=width, zorder=order, capstyle="butt", joinstyle="miter", **shape,
    )  # fmt: skip
    axes.add_patch(patch)


def bends(bonds: Sequence[Bond]) -> list[float]:
    """How far to bend each arrow: straight, but two between the same objects bow apart."""
    pairs = [frozenset((bond.a, bond.b)) for bond in bonds]
    return [0.28 if pairs.count(pair) > 1 else 0.0 for pair in pairs]


def _line(
    axes: "Axes", at: NDArray[np.float64], colour: str, width: float, *, zorder: float, **style: Any
) -> None:
    axes.plot(
        *at.T, color=PAPER, linewidth=width + 2 * _HALO, alpha=0.8, zorder=zorder - 0.1, solid_capstyle="round"
    )
    axes.plot(*at.T, color=colour, linewidth=width, zorder=zorder, **style)
