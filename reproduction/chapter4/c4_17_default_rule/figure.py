"""Regret of six selection rules in every world relative to the best rule there, its mean, and the tasks stuck."""

from collections.abc import Mapping

import numpy as np

from lifelore.figures.heat_grid import draw_heat_grid
from lifelore.figures.interval_bars import draw_interval_bars
from lifelore.figures.style import BLUE, ORANGE, Figure, house_style, new_figure
from reproduction.chapter4.c4_17_default_rule.measure import MOST_STUCK, key_of
from reproduction.chapter4.c4_17_default_rule.run import RULES
from reproduction.chapter4.reuse.many_tasks import EXACT, LEARNT

MODELS = {EXACT: "Exact models", LEARNT: "Models learnt from {} runs a pair"}


@house_style()
def draw(result: Mapping) -> Figure:
    """The figure from the result."""
    settings, rules = result["settings"], list(RULES)
    figure = new_figure(13.2, 8.2)
    panels = figure.subplots(2, 3, width_ratios=[5.2, 1.0, 1.0])
    for line, (model, words) in zip(panels, MODELS.items(), strict=True):
        rows = [row for row in result["rows"] if row["model"] == model]
        regret = np.array([[row["regret"][name] for row in rows] for name in rules])
        ratios = regret / regret.min(axis=0)
        columns = [f"{row['world']}\n{row['noise']}" for row in rows]
        stuck = np.array([[row["stuck"][name] for row in rows] for name in rules])
        above = stuck - stuck.min(axis=0)
        draw_heat_grid(
            line[0], ratios, above > MOST_STUCK, rules, columns, neutral=1.0, spread=4.0, good="low",
            ratio=True, words=lambda value: f"{value:.2g}" if value < 100 else f"{value:.0f}",
        )  # fmt: skip
        line[0].tick_params(axis="x", labelsize=6.5, labelrotation=60)
        line[0].set_title(f"{words.format(settings['samples'])}: regret over that of the best rule in the world")
        numbers = [result["measured"][f"regret_{key_of(name)}_{model}"] for name in rules]
        draw_interval_bars(line[1], rules, {"mean": numbers}, colours={"mean": BLUE}, title="mean of the worlds")
        worst = [{"value": 100 * most, "ci95": None} for most in above.max(axis=1)]
        draw_interval_bars(
            line[2],
            rules,
            {"most": worst},
            colours={"most": ORANGE},
            level=100 * MOST_STUCK,
            title="most stuck (%)",
            words="{:.1f}".format,
        )
        for text in line[2].texts:
            text.get_bbox_patch().set_alpha(1.0)  # the dotted line does not cross a number
        for axes in line[1:]:
            axes.set_yticklabels([])
            axes.margins(x=0.3)
    n = settings["groups"] * settings["tasks"]
    words = (
        f"{n} tasks of {settings['episodes']} episodes a world. Stuck: share above that of the least stuck rule; "
        f"bold where above {100 * MOST_STUCK:.0f} %, the dotted line"
    )
    figure.suptitle(words, x=0.01, ha="left")
    return figure
