"""Displacements by relation and by the clusters found in them, and how well those agree (thesis §2.3.5)."""

from collections.abc import Mapping

import numpy as np

from lifelore.figures.scatter import draw_scatter
from lifelore.figures.scenes.object_palette import RELATION_MARKERS, object_palette, relation_palette
from lifelore.figures.style import house_style, new_figure
from reproduction.chapter2.c2_12_unlabelled_relations.measure import REAL, underscored
from reproduction.chapter2.c2_12_unlabelled_relations.relation_clusters import METHODS, X_MEANS
from reproduction.chapter2.scoring.method_panels import draw_method_panels


def draw(result: Mapping):
    panels = {}
    for title, ending in (("simulated", ""), (REAL, f"_{REAL}")):
        of = [row for row in result["rows"] if "method" in row and (row["data_set"] == REAL) == (title == REAL)]
        # Intervals are over data sets; the title names the number of pairs in them.
        pairs = sum(row["pairs"] for row in of if row["method"] == X_MEANS)
        if of:
            numbers = {method: result["measured"][f"ari_{underscored(method)}{ending}"] for method in METHODS}
            panels[title] = {method: {**number, "n": pairs} for method, number in numbers.items()}
    with house_style():
        figure = new_figure(9.2, 5.3)
        top, bottom = figure.subfigures(2, 1, squeeze=False, height_ratios=[3.2, 2.1])[:, 0]
        draw_points(top, next(row for row in result["rows"] if "relations" in row))
        draw_method_panels(bottom, panels, "adjusted Rand index × 100")
    return figure


def draw_points(figure, row: Mapping) -> None:
    """The displacements, coloured by relation, then by cluster of each method; markers show the relation."""
    at, relations = np.asarray(row["displacements"], float), np.array(row["relations"])
    every = figure.subplots(1, 1 + len(row["clusters"]), sharex=True, sharey=True, squeeze=False)[0]
    palette = relation_palette(relations)
    names = [name for name in palette if name in relations]
    groups = {f"{name} ({(relations == name).sum()})": (relations == name, palette[name]) for name in names}
    views = {"relations": groups}
    for method, clusters in row["clusters"].items():
        labels = np.array(clusters)
        found = object_palette(np.unique(labels).tolist())
        views[f"{method}: {len(found)}"] = {f"rel {k}": (labels == k, colour) for k, colour in found.items()}
    for axes, (title, groups) in zip(every, views.items(), strict=True):
        draw_scatter(
            axes,
            {label: at[member] for label, (member, _) in groups.items()},
            colours={label: colour for label, (_, colour) in groups.items()},
            markers={
                label: [RELATION_MARKERS.get(name, "D") for name in relations[member]]
                for label, (member, _) in groups.items()
            },
            size=15,
            legend={"loc": "best", "fontsize": 7, "handletextpad": 0.1, "borderpad": 0.2, "labelspacing": 0.3},
            title=title,
        )
    every[0].set_ylabel("above the other (mm)")
    figure.supxlabel("to the right of the other (mm)", fontsize=9)
