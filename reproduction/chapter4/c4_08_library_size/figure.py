"""Mean regret by size of the library and number of episodes (Figure 4.12)."""

from collections.abc import Mapping

import numpy as np

from lifelore.figures.curves import draw_curves
from lifelore.figures.style import BLUE, LIGHT, SKY, Figure, house_style, new_figure
from reproduction.engine.results_table import ResultsTable

PANELS = (
    ("EI", "learnt", "all", "Learnt models; against the best of all"),
    ("EI", "exact", "all", "Exact models; against the best of all"),
    ("EI, printed", "exact", "all", "EI as printed, exact; against the best of all"),
    ("EI", "learnt", "library", "Learnt; against the library's best (Def. 4.3.1)"),
)


def draw(result: Mapping) -> Figure:
    """A line for each number of episodes over the size of the library."""
    from matplotlib.colors import LinearSegmentedColormap

    settings, table = result["settings"], ResultsTable(result["rows"], ("rule", "model"))
    panels = [panel for panel in PANELS if panel[0] in settings["rules"]]
    episodes, shares = [str(n) for n in settings["episodes"]], [100 * share for share in settings["shares"]]
    colours = LinearSegmentedColormap.from_list("episodes", [SKY, BLUE, "#0b2a4a"])
    shades = zip(episodes, colours(np.linspace(0, 1, len(episodes))), strict=True)
    looks = {n: {"color": shade, "marker": "o", "ms": 4} for n, shade in shades}
    n_rows = -(-len(panels) // 2)
    with house_style():
        figure = new_figure(10.4, 3.7 * n_rows + 0.5)
        every = figure.subplots(n_rows, 2, sharey=True, squeeze=False).ravel()
        for axes in every[len(panels) :]:
            axes.axis("off")
        for axes, (rule, model, against, words) in zip(every, panels, strict=False):
            own = table.select(rule=rule, model=model)
            mean, error = own.values(against), 1.96 * own.values(f"{against}_error")
            series = {n: {"mean": mean[:, k], "error": error[:, k]} for k, n in enumerate(episodes)}
            xlabel = "size of the library, % of 68"
            draw_curves(axes, shares, series, looks=looks, title=words, xlabel=xlabel, legend=False)
            axes.set_xticks(shares, [f"{share:g}" for share in shares])
            axes.set_ylim(0, None)
            axes.grid(axis="y", color=LIGHT)
        every[0].set_ylabel("mean regret of an episode")
        figure.legend(
            *every[0].get_legend_handles_labels(), title="number of episodes (band: 95 %)", ncols=len(episodes),
            loc="outside lower center",
        )  # fmt: skip
        figure.suptitle(f"BPR-EI in the reserve, {settings['trials']} trials a point", x=0.01, ha="left")
    return figure
