"""Printed standard deviations beside those of many experiments of the same size (Table 4.3)."""

from collections.abc import Mapping, Sequence

from lifelore.figures.style import INK, LIGHT, Axes, Figure, house_style, new_figure
from reproduction.chapter4.c4_06_regret_deviation.measure import AFTER, DEFAULT_READING, PRINTED
from reproduction.chapter4.reuse.looks import look_of
from reproduction.chapter4.surveillance.runs import DEFAULT_WORLD
from reproduction.engine.results_table import ResultsTable

FORMS = {
    ("", "exact"): (1.0, "standard, exact models"),
    (", printed", "exact"): (0.55, "as printed, exact models"),
    ("", "headline"): (0.3, "standard, learnt models,\nhalf the tasks unseen"),
}
"""Shade and words of each form and case."""


def draw(result: Mapping) -> Figure:
    """A panel a rule: the middle 95 % and median of groups of ten tasks, a diamond for the printed number."""
    settings = result["settings"]
    table = ResultsTable(result["rows"], ("method", "case", "noise", "reading"))
    table = table.select(noise=DEFAULT_WORLD["noise"], reading=DEFAULT_READING)
    with house_style():
        figure = new_figure(10.6, 5.8)
        panels = figure.subplots(2, 3, sharey=True)
        for axes, (name, numbers) in zip(panels.ravel(), PRINTED.items(), strict=True):
            _draw_rule(axes, name, numbers, table)
        for axes in panels[:, 0]:
            axes.set_ylabel("standard deviation of regret")
        for axes in panels[1]:
            axes.set_xlabel("after episode")
        for shade, words in FORMS.values():
            panels[0, 0].plot([], [], color=INK, lw=6, alpha=shade, label=words)
        panels[0, 0].plot([], [], "D", color="white", mec=INK, ms=7, label="printed (one group of ten tasks)")
        figure.legend(*panels[0, 0].get_legend_handles_labels(), loc="outside lower center", ncols=4)
        n, size = settings["groups"], settings["tasks"]
        words = f"Middle 95 % of {n} groups of {size} tasks; regret as the {DEFAULT_READING}"
        figure.suptitle(words, x=0.01, ha="left")
    return figure


def _draw_rule(axes: Axes, name: str, numbers: Sequence[float], table: ResultsTable) -> None:
    colour, _ = look_of(name)
    for k, ((form, case), (shade, _)) in enumerate(FORMS.items()):
        for row in table.select(method=name + form, case=case).records:
            for place, (low, middle, high) in enumerate(row["quantiles"]):
                x = place + 0.22 * (k - 1)
                axes.plot([x, x], [low, high], color=colour, lw=6, alpha=shade, solid_capstyle="butt")
                axes.plot([x - 0.07, x + 0.07], [middle, middle], color=INK, lw=1.2)
    axes.plot(range(len(numbers)), numbers, "D", color="white", mec=INK, ms=7, mew=1.3, zorder=5)
    axes.set_xticks(range(len(AFTER)), [str(k) for k in AFTER])
    axes.set(title=name, ylim=(0, None))
    axes.grid(axis="y", color=LIGHT)
