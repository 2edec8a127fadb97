"""Displacements by relation and by the clusters found in them, and how well those agree (thesis §2.3.5)."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from lifelore.experiments.chapter2.c2_12_unlabelled_relations.measure import REAL, under
from lifelore.experiments.chapter2.c2_12_unlabelled_relations.relation_clusters import METHODS, X_MEANS
from lifelore.experiments.chapter2.method_bars import draw_bars
from lifelore.figures.object_palette import mixed, object_palette, relation_palette
from lifelore.figures.style import INK, LIGHT, house_style, new_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


def draw(result: Mapping):
    points = next(row for row in result["rows"] if "relations" in row)
    panels = {}
    for title, ends in (("simulated", ""), (REAL, f"_{REAL}")):
        of = [row for row in result["rows"] if "method" in row and (row["data_set"] == REAL) == (title == REAL)]
        pairs = sum(row["pairs"] for row in of if row["method"] == X_MEANS)
        if of:
            numbers = {method: result["measured"][f"ari_{under(method)}{ends}"] for method in METHODS}
            # Intervals are over data sets; the picture names the pairs in them.
            panels[title] = {method: {**number, "n": pairs} for method, number in numbers.items()}
    return draw_clusters(points, panels)


_SIGNS = {"on": "o", "adjacent": "s", "both": "^", "none": "x"}


def draw_clusters(points: Mapping, panels: Mapping[str, Mapping[str, Mapping]]) -> "Figure":
    """The figure.

    Parameters
    ----------
    points : mapping
        ``"displacements"``, (n, 2) to the right and up in mm; ``"relations"`` of each; ``"clusters"``, by method
        the cluster of each.
    panels : mapping of title to mapping of method to measurement
        Adjusted Rand indices, as of `method_bars.draw_method_bars`.
    """
    at, relations = np.asarray(points["displacements"], float), np.array(points["relations"])
    methods = points["clusters"]
    with house_style():
        figure = new_figure(9.2, 5.3)
        top, bottom = figure.subfigures(2, 1, squeeze=False, height_ratios=[3.2, 2.1])[:, 0]
        every = top.subplots(1, 1 + len(methods), sharex=True, sharey=True, squeeze=False)[0]
        palette = relation_palette(relations)
        names = [name for name in palette if name in relations]
        groups = {f"{name} ({(relations == name).sum()})": (relations == name, palette[name]) for name in names}
        _scatter(every[0], at, relations, groups, "relations")
        for axes, (method, clusters) in zip(every[1:], methods.items(), strict=True):
            labels = np.array(clusters)
            found = object_palette(np.unique(labels).tolist())
            groups = {f"rel {k}": (labels == k, colour) for k, colour in found.items()}
            _scatter(axes, at, relations, groups, f"{method}: {len(found)}")
        every[0].set_ylabel("above the other (mm)")
        top.supxlabel("to the right of the other (mm)", fontsize=9)
        draw_bars(bottom, panels, xlabel="adjusted Rand index × 100")
    return figure


def _scatter(
    axes: "Axes",
    at: NDArray[np.float64],
    relations: NDArray[np.str_],
    groups: Mapping[str, tuple[NDArray[np.bool_], str]],
    title: str,
) -> None:
    """Points in the colour of their group and with the sign of their relation."""
    axes.axhline(0, color=LIGHT, lw=1, zorder=0)
    axes.axvline(0, color=LIGHT, lw=1, zorder=0)
    for label, (member, colour) in groups.items():
        for name in np.unique(relations[member]):
            own = member & (relations == name)
            edge = {} if name == "none" else {"edgecolors": mixed(colour, INK, 0.3)}
            axes.scatter(
                *at[own].T, s=15, marker=_SIGNS.get(name, "D"), color=colour, alpha=0.75, linewidths=0.5, **edge
            )
        axes.scatter([], [], s=22, marker=_sign(relations[member]), color=colour, label=label)
    axes.set_title(title)
    axes.legend(loc="best", fontsize=7, handletextpad=0.1, borderpad=0.2, labelspacing=0.3)


def _sign(relations: Sequence[str] | NDArray[np.str_]) -> str:
    """The sign of a group of one relation; a disc for a mixed one."""
    names = set(relations)
    return _SIGNS.get(names.pop(), "D") if len(names) == 1 else "o"
