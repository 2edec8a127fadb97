"""Displacements coloured by relation, and by the clusters that X-means finds in them (§2.3.5)."""

from collections.abc import Mapping

import numpy as np

from lifelore.figures.scenes.object_palette import object_palette
from lifelore.figures.style import Axes
from reproduction.figures.palettes import RELATION_COLOURS
from reproduction.figures.panels import panels
from reproduction.figures.scatter import draw_scatter

REACH = 40
"""Millimetres shown around the origin; a note counts the displacements beyond."""


@panels(9.0, 4.4, 1, 2, sharex=True, sharey=True, grid="")
def draw(result: Mapping, left: Axes, right: Axes) -> None:
    """The relations on the left, the clusters on the right."""
    row = result["rows"][0]
    at = np.asarray(row["mm"], float)
    for axes, key, title in ((left, "relations", "relations"), (right, "clusters", "clusters of X-means")):
        labels = np.array(row[key])
        names = list(dict.fromkeys(sorted(labels.tolist())))
        palette = RELATION_COLOURS if key == "relations" else object_palette([name + 2 for name in names])
        groups = {f"{name}" if key == "relations" else f"rel {name + 1}": name for name in names}
        colours = [palette[name if key == "relations" else name + 2] for name in names]
        draw_scatter(
            axes,
            {label: at[labels == name] for label, name in groups.items()},
            colours=dict(zip(groups, colours, strict=True)),
            legend={"loc": "upper left"},
            title=title,
            xlabel="to the right of B (mm)",
        )
    beyond = int((np.abs(at) > REACH).any(axis=1).sum())
    right.annotate(
        f"{beyond} of {len(at)} lie beyond", (0.97, 0.03), xycoords="axes fraction", ha="right", fontsize=8
    )
    left.set(xlim=(-REACH, REACH), ylim=(-REACH, REACH), ylabel="above B (mm)")
