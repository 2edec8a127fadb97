"""What is said of the two parts of a thing that was cut, by the tilt of the cut, with a picture of each kind."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from lifelore.core.labelled_cloud import LabelledCloud
from lifelore.experiments.chapter2.scene_example import scene_of_row
from lifelore.figures.scene_picture import draw_scene_on
from lifelore.figures.style import BLUE, GREY, INK, LIGHT, ORANGE, PURPLE, VERMILION, house_style, new_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


def draw(result: Mapping):
    examples = [scene_of_row(row) for row in result["rows"] if "example" in row]
    return draw_cut_relations(examples, [row for row in result["rows"] if "cut" in row])


_WIDTH, _GUTTER, _CAPTION, _BAR = 9.2, 0.1, 0.28, 0.3
"""Inches."""
SAID = {
    "on": BLUE,
    "both": PURPLE,
    "adjacent": ORANGE,
    "none": GREY,
    "turned": VERMILION,
}
"""Colour of what may be said; *turned* is the lower part on the upper."""


def draw_cut_relations(
    scenes: Sequence[tuple[LabelledCloud, Mapping, str]], counts: Sequence[Mapping]
) -> "Figure":
    """Pictures above, bars below, a panel for each set of scenes.

    Parameters
    ----------
    scenes : sequence of (cloud, document, caption)
        As of `scene_picture.draw_scene`.
    counts : sequence of mapping
        ``{"set", "cut", "said", "cuts"}``: so many cuts of a kind of which that was said.
    """
    sets = list(dict.fromkeys(row["set"] for row in sorted(counts, key=lambda row: row["set"], reverse=True)))
    kinds = sorted({row["cut"] for row in counts}, key=_tilt)
    wide = (_WIDTH - (len(scenes) + 1) * _GUTTER) / max(len(scenes), 1)
    pictures = 0.75 * wide + _CAPTION + _GUTTER if scenes else 0.0
    bars = _BAR * len(kinds) + 0.95
    height = pictures + bars
    with house_style():
        figure = new_figure(_WIDTH, height)
        figure.set_layout_engine("none")
        for place, (cloud, document, caption) in enumerate(scenes):
            left, low = _GUTTER + place * (wide + _GUTTER), height - _CAPTION - 0.75 * wide
            axes = figure.add_axes((left / _WIDTH, low / height, wide / _WIDTH, 0.75 * wide / height))
            draw_scene_on(axes, cloud, document, (wide, 0.75 * wide), ("cloud", "relations"))
            axes.set_title(f"{caption} cut", fontsize=8.5, pad=4)
        span = (_WIDTH - 0.95) / max(len(sets), 1)
        for place, name in enumerate(sets):
            box = (0.85 + place * span, 0.62, span - 0.25, _BAR * len(kinds))
            axes = figure.add_axes((box[0] / _WIDTH, box[1] / height, box[2] / _WIDTH, box[3] / height))
            _draw_bars(axes, [row for row in counts if row["set"] == name], kinds, name, first=place == 0)
        _draw_legend(figure)
    return figure


def _tilt(kind: str) -> float:
    """Order of the cuts: level, oblique by tilt, upright."""
    named = {"level": 0.0, "upright": 90.0}
    return named[kind] if kind in named else float(kind.partition("°")[0])


def _draw_bars(axes: "Axes", counts: Sequence[Mapping], kinds: list[str], title: str, *, first: bool) -> None:
    total = 0
    for place, kind in enumerate(kinds):
        left = 0.0
        n = sum(row["cuts"] for row in counts if row["cut"] == kind)
        total += n
        for said, colour in SAID.items():
            own = sum(row["cuts"] for row in counts if row["cut"] == kind and _word(row["said"]) == said)
            if own:
                axes.barh([place], [100 * own / n], left=left, height=0.72, color=colour, alpha=0.9)
                left += 100 * own / n
        axes.annotate(f"{n}", (101, place), va="center", fontsize=7, color=INK, annotation_clip=False)
    axes.set_title(f"{title} ({total:,} cuts)", fontsize=9)
    axes.set(xlim=(0, 100), ylim=(len(kinds) - 0.4, -0.6), xticks=range(0, 101, 20), xlabel="share of cuts (%)")
    axes.set_yticks(range(len(kinds)), kinds if first else [""] * len(kinds))
    axes.tick_params(axis="y", length=0)
    axes.grid(axis="x", color=LIGHT)
    axes.spines["left"].set_visible(False)


def _word(said: str) -> str:
    return "turned" if said.endswith("turned") else said


def _draw_legend(figure: "Figure") -> None:
    from matplotlib.patches import Patch

    handles = [Patch(color=colour, label=name, alpha=0.9) for name, colour in SAID.items()]
    figure.legend(handles=handles, loc="lower center", ncols=len(handles), fontsize=7.5, borderaxespad=0.2)
