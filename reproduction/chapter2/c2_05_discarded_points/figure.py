"""Exact share while a cloud gets worse: points discarded, noise added, labels wrong at borders (§2.4.1)."""

from collections.abc import Mapping, Sequence

from lifelore.figures.curves import draw_curves
from lifelore.figures.scenes.object_palette import method_palette
from lifelore.figures.style import GREY, LIGHT, house_style, new_figure
from reproduction.chapter2.c2_05_discarded_points.measure import KINDS, LITERAL, OURS, THESIS
from reproduction.chapter2.c2_05_discarded_points.run import BORDER, DISCARDED, MASKS, NOISE, WHOLE

SHOWN = {OURS: "lifelore", THESIS: "thesis", LITERAL: "thesis, read literally"}
CAPTION = (
    "Read literally: clouds are not thinned to one spacing, and contacts below 7 support vectors are dropped; "
    "points discarded only.\nBands: 95 % intervals. Dashed: the 70 % of the thesis's sentence."
)
PANELS = {
    DISCARDED: ("points discarded", "points discarded (%)", 100),
    NOISE: ("depth noise added", "standard deviation (mm)", 1000),
    BORDER: ("labels swapped", "of points within 5 mm (%)", 100),
    MASKS: ("masks grown", "over others by (mm)", 1000),
}
"""Of each way a title, the label of its axis and the factor from its levels to that axis."""


def draw(result: Mapping):
    rows = [row for row in result["rows"] if "method" in row]
    shown = [(kind, way) for way in PANELS for kind in KINDS if kind == "simulated" or way == DISCARDED]
    shown = [view for view in shown if any((row["scenes"], row["way"]) == view for row in rows)]
    palette = method_palette(SHOWN.values())
    with house_style():
        figure = new_figure(min(3.1 * len(shown) + 1.9, 12), 3.6)
        every = figure.subplots(1, len(shown), squeeze=False, sharey=True)[0]
        for axes, (kind, way) in zip(every, shown, strict=True):
            own = [row for row in rows if row["scenes"] == kind and row["way"] in (WHOLE, way)]
            looks = {name: {"color": palette[name], "marker": "o", "markersize": 3.6} for name in SHOWN.values()}
            title, xlabel, factor = PANELS[way]
            title = f"{title}\n{kind}, {own[0]['pairs']:,} pairs"
            draw_curves(axes, None, curves(own, factor), looks=looks, title=title, xlabel=xlabel, legend=False)
            axes.grid(axis="y", color=LIGHT)
            if way == DISCARDED:
                axes.axvline(70, color=GREY, lw=1, ls=(0, (4, 3)), zorder=1)
                axes.annotate(
                    "70 %", (70, 1), (-3, -2), xycoords=("data", "axes fraction"), textcoords="offset points",
                    ha="right", va="top", fontsize=7.5, color=GREY,
                )  # fmt: skip
        every[0].set_ylabel("pairs classified exactly (%)")
        figure.legend(*every[0].get_legend_handles_labels(), loc="outside upper left", ncols=len(SHOWN))
        figure.supxlabel(CAPTION, fontsize=8, color=GREY)
    return figure


def curves(rows: Sequence[Mapping], factor: float) -> dict[str, dict[str, list[float]]]:
    """By method the exact shares in per cent with their intervals, over levels times `factor`."""
    found = {}
    for method, name in SHOWN.items():
        own = [row for row in rows if row["method"] == method]
        if len(own) > 1:
            ends = [row["exact"]["ci95"] or [row["exact"]["value"]] * 2 for row in own]
            found[name] = {
                "x": [factor * row["level"] for row in own],
                "mean": [100 * row["exact"]["value"] for row in own],
                "low": [100 * low for low, _ in ends],
                "high": [100 * high for _, high in ends],
            }
    return found
