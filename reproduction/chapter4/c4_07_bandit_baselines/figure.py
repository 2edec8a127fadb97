"""Policy reuse and its peers: regret by episode, summed regret, and the knowledge of each method (Figure 4.11)."""

from collections.abc import Mapping, Sequence

from lifelore.figures.interval_bars import draw_interval_bars
from lifelore.figures.style import GREY, LIGHT, Axes, Figure, house_style, new_figure
from reproduction.chapter4.reuse.looks import draw_regret, look_of
from reproduction.chapter4.surveillance.runs import DEFAULT_WORLD
from reproduction.engine.results_table import ResultsTable

SHOWN = (
    "EI", "IDS", "sampling", "GP-UCB", "GP-UCB, tuned", "GP-UCB, true metric", "UCB1", "UCB1, tuned",
    "interval estimation", "eps-greedy on means",
)  # fmt: skip
PANELS = {"headline": "Learnt models, half the tasks unseen", "exact": "Exact models, at targets"}


def draw(result: Mapping) -> Figure:
    """Curves by case, then every method's sum beside its prior knowledge."""
    settings = result["settings"]
    table = ResultsTable([row for row in result["rows"] if "curve" in row], ("method", "case"))
    with house_style():
        figure = new_figure(11.6, 9.6)
        top, bottom = figure.subfigures(2, 1, height_ratios=[1, 1.08])  # pyright: ignore
        panels = top.subplots(1, 2, sharey=True)
        for axes, (case, words) in zip(panels, PANELS.items(), strict=True):
            draw_regret(axes, [table.record(method=name, case=case) for name in SHOWN], words)
        panels[0].set_ylabel("expected regret")
        top.legend(*panels[0].get_legend_handles_labels(), loc="outside lower center", ncols=5)
        n = settings["tasks"] * settings["groups"]
        top.suptitle(f"Surveillance, layout X, {n} tasks: mean regret", x=0.01, ha="left")
        others = [row for row in result["rows"] if "curve" not in row]
        _draw_sums(bottom.subplots(), table, others, settings["episodes"])
    return figure


def _draw_sums(axes: Axes, table: ResultsTable, others: Sequence[Mapping], episodes: int) -> None:
    """Bars for sums with exact and learnt models, rings for other reserves, and each method's prior knowledge."""
    exact = sorted(table.select(case="exact").records, key=lambda row: row["cumulative"]["value"])
    most = max(row["cumulative"]["value"] for row in table.records)
    names = [row["method"] for row in exact]
    learnt = [table.record(case="headline", method=name) for name in names]
    groups = {case: [row["cumulative"] for row in own] for case, own in (("exact", exact), ("learnt", learnt))}
    looks = [look_of(name)[0] for name in names]
    colours = {"exact": looks, "learnt": [(colour, 0.5) for colour in looks]}
    draw_interval_bars(axes, names, groups, colours=colours, words=None, legend=False)
    for k, row in enumerate(exact):
        sums = [other["cumulative"]["value"] for other in others if other["method"] == row["method"]]
        axes.plot(sums, [k - 0.2] * len(sums), "o", color="white", mec=GREY, ms=3.5, mew=0.8)
        tuned = ", ".join(f"{key.replace('_', ' ')} {value:g}" for key, value in row["tuned"].items())
        axes.text(1.04 * most, k, row["given"] + (f" ({tuned})" if tuned else ""), va="center", fontsize=7.5)
    n = len({tuple(row[key] for key in DEFAULT_WORLD) for row in others})
    axes.set(xlim=(0, 2.35 * most), ylim=(len(exact) - 0.4, -1.2))
    axes.set_xlabel("summed regret")
    axes.xaxis.set_label_coords(0.21, -0.06)
    if n:
        axes.figure.supxlabel(f"Rings: the same, exact models, in {n} other reserves.", fontsize=8, color=GREY)
    axes.set_xticks([t for t in range(0, 12_001, 2000) if t <= 1.02 * most])
    axes.text(1.04 * most, -0.85, "given beforehand", fontsize=8, color=GREY, va="center")
    axes.set_title(f"Regret summed over {episodes} episodes: exact (dark) and learnt models (pale)")
    axes.grid(axis="x", color=LIGHT)
