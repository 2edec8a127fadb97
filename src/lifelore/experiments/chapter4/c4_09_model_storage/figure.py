"""What observation models take to store: tables by the number of rewards, what episodes fill, the worlds."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from lifelore.experiments.chapter4.reuse_palette import look_of
from lifelore.figures.style import GREY, INK, LIGHT, house_style, new_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


def draw(result: Mapping):
    return draw_stored_models(result["rows"])


SIGNALS = {"performance": "U", "reward": "(s, a, r)", "state-action-state": "(s, a, s′)"}
SHOWN_STATES = 16


def draw_stored_models(rows: Sequence[Mapping]) -> "Figure":
    """Three panels, entries on a log scale.

    Parameters
    ----------
    rows : sequence of mapping
        As in the result of C4.9: kind, sizes S, R, A and pairs, and under ``table`` and ``filled`` the entries by
        signal.
    """
    with house_style():
        figure = new_figure(10.5, 3.6)
        left, middle, right = figure.subplots(1, 3, width_ratios=[1, 1, 1.25])
        random = [row for row in rows if row["kind"] == "random"]
        sizes = sorted({row["S"] for row in random})
        n_states = SHOWN_STATES if SHOWN_STATES in sizes else sizes[-1]
        _draw_tables(left, [row for row in random if row["S"] == n_states], n_states)
        _draw_filled(middle, [row for row in random if row["S"] == n_states], n_states)
        _draw_worlds(right, [row for row in rows if row["kind"] != "random"])
    return figure


def _draw_tables(axes: "Axes", rows: Sequence[Mapping], n_states: int) -> None:
    own = _by_rewards(rows, rows[0]["rewards_of"])
    n_rewards = [row["R"] for row in own]
    for name, shown in SIGNALS.items():
        # The two formulas have changed places in print.
        printed = {"reward": ", in print (s, a, s′)", "state-action-state": ", in print (s, a, r)"}.get(name, "")
        entries = [row["table"][name] for row in own]
        axes.plot(n_rewards, entries, "o-", color=look_of(shown)[0], ms=4, label=shown + printed)
    axes.plot(n_rewards, [2 * row["pairs"] for row in own], color=GREY, ls=":", label="U as a Gaussian")
    axes.set(xscale="log", yscale="log", xlabel="rewards |R|", ylabel="entries of the table")
    axes.set_ylim(top=30 * axes.get_ylim()[1])
    axes.set_title(f"Tables, |S| = {n_states}", pad=16)
    _mark(axes, n_states, [row["R"] for row in own])
    axes.legend(loc="upper left")


def _draw_filled(axes: "Axes", rows: Sequence[Mapping], n_states: int) -> None:
    own: list[Mapping] = []
    for of, line in (("transition", "-"), ("noise", (0, (1, 1.2)))):
        own = _by_rewards(rows, of)
        for name, shown in SIGNALS.items():
            axes.plot([r["R"] for r in own], [r["filled"][name] for r in own], color=look_of(shown)[0], ls=line)
    axes.plot([], [], color=GREY, label="reward a function of (s, a, s′)")
    axes.plot([], [], color=GREY, ls=(0, (1, 1.2)), label="noisy reward")
    axes.set(xscale="log", yscale="log", xlabel="rewards |R|", ylabel="entries that episodes filled")
    axes.set_ylim(top=3 * axes.get_ylim()[1])
    axes.set_title("What was ever seen", pad=16)
    _mark(axes, n_states, [row["R"] for row in own])
    axes.legend(loc="upper left")


def _by_rewards(rows: Sequence[Mapping], of: str) -> list[Mapping]:
    return sorted((row for row in rows if row["rewards_of"] == of), key=lambda row: row["R"])


def _mark(axes: "Axes", n_states: int, n_rewards: Sequence[int]) -> None:
    axes.minorticks_off()
    axes.set_xticks(n_rewards, [str(n) for n in n_rewards])
    axes.axvline(n_states, color=INK, lw=0.8, ls=":")
    axes.annotate(
        "|R| = |S|", (n_states, 1), (0, 2), xycoords=("data", "axes fraction"), textcoords="offset points",
        ha="center", va="bottom", fontsize=8,
    )  # fmt: skip
    axes.grid(True, axis="y")


def _draw_worlds(axes: "Axes", rows: Sequence[Mapping]) -> None:
    """Tables as pale bars, what is filled as dark ones."""
    for place, row in enumerate(rows):
        for k, (name, shown) in enumerate(SIGNALS.items()):
            height, y = 0.24, place + 0.26 * (k - 1)
            colour = look_of(shown)[0]
            axes.barh(y, row["table"][name], height, left=1, color=colour, alpha=0.3)
            axes.barh(y, row["filled"][name], height, left=1, color=colour)
    axes.set_yticks(range(len(rows)), [_name(row) for row in rows])
    axes.invert_yaxis()
    axes.set(xscale="log", xlim=(20, None), xlabel="entries: table pale, filled dark")
    axes.set_title("The thesis's worlds")
    axes.grid(True, axis="x", color=LIGHT)


def _name(row: Mapping) -> str:
    shown = {
        "telephone": f"telephone, L = {row.get('models')}",
        "surveillance": f"{row.get('targets')} targets, pay to {row.get('resolution')}",
        "pacman": f"Pacman {row.get('rows')} × {row.get('columns')}",
    }[row["kind"]]
    return f"{shown}\n|S| {row['S']:,}, |R| {row['R']}"
