"""Figure of claim C3.14: what minimised domains keep, how exploring in them collides, and how fast one learns."""

from collections.abc import Mapping
from itertools import product

import numpy as np

from lifelore.experiments.chapter3.c3_14_minimised_domains.run import WITHIN
from lifelore.experiments.chapter3.learning.schedules import schedule_in_brief
from lifelore.experiments.engine.results_table import ResultsTable
from lifelore.figures.heat_grid import draw_estimate_grid, draw_heat_grid
from lifelore.figures.interval_bars import draw_interval_bars
from lifelore.figures.style import BLUE, GREEN, GREY, LIGHT, Axes, Figure, house_style, new_figure

KEPT = (
    ("printed", "defined", "printed:\ndefined"),
    ("printed", "return_kept", "return\nkept"),
    ("printed", "policy_kept", "policy\nkept"),
    ("printed", "no_more_traps", "no more\ntraps"),
    ("repaired", "return_kept", "repaired:\nreturn"),
    ("repaired", "policy_kept", "policy\nkept"),
    ("repaired", "no_more_traps", "no more\ntraps"),
    ("closed", "policy_kept", "closed:\npolicy"),
    ("closed", "no_more_traps", "no more\ntraps"),
)
EXPLORED = {
    ("domain", ""): ("domain", GREY),
    ("repaired", "stay"): ("repaired, stay", BLUE),
    ("closed", "stay"): ("closed, stay", GREEN),
}
"""Label and colour by form and by what a state without kept actions does."""


@house_style()
def draw(result: Mapping) -> Figure:
    """Shares of tasks and sets, collisions of exploring, episodes of learning: kinds of worlds downwards."""
    kinds = result["settings"]["kinds"]
    learning = (row for row in result["rows"] if "learnt_in" in row)
    table = ResultsTable(learning, ("learnt_in", "form", "dead_ends", "schedule"))
    figure = new_figure(11.5, 2.4 + 0.76 * len(kinds))
    places = figure.add_gridspec(2, 2, width_ratios=[1.3, 1])
    kept = figure.add_subplot(places[0, 0])
    walks = figure.add_subplot(places[0, 1], sharey=kept)
    learnt = figure.add_subplot(places[1, :])
    _draw_walks(walks, result, table)
    _draw_learning(learnt, result, table)
    rows = [row for row in result["rows"] if "kind" in row]
    shares = np.array([[100 * row[form][key] for form, key, _ in KEPT] for row in rows])
    heads, nothing = [head for *_, head in KEPT], np.zeros_like(shares)
    words = "{:.0f}".format
    draw_heat_grid(kept, shares, nothing, kinds, heads, neutral=100.0, spread=100.0, words=words)
    kept.set_title("Where it is so (% of tasks, of sets for defined)")
    for axes in (kept, learnt):
        axes.set_ylim(len(kinds) - 0.5, -0.5)
    walks.tick_params(labelleft=False)
    figure.supxlabel(
        "Lines: 95 % intervals over runs; bold: the interval excludes 1. Framed: the default. stay, free: "
        "staying, or all actions, in a state without kept actions. Printed: actions with η = 1/0 left out.",
        fontsize=8, color=GREY,
    )  # fmt: skip
    return figure


def _draw_walks(axes: Axes, result: Mapping, table: ResultsTable) -> None:
    """Collisions in 100 steps of pure exploration, in the domain and within it."""
    kinds, schedule = result["settings"]["kinds"], result["settings"]["default"]["schedule"]

    def number(kind: str, way: tuple[str, str]) -> dict:
        row = table.record(learnt_in=kind, form=way[0], dead_ends=way[1], schedule=schedule)
        found = row["explored_collisions"]
        return {"value": 100 * found["value"], "ci95": found["ci95"] and [100 * end for end in found["ci95"]]}

    groups = {label: [number(kind, way) for kind in kinds] for way, (label, _) in EXPLORED.items()}
    draw_interval_bars(
        axes, kinds, groups, colours=dict(EXPLORED.values()), legend=False,
        words=lambda share: f"{share:.0f}" if share >= 1 or share == 0 else f"{share:.1f}",
    )  # fmt: skip
    axes.set(title="Collisions in 100 steps of exploring", xlim=(0, None))
    axes.margins(x=0.12)
    axes.grid(axis="x", color=LIGHT)
    axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.07), ncols=3, fontsize=7, columnspacing=1)


def _draw_learning(axes: Axes, result: Mapping, table: ResultsTable) -> None:
    settings = result["settings"]
    columns: list[tuple] = [(*way, schedule) for schedule, way in product(settings["schedules"], WITHIN)]
    numbers = [
        [table.record(learnt_in=kind, form=f, dead_ends=d, schedule=s)["to_80_ratio"] for f, d, s in columns]
        for kind in settings["kinds"]
    ]
    heads = [f"{form},\n{ends}\n{schedule_in_brief(schedule)}" for form, ends, schedule in columns]
    framed = None, columns.index((*WITHIN[0], settings["default"]["schedule"]))
    draw_estimate_grid(
        axes, numbers, settings["kinds"], heads, neutral=1.0, spread=4.0, ratio=True, good="low",
        words="{:.2f}".format, outlined=framed,
    )  # fmt: skip
    axes.set_title("Episodes to 80 %, over those in the domain")
