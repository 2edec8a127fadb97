"""Mean regret by size of the library and number of episodes (C4.8; Figure 4.12)."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from lifelore.figures.style import BLUE, LIGHT, SKY, house_style, new_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


def draw(result: Mapping):
    return draw_library_size(result)


_PANELS = (
    ("EI", "learnt", "all", "Learnt models; against the best of all"),
    ("EI", "exact", "all", "Exact models; against the best of all"),
    ("EI, printed", "exact", "all", "EI as printed, exact; against the best of all"),
    ("EI", "learnt", "library", "Learnt; against the library's best (Def. 4.3.1)"),
)


def draw_library_size(result: Mapping) -> "Figure":
    """From C4.8's result: a line for each number of episodes over the size of the library."""
    rows, settings = result["rows"], result["settings"]
    panels = [panel for panel in _PANELS if panel[0] in settings["rules"]]
    with house_style():
        figure = new_figure(10.4, 3.7 * (1 + (len(panels) > 2)))
        every = figure.subplots(1 + (len(panels) > 2), 2, sharey=True, squeeze=False).ravel()
        for axes in every[len(panels) :]:
            axes.axis("off")
        for axes, (rule, model, against, words) in zip(every, panels, strict=False):
            shown = [row for row in rows if (row["rule"], row["model"]) == (rule, model)]
            _draw_lines(axes, shown, against, settings["episodes"])
            axes.set_title(words)
            axes.set_xlabel("size of the library, % of 68")
        every[0].set_ylabel("mean regret of an episode")
        every[0].legend(title="episodes", ncols=2, loc="upper right")
        figure.suptitle(f"BPR-EI in the reserve, {settings['trials']} trials a point", x=0.01, ha="left")
    return figure


def _draw_lines(axes: "Axes", rows: Sequence[Mapping], against: str, episodes: Sequence[int]) -> None:
    from matplotlib.colors import LinearSegmentedColormap

    shades = LinearSegmentedColormap.from_list("episodes", [SKY, BLUE, "#0b2a4a"])
    shares = [100 * row["share"] for row in rows]
    for k, n in enumerate(episodes):
        mean = np.array([row[against][k] for row in rows])
        half = 1.96 * np.array([row[f"{against}_error"][k] for row in rows])
        colour = shades(k / max(1, len(episodes) - 1))
        axes.fill_between(shares, mean - half, mean + half, color=colour, alpha=0.15, lw=0)
        axes.plot(shares, mean, "o-", color=colour, ms=4, label=str(n))
    axes.set_xticks(shares, [f"{share:g}" for share in shares])
    axes.set_ylim(0, None)
    axes.grid(axis="y", color=LIGHT)
