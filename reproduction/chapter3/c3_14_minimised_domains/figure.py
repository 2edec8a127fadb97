"""Figure of claim C3.14: what minimised domains keep, how exploring in them collides, and how fast one learns."""

from collections import Counter
from collections.abc import Mapping
from itertools import product

import numpy as np

from lifelore.figures.heat_grid import draw_estimate_grid, draw_heat_grid, frame_cells, name_groups
from lifelore.figures.interval_bars import draw_interval_bars
from lifelore.figures.style import BLUE, GREY, LIGHT, ORANGE, Axes, Figure, house_style, new_figure
from reproduction.chapter3.c3_14_minimised_domains.run import WITHIN
from reproduction.chapter3.learning.schedules import schedule_in_words
from reproduction.engine.results_table import ResultsTable

KEPT = (
    ("printed", "return_kept", "return\nkept"),
    ("printed", "policy_kept", "policy\nkept"),
    ("printed", "no_more_traps", "no more\ntraps"),
    ("printed", "defined", "defined"),
    ("repaired", "return_kept", "return\nkept"),
    ("repaired", "policy_kept", "policy\nkept"),
    ("repaired", "no_more_traps", "no more\ntraps"),
    ("closed", "policy_kept", "policy\nkept"),
    ("closed", "no_more_traps", "no more\ntraps"),
)
FORMS = {"printed": "as printed", "repaired": "repaired", "closed": "closed"}
EXPLORED = {
    ("domain", ""): ("domain", GREY),
    ("printed", "stay"): ("as printed", BLUE),
    ("repaired", "stay"): ("repaired", ORANGE),
}
"""Label and colour by form and by what a state without kept actions does."""


@house_style()
def draw(result: Mapping) -> Figure:
    """Shares of tasks and sets, collisions of exploring, episodes of learning: kinds of worlds downwards."""
    kinds = result["settings"]["kinds"]
    learning = (row for row in result["rows"] if "learnt_in" in row)
    table = ResultsTable(learning, ("learnt_in", "form", "dead_ends", "schedule"))
    figure = new_figure(11.5, 3.2 + 0.76 * len(kinds))
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
    kept.set_title("Share of tasks for which each statement holds (%)", pad=24)
    groups = Counter(form for form, *_ in KEPT)
    name_groups(kept, [(words, groups[form]) for form, words in FORMS.items()], 5, side="top")
    frame_cells(kept, (0, 0), (len(kinds), 2))
    for axes in (kept, learnt):
        axes.set_ylim(len(kinds) - 0.5, -0.5)
    walks.tick_params(labelleft=False)
    figure.supxlabel(
        "Framed: what the verdict reads, the domain as printed without the actions whose η is 1/0. It also reads "
        f"the collisions and the traps\n(change where the domain has some: {_change_in_traps(result)}). "
        "defined: share of sets of tasks without η = 1/0. repaired, closed: after errata E8 and E36.\n"
        "stay, free: staying, or all actions, in a state without kept actions. Lines: 95 % intervals over runs; "
        "bold: the interval excludes 1.",
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
    axes.set_title("Collisions in 100 steps of random exploring", pad=24)
    axes.set_xlim(0, None)
    axes.set_xlim(0, 1.08 * axes.get_xlim()[1])
    axes.grid(axis="x", color=LIGHT)
    axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.07), ncols=3, fontsize=7, columnspacing=1)


def _draw_learning(axes: Axes, result: Mapping, table: ResultsTable) -> None:
    settings = result["settings"]
    ways = sorted(WITHIN, key=lambda way: list(FORMS).index(way[0]))
    columns: list[tuple] = [(*way, schedule) for schedule, way in product(settings["schedules"], ways)]
    numbers = [
        [table.record(learnt_in=kind, form=f, dead_ends=d, schedule=s)["to_80_ratio"] for f, d, s in columns]
        for kind in settings["kinds"]
    ]
    heads = [f"{FORMS[form]},\n{ends}" for form, ends, _ in columns]
    framed = None, columns.index(("printed", "stay", settings["default"]["schedule"]))
    draw_estimate_grid(
        axes, numbers, settings["kinds"], heads, neutral=1.0, spread=4.0, ratio=True, good="low",
        words="{:.2f}".format, outlined=framed,
    )  # fmt: skip
    axes.set_title("Episodes to 80 % of the optimal return, as a ratio to those in the domain", pad=24)
    name_groups(axes, [(schedule_in_words(one), len(ways)) for one in settings["schedules"]], 5, side="top")


def _change_in_traps(result: Mapping) -> str:
    """The change in traps and dead ends where the domain has some, as printed."""
    value = result["measured"]["trap_difference_with_traps_printed"]["value"]
    return "unmeasured" if value is None else f"{value:+.1f} states".replace("-", "−")
