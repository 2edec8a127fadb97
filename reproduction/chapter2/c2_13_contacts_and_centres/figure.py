"""Networks with every contact and with strong ones, nodes by kernel, share of *on* by method (thesis Fig 2.1)."""

from collections.abc import Mapping, Sequence

from lifelore.figures.gallery import gallery_above
from lifelore.figures.scenes.object_palette import mixed
from lifelore.figures.stacked_bars import draw_stacked_bars
from lifelore.figures.style import BLUE, INK, ORANGE, PAPER, house_style
from reproduction.chapter2.c2_13_contacts_and_centres.measure import CENTRES, CONTACTS, OURS
from reproduction.chapter2.scenes.scene_example import examples_of
from reproduction.chapter2.scenes.tabletop_pairs import STANDARD
from reproduction.chapter2.scoring.method_panels import draw_method_panels
from reproduction.chapter2.scoring.pair_validation import THRESHOLD

SHOWN = {
    CONTACTS: "thesis",
    CENTRES: "centroid k-NN",
    OURS: "lifelore",
    "closest_points": "closest-point k-NN",
    "bounding_boxes": "bounding-box rule",
}
"""Names in the figure."""
TITLES = {"every contact": "every contact", "strong": f"contacts of at least {THRESHOLD} support vectors"}
NODES: dict[str, str] = {
    "0": INK,
    "1": ORANGE,
    "2": mixed(BLUE, PAPER, 0.6),
    "3": BLUE,
    "4 or more": mixed(BLUE, INK, 0.6),
}
"""Colour by number of nodes."""


def draw(result: Mapping):
    measured, cameras = result["measured"], result["settings"]["cameras"]
    counts = [row for row in result["rows"] if "kernel" in row and row["camera"] == cameras[0]]
    panels = {
        camera: {shown: measured[f"on_by_{name}{f'_{camera}' if number else ''}"] for name, shown in SHOWN.items()}
        for number, camera in enumerate(cameras)
    }
    figure, below = gallery_above(examples_of(result), 4.3, columns=4, layers=("cloud", "networks"))
    with house_style():
        middle, bottom = below.subfigures(2, 1, squeeze=False, height_ratios=[2.2, 2.1])[:, 0]
        draw_nodes(middle, counts, cameras[0])
        draw_method_panels(bottom, panels, "predicted on(ball, block) (%)")
    return figure


def draw_nodes(figure, rows: Sequence[Mapping], camera: str) -> None:
    """Scenes by number of nodes of the block and kernel, of all contacts and of strong ones; ours in bold."""
    kernels = [row["kernel"] for row in rows]
    every = figure.subplots(1, len(TITLES), squeeze=False, sharey=True)[0]
    for axes, (key, title) in zip(every, TITLES.items(), strict=True):
        by_nodes = zip(*(row["scenes by nodes"][key] for row in rows), strict=True)
        parts = dict(zip(NODES, by_nodes, strict=True))
        label = "scenes by nodes of the block (%)"
        draw_stacked_bars(axes, kernels, parts, NODES, shares=True, title=f"{camera}, {title}", label=label)
    for label in every[0].get_yticklabels():
        label.set_fontweight("bold" if label.get_text() == STANDARD else "normal")
    every[-1].legend(loc="upper left", bbox_to_anchor=(1.0, 1.0), title="nodes", title_fontsize=8)
