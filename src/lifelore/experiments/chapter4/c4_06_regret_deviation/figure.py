"""Printed standard deviations beside those of many experiments of the same size (C4.6; Table 4.3)."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from lifelore.experiments.chapter4.c4_06_regret_deviation.measure import DEFAULT_READING, PRINTED
from lifelore.experiments.chapter4.c4_06_regret_deviation.run import AFTER
from lifelore.experiments.chapter4.reuse_palette import look_of
from lifelore.figures.style import INK, LIGHT, house_style, new_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


def draw(result: Mapping):
    return draw_deviation_table(result, PRINTED, AFTER, DEFAULT_READING)


_FORMS = (("{}", "exact", "standard, exact models"), ("{}, printed", "exact", "as printed, exact models"),
          ("{}", "headline", "standard, learnt models,\nhalf the tasks unseen"))  # fmt: skip
_STYLES = (1.0, 0.55, 0.3)


def draw_deviation_table(
    result: Mapping, printed: Mapping[str, Sequence[float]], after: Sequence[int], reading: str
) -> "Figure":
    """A panel a rule: the middle 95 % and median of groups of ten tasks, a diamond for the printed number."""
    rows, settings = result["rows"], result["settings"]
    with house_style():
        figure = new_figure(10.6, 5.8)
        panels = figure.subplots(2, 3, sharey=True)
        for axes, (name, numbers) in zip(panels.ravel(), printed.items(), strict=True):
            _draw_rule(axes, name, numbers, after, [row for row in rows if row["reading"] == reading])
        for axes in panels[:, 0]:
            axes.set_ylabel("standard deviation of regret")
        for axes in panels[1]:
            axes.set_xlabel("after episode")
        for shade, (_, _, words) in zip(_STYLES, _FORMS, strict=True):
            panels[0, 0].plot([], [], color=INK, lw=6, alpha=shade, label=words)
        panels[0, 0].plot([], [], "D", color="white", mec=INK, ms=7, label="printed (one group of ten tasks)")
        figure.legend(*panels[0, 0].get_legend_handles_labels(), loc="outside lower center", ncols=4)
        figure.suptitle(
            f"Middle 95 % of {settings['groups']} groups of {settings['tasks']} tasks; regret as the {reading}",
            x=0.01, ha="left",
        )  # fmt: skip
    return figure


def _draw_rule(
    axes: "Axes", name: str, numbers: Sequence[float], after: Sequence[int], rows: Sequence[Mapping]
) -> None:
    colour, _ = look_of(name)
    for k, (pattern, case, _) in enumerate(_FORMS):
        wanted = (pattern.format(name), case, "deviation 20")
        row = next((r for r in rows if (r["method"], r["case"], r["noise"]) == wanted), None)
        if row is None:
            continue
        for place, (low, middle, high) in enumerate(row["quantiles"]):
            x = place + 0.22 * (k - 1)
            axes.plot([x, x], [low, high], color=colour, lw=6, alpha=_STYLES[k], solid_capstyle="butt")
            axes.plot([x - 0.07, x + 0.07], [middle, middle], color=INK, lw=1.2)
    for place, number in enumerate(numbers):
        axes.plot([place], [number], "D", color="white", mec=INK, ms=7, mew=1.3, zorder=5)
    axes.set_xticks(range(len(after)), [str(k) for k in after])
    axes.set(title=name, ylim=(0, None))
    axes.grid(axis="y", color=LIGHT)
