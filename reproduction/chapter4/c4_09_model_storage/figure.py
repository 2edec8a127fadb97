"""Sizes of observation models: tables by number of rewards, entries that episodes fill, the thesis's worlds."""

from collections.abc import Mapping, Sequence

from lifelore.figures.curves import draw_curves
from lifelore.figures.style import GREY, INK, LIGHT, PAPER, Axes, Figure, house_style, new_figure
from reproduction.chapter4.reuse.looks import look_of

SIGNALS = {"performance": "U", "reward": "(s, a, r)", "state-action-state": "(s, a, s′)"}
PRINTED = {"reward": ", in print (s, a, s′)", "state-action-state": ", in print (s, a, r)"}
"""The two formulas have changed places in print."""
SHOWN_STATES = 16
LINES = {"transition": ("-", "reward a function of (s, a, s′)"), "noise": ((0, (1, 1.2)), "noisy reward")}


def draw(result: Mapping) -> Figure:
    random = [row for row in result["rows"] if row["kind"] == "random"]
    sizes = {row["S"] for row in random}
    n_states = SHOWN_STATES if SHOWN_STATES in sizes else max(sizes)
    own = sorted((row for row in random if row["S"] == n_states), key=lambda row: row["R"])
    with house_style():
        figure = new_figure(10.5, 3.6)
        left, middle, right = figure.subplots(1, 3, width_ratios=[1, 1, 1.25])
        _draw_tables(left, [row for row in own if row["rewards_of"] == own[0]["rewards_of"]], n_states)
        _draw_filled(middle, own, n_states)
        _draw_worlds(right, [row for row in result["rows"] if row["kind"] != "random"])
    return figure


def _draw_tables(axes: Axes, rows: Sequence[Mapping], n_states: int) -> None:
    series, looks = {}, {}
    for name, shown in SIGNALS.items():
        label = shown + PRINTED.get(name, "")
        series[label] = {"mean": [row["table"][name] for row in rows]}
        looks[label] = {"color": look_of(shown)[0], "marker": "o", "ms": 4}
    series["U as a Gaussian"] = {"mean": [2 * row["pairs"] for row in rows]}
    looks["U as a Gaussian"] = {"ls": ":"}
    n_rewards = [row["R"] for row in rows]
    draw_curves(axes, n_rewards, series, looks=looks, ylabel="entries of the table", legend=False)
    _finish(axes, n_states, n_rewards, f"Tables, |S| = {n_states}", 30)


def _draw_filled(axes: Axes, rows: Sequence[Mapping], n_states: int) -> None:
    for of, (line, label) in LINES.items():
        own = [row for row in rows if row["rewards_of"] == of]
        for name, shown in SIGNALS.items():
            filled = [row["filled"][name] for row in own]
            axes.plot([row["R"] for row in own], filled, color=look_of(shown)[0], ls=line)
        axes.plot([], [], color=GREY, ls=line, label=label)
    axes.set_ylabel("entries that episodes filled")
    _finish(axes, n_states, sorted({row["R"] for row in rows}), "Entries ever seen", 3)


def _finish(axes: Axes, n_states: int, n_rewards: Sequence[int], title: str, room: float) -> None:
    """Both axes logarithmic, |R| = |S| marked, and `room` times the height for the legend."""
    axes.set(xscale="log", yscale="log", xlabel="rewards |R|")
    axes.set_ylim(top=room * axes.get_ylim()[1])
    axes.minorticks_off()
    axes.set_xticks(n_rewards, [str(n) for n in n_rewards])
    axes.set_title(title, pad=16)
    axes.axvline(n_states, color=INK, lw=0.8, ls=":")
    above = axes.get_xaxis_transform()
    axes.text(n_states, 1.01, "|R| = |S|", transform=above, ha="center", va="bottom", fontsize=8)
    axes.grid(True, axis="y")
    axes.legend(loc="upper left", frameon=True, framealpha=1, edgecolor=PAPER)


def _draw_worlds(axes: Axes, rows: Sequence[Mapping]) -> None:
    """Tables as pale bars, the entries that episodes filled as dark ones."""
    for place, row in enumerate(rows):
        for k, (name, shown) in enumerate(SIGNALS.items()):
            y, colour = place + 0.26 * (k - 1), look_of(shown)[0]
            axes.barh(y, row["table"][name], 0.24, left=1, color=colour, alpha=0.3)
            axes.barh(y, row["filled"][name], 0.24, left=1, color=colour)
    axes.set_yticks(range(len(rows)), [_name(row) for row in rows])
    axes.invert_yaxis()
    axes.set(xscale="log", xlim=(20, None), xlabel="entries: table pale, filled dark", title="The thesis's worlds")
    axes.grid(True, axis="x", color=LIGHT)


def _name(row: Mapping) -> str:
    shown = {
        "telephone": f"telephone, L = {row.get('models')}",
        "surveillance": f"{row.get('targets')} targets, pay to {row.get('resolution')}",
        "pacman": f"Pacman {row.get('rows')} × {row.get('columns')}",
    }[row["kind"]]
    return f"{shown}\n|S| {row['S']:,}, |R| {row['R']}"
