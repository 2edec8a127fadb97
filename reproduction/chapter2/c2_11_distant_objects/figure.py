"""Support vectors and contact points of objects moved apart: a column for each cost, a line for each length."""

from collections.abc import Mapping, Sequence

from lifelore.figures.curves import draw_curves
from lifelore.figures.style import BLUE, GREEN, LIGHT, ORANGE, VERMILION, house_style, new_figure
from reproduction.chapter2.scenes.tabletop_pairs import kernel_name

COLOURS = (BLUE, ORANGE, GREEN, VERMILION)
QUANTITIES = {
    "support": "support vectors\nan object",
    "contacts": "contact points an object,\nall",
    "contacts_of_7": "contact points an object,\nof 7 support vectors",
}


def draw(result: Mapping):
    rows = [row for row in result["rows"] if row.get("unit") in ("as seen", "metres")]
    lengths, costs = result["settings"]["lengths"], result["settings"]["costs"]
    with house_style():
        figure = new_figure(1.3 + 2.5 * len(costs), 6.6)
        grid = figure.subplots(3, len(costs), squeeze=False, sharex=True, sharey="row")
        for column, cost in enumerate(costs):
            for place, (key, label) in enumerate(QUANTITIES.items()):
                axes = grid[place, column]
                for length, colour in zip(lengths, COLOURS * 3, strict=False):
                    own = [row for row in rows if row["kernel"] == kernel_name(length, cost)]
                    name = f"{1000 * length:g} mm"
                    look = {"color": colour, "marker": "o", "markersize": 3.2, "linewidth": 1.5}
                    simulated = {name: quartiles(own, "simulated", key)}
                    draw_curves(axes, None, simulated, looks={name: look}, legend=False)
                    real = quartiles(own, "real", key)
                    axes.plot(real["x"], real["mean"], "x", markersize=3.2, color=colour)
                axes.grid(axis="y", color=LIGHT)
                if column == 0:
                    axes.set_ylabel(label)
            grid[0, column].set_yscale("log")
            grid[0, column].set_title(f"C = {cost:g}" if cost < 1000 else f"C = {cost:g}, nearly hard")
            for axes in grid[1:, column]:
                axes.set_ylim(bottom=0)
            grid[2, column].set_xlabel("gap (m)")
            grid[2, column].set_xscale("log")
            grid[2, column].xaxis.set_major_formatter("{x:g}")
        handles, names = grid[0, 0].get_legend_handles_labels()
        title = "length of the kernel (line: simulated, median and quartiles; cross: real, median)"
        figure.legend(handles, names, loc="outside upper center", ncols=6, title=title)
    return figure


def quartiles(rows: Sequence[Mapping], scenes: str, key: str) -> dict[str, list[float]]:
    """A quantity over the gap: its median and quartiles."""
    own = [row for row in rows if row["scenes"] == scenes]
    middle, low, high = ([row[key][k] for row in own] for k in range(3))
    return {"x": [row["gap"] for row in own], "mean": middle, "low": low, "high": high}
