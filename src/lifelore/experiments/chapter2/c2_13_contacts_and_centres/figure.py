"""Networks with every contact and with strong ones, nodes by kernel, how often *on* is told (thesis Fig 2.1)."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from lifelore.core.labelled_cloud import LabelledCloud
from lifelore.experiments.chapter2.c2_13_contacts_and_centres.measure import (
    CENTRES,
    CONTACTS,
    OURS,
)
from lifelore.experiments.chapter2.method_bars import draw_bars
from lifelore.experiments.chapter2.pair_validation import THRESHOLD
from lifelore.experiments.chapter2.scene_example import scene_of_row
from lifelore.experiments.chapter2.tabletop_pairs import STANDARD
from lifelore.figures.object_palette import mixed
from lifelore.figures.scene_picture import draw_scene_on
from lifelore.figures.style import BLUE, INK, ORANGE, PAPER, house_style, new_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure, SubFigure

SHOWN = {
    CONTACTS: "thesis",
    CENTRES: "centroid k-NN",
    OURS: "lifelore",
    "closest_points": "closest-point k-NN",
    "bounding_boxes": "bounding-box rule",
}
"""Names in the figure."""
TITLES = {"every contact": "every contact", "strong": f"contacts of at least {THRESHOLD} support vectors"}


def draw(result: Mapping):
    rows, measured = result["rows"], result["measured"]
    cameras = result["settings"]["cameras"]
    counts: dict[str, dict[str, list[int]]] = {}
    for row in rows:
        if "kernel" in row and row["camera"] == cameras[0]:
            for words, title in TITLES.items():
                counts.setdefault(f"{cameras[0]}, {title}", {})[row["kernel"]] = row["scenes by nodes"][words]
    panels = {
        camera: {shown: measured[f"on_by_{name}{f'_{camera}' if number else ''}"] for name, shown in SHOWN.items()}
        for number, camera in enumerate(cameras)
    }
    examples = [scene_of_row(row) for row in rows if "example" in row]
    return draw_contacts_and_centres(examples, counts, panels, marked=STANDARD)


_WIDTH, _PICTURES, _BARS = 9.4, 4, 2.1
_TONES = (INK, ORANGE, mixed(BLUE, PAPER, 0.6), BLUE, mixed(BLUE, INK, 0.6))
"""Of none, one, two, three and more nodes."""


def draw_contacts_and_centres(
    scenes: Sequence[tuple[LabelledCloud, Mapping, str]],
    counts: Mapping[str, Mapping[str, Sequence[int]]],
    panels: Mapping[str, Mapping[str, Mapping]],
    *,
    marked: str,
) -> "Figure":
    """The figure.

    Parameters
    ----------
    scenes : sequence of (cloud, document, caption)
        Pictures side by side, as of `scene_picture.draw_scene`; four fill a row.
    counts : mapping of title to mapping of kernel to numbers
        Scenes with 0, 1, 2, … nodes; the last of them, and more.
    panels : mapping of title to mapping of method to measurement
        As of `method_bars.draw_method_bars`.
    marked : str
        The kernel whose name is bold.
    """
    wide = _WIDTH / _PICTURES
    heights = [0.75 * wide + 0.35, 0.75 + 0.24 * len(next(iter(counts.values()))), _BARS]
    with house_style():
        figure = new_figure(_WIDTH, sum(heights))
        top, middle, bottom = figure.subfigures(3, 1, squeeze=False, height_ratios=heights)[:, 0]
        for axes, (cloud, document, caption) in zip(
            top.subplots(1, max(_PICTURES, len(scenes)), squeeze=False)[0], scenes, strict=False
        ):
            draw_scene_on(axes, cloud, document, (wide, 0.75 * wide), ("cloud", "networks"))
            axes.set_title(caption, fontsize=8.5, pad=4)
        for axes in top.axes[len(scenes) :]:
            axes.set_axis_off()
        _draw_counts(middle, counts, marked)
        draw_bars(bottom, panels, xlabel="told to be on(ball, block) (%)")
    return figure


def _draw_counts(figure: "SubFigure", counts: Mapping[str, Mapping[str, Sequence[int]]], marked: str) -> None:
    every = figure.subplots(1, len(counts), squeeze=False, sharey=True)[0]
    for axes, (title, by_kernel) in zip(every, counts.items(), strict=True):
        for place, numbers in enumerate(by_kernel.values()):
            _stack(axes, place, numbers)
        axes.set(xlim=(0, 100), title=title, xlabel="scenes by nodes of the block (%)")
        axes.tick_params(axis="y", length=0)
        axes.spines["left"].set_visible(False)
    names = list(next(iter(counts.values())))
    every[0].set_yticks(range(len(names)), names)
    every[0].set_ylim(len(names) - 0.5, -0.5)
    for label in every[0].get_yticklabels():
        label.set_fontweight("bold" if label.get_text() == marked else "normal")
    last = len(_TONES) - 1
    for n, tone in enumerate(_TONES):
        every[-1].barh([0], [0], color=tone, label=f"{n}" if n < last else f"{n} or more")
    every[-1].legend(loc="upper left", bbox_to_anchor=(1.0, 1.0), title="nodes", title_fontsize=8)


def _stack(axes: "Axes", place: int, numbers: Sequence[int]) -> None:
    whole, left = max(1, sum(numbers)), 0.0
    for n, tone in zip(numbers, _TONES, strict=True):
        axes.barh([place], [100 * n / whole], left=left, height=0.74, color=tone)
        left += 100 * n / whole
