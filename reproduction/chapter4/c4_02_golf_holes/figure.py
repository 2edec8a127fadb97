"""Golf by shot: mean error and entropy of the belief, beside single clubs and the optimum (Figure 4.4)."""

from collections.abc import Mapping
from operator import itemgetter

from lifelore.domains.golf.golf import CLUBS
from lifelore.figures.curves import draw_curves
from lifelore.figures.interval_bars import draw_interval_bars
from lifelore.figures.style import BLUE, GREY, INK, LIGHT, ORANGE, Axes, Figure, house_style, new_figure
from reproduction.chapter4.golf.category_bars import CLUB_COLOURS
from reproduction.chapter4.golf.rounds import WOOD
from reproduction.chapter4.reuse.looks import LOOKS
from reproduction.engine.results_table import ResultsTable

MODELS = {"exact": ORANGE, "learnt": BLUE}


def draw(result: Mapping) -> Figure:
    """Error by shot, entropy by shot, and each rule's gap to the dynamic program."""
    settings = result["settings"]
    table = ResultsTable(result["rows"], ("part", "model", "rule", "first", "way"))
    with house_style():
        figure = new_figure(11.2, 4.2)
        error, belief, gaps = figure.subplots(1, 3, width_ratios=[1.25, 0.9, 1])
        _draw_errors(error, table, settings["shots"])
        entropy = {m: {"mean": table.record(model=m, rule="greedy", first=None)["entropy"]} for m in MODELS}
        looks = {model: {"color": colour, "marker": "o", "ms": 3.5} for model, colour in MODELS.items()}
        places = range(settings["shots"] + 1)
        draw_curves(belief, places, entropy, looks=looks, title="Entropy of the belief, nats", xlabel="after shot")
        belief.set_ylim(0, None)
        belief.legend(title="models")
        _draw_gaps(gaps, table, settings["horizon"])
        low, high = settings["yards"]
        words = f"{settings['groups']:,} × {settings['holes']} unknown holes of {low:g} to {high:g} yards"
        figure.suptitle(words, x=0.01, ha="left")
    return figure


def _draw_errors(axes: Axes, table: ResultsTable, shots: int) -> None:
    clubs, right = table.record(part="clubs"), shots + 0.3
    axes.axhspan(10, 15, color=LIGHT, alpha=0.7, lw=0)
    axes.text(right, 15.4, "10–15 yards", ha="right", va="bottom", fontsize=8, color=GREY)
    levels = [*zip(CLUBS, CLUB_COLOURS, clubs["club"], strict=True), ("best club", INK, clubs["best"])]
    for name, colour, missed in levels:
        axes.axhline(missed, color=colour, lw=1, ls=(0, (4, 2)) if name == "best club" else (0, (1, 1.5)))
        axes.text(right + 0.1, missed, name, va="center", fontsize=8, color=colour)
    series, looks = {}, {}
    for model, colour in MODELS.items():
        for first, words, style in ((None, "", "-"), (WOOD, ", 3-wood first", (0, (3, 1.5)))):
            label = f"greedy, {model}{words}"
            series[label] = {"mean": table.record(model=model, rule="greedy", first=first)["error"]}
            looks[label] = {"color": colour, "ls": style, "marker": "o", "ms": 3.5}
    draw_curves(axes, None, series, looks=looks, title="Mean error, yards", xlabel="shot", legend=False)
    axes.set(xticks=range(1, shots + 1), ylim=(0, None), xlim=(0.7, right))
    axes.legend(loc="upper right", bbox_to_anchor=(1, 0.97), fontsize=7, frameon=True, edgecolor="w", framealpha=1)


def _draw_gaps(axes: Axes, table: ResultsTable, horizon: int) -> None:
    rules = [row for row in table.select(part="program").records if row["way"] in LOOKS]
    shown = sorted(rules, key=itemgetter("gap"))
    best, known = (table.record(way=way)["yards"] for way in ("dynamic program", "hole known"))
    draw_interval_bars(
        axes, [row["way"] for row in shown], {"gap": [{"value": row["gap"]} for row in shown]},
        colours=[LOOKS[row["way"]][0] for row in shown], words="{:.2f}".format, title="Yards above the optimum",
        label=f"summed over {horizon} shots at training holes;\noptimum {best:.1f}, hole known {known:.1f}",
    )  # fmt: skip
    axes.set_xlim(0, 1.2 * shown[-1]["gap"] + 0.01)
