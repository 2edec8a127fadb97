"""Bars of several methods with their intervals, a panel for each set of scenes."""

from collections.abc import Mapping

from lifelore.figures.interval_bars import draw_interval_bars
from lifelore.figures.scenes.object_palette import method_palette
from lifelore.figures.style import LIGHT


def draw_method_panels(
    figure, panels: Mapping[str, Mapping[str, Mapping]], label: str = "pairs classified exactly (%)"
) -> None:
    """Draw the panels side by side into a figure or a part of a figure, within the house style.

    `panels`: title → method → ``{"value", "ci95", "n"}``, a share in [0, 1]; methods in the order of the first
    panel. `label` is that of the axis of values.
    """
    names = list(dict.fromkeys(name for panel in panels.values() for name in panel))
    palette = method_palette(names)
    every = figure.subplots(1, len(panels), squeeze=False, sharey=True)[0]
    for axes, (title, panel) in zip(every, panels.items(), strict=True):
        sizes = {number["n"] for number in panel.values()}
        shares, colours = [per_cent(panel.get(name)) for name in names], [palette[name] for name in names]
        words = f"{title} ({sizes.pop():,} pairs)" if len(sizes) == 1 else title
        draw_interval_bars(
            axes, names, {title: shares}, colours=colours, words="{:.1f}".format, title=words, label=label
        )
        axes.set(xlim=(0, 112), xticks=range(0, 101, 20))
        axes.grid(axis="x", color=LIGHT)


def per_cent(share: Mapping | None) -> dict | None:
    """A share and its interval in per cent."""
    if share is None or share["value"] is None:
        return None
    ends = share.get("ci95")
    return {"value": 100 * share["value"], "ci95": [100 * end for end in ends] if ends else None}
