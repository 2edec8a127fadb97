"""Figure of claim C3.14: what minimised domains keep, how exploring in them collides, and how fast one learns."""

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from lifelore.figures.heat_grid import draw_heat_grid
from lifelore.figures.style import BLUE, GREEN, GREY, LIGHT, house_style, new_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


def draw(result: Mapping):
    return draw_minimised_domains(result)


_KEPT = (
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
_WALKS = (("domain", "", GREY, "domain"), ("repaired", "stay", BLUE, "repaired, stay"))
_WALKS += (("closed", "stay", GREEN, "closed, stay"),)
_WAYS = (("repaired", "stay"), ("repaired", "free"), ("printed", "stay"), ("closed", "stay"))


def draw_minimised_domains(result: Mapping) -> "Figure":
    """The figure from the result of C3.14."""
    kinds = result["settings"]["kinds"]
    with house_style():
        figure = new_figure(16.0, 1.5 + 0.42 * len(kinds))
        kept, walks, learning = figure.subplots(1, 3, sharey=True, width_ratios=[1.2, 0.75, 1.2])
        _draw_kept(kept, result)
        _draw_walks(walks, result)
        _draw_learning(learning, result)
        figure.supxlabel(
            "Bold: the 95 % interval over runs excludes 1. Framed: the default. stay, free: what a state without "
            "kept actions does. Printed: actions with η = 1/0 left out.",
            fontsize=8, color=GREY,
        )  # fmt: skip
    return figure


def _draw_kept(axes: "Axes", result: Mapping) -> None:
    kept = [row for row in result["rows"] if "kind" in row]
    shares = np.array([[100 * row[form][key] for form, key, _ in _KEPT] for row in kept])
    heads = [head for *_, head in _KEPT]
    draw_heat_grid(
        axes, shares, np.zeros_like(shares, bool), [row["kind"] for row in kept], heads, neutral=100.0,
        spread=100.0, words="{:.0f}".format,
    )  # fmt: skip
    axes.set_title("Where it is so (% of tasks, of sets for defined)")


def _draw_walks(axes: "Axes", result: Mapping) -> None:
    """Collisions a step of pure exploration, in the domain and within it."""
    schedule = result["settings"]["default"]["schedule"]
    for place, kind in enumerate(result["settings"]["kinds"]):
        for shift, (form, ends, colour, label) in zip((-0.24, 0.0, 0.24), _WALKS, strict=True):
            row = _row(result, kind, form, ends, schedule)
            share = 100 * row["explored_collisions"]["value"]
            axes.barh(place + shift, share, height=0.2, color=colour, label=label if place == 0 else None)
            axes.annotate(
                f"{share:.0f}" if share >= 1 or share == 0 else f"{share:.1f}", (share, place + shift), (3, 0),
                textcoords="offset points", va="center", fontsize=6.5,
            )  # fmt: skip
    axes.set(title="Collisions in 100 steps of exploring", xlim=(0, None))
    axes.margins(x=0.12)
    axes.grid(axis="x", color=LIGHT)
    axes.tick_params(axis="y", length=0)
    axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.07), ncols=3, fontsize=7, columnspacing=1)


def _draw_learning(axes: "Axes", result: Mapping) -> None:
    settings = result["settings"]
    columns = [(way, schedule) for schedule in settings["schedules"] for way in _WAYS]
    cells = [
        [_row(result, kind, *way, schedule)["to_80_ratio"] for way, schedule in columns]
        for kind in settings["kinds"]
    ]
    values = [[np.nan if c["value"] is None else c["value"] for c in row] for row in cells]
    certain = [[bool(c["ci95"]) and not c["ci95"][0] <= 1 <= c["ci95"][1] for c in row] for row in cells]
    heads = [f"{form},\n{ends}\nε {_epsilon(schedule)}" for (form, ends), schedule in columns]
    default = columns.index((_WAYS[0], settings["default"]["schedule"]))
    draw_heat_grid(
        axes, values, certain, settings["kinds"], heads, neutral=1.0, spread=4.0, ratio=True, good="low",
        words="{:.2f}".format,
    )  # fmt: skip
    _frame_column(axes, default, len(settings["kinds"]))
    axes.set_title("Episodes to 80 %, over those in the domain")


def _frame_column(axes: "Axes", column: int, n_rows: int) -> None:
    from matplotlib.patches import Rectangle

    from lifelore.figures.style import INK

    corner = (column - 0.5, -0.5)
    axes.add_patch(Rectangle(corner, 1, n_rows, fill=False, edgecolor=INK, linewidth=1.6, clip_on=False, zorder=3))


def _epsilon(schedule) -> str:
    first, decay, _ = schedule
    return f"{first:g}" if decay == 1 else f"{first:g} × {decay:g}"


def _row(result: Mapping, kind: str, form: str, ends: str, schedule) -> Mapping:
    return next(
        row
        for row in result["rows"]
        if row.get("learnt_in") == kind
        and (row["form"], row["dead_ends"], row["schedule"]) == (form, ends, schedule)
    )
