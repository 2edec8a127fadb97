"""Entries of the tables of three observation models by number of rewards, beside the printed formulas."""

from collections.abc import Mapping

from lifelore.figures.style import INK, Axes
from reproduction.chapter4.reuse.looks import PRINTED, look_of
from reproduction.figures.panels import panels

NAMES = {"performance": "performance", "reward": "(s, a, r)", "state_action_state": "(s, a, s′)"}


@panels(6.4, 3.8)
def draw(result: Mapping, axes: Axes) -> None:
    """Solid: tables that were learnt; dashed: the printed formula of the same colour."""
    rows = sorted(result["rows"], key=lambda row: row["rewards"])
    n_states, n_rewards = rows[0]["states"], [row["rewards"] for row in rows]
    for name, label in NAMES.items():
        colour = look_of(label)["color"]
        axes.plot(n_rewards, [row["table"][name] for row in rows], label=label, color=colour)
        if name != "performance":
            printed = [row["printed"][name] for row in rows]
            axes.plot(n_rewards, printed, color=colour, ls=PRINTED, zorder=3, label=f"{label}, printed formula")
    axes.axvline(n_states, color=INK, lw=0.8, ls=":")
    axes.text(n_states, 0.98, " |R| = |S|", transform=axes.get_xaxis_transform(), va="top", fontsize=8)
    axes.set(ylim=(0, None), xlabel="number of rewards |R|", ylabel="entries of the table")
    axes.set_title(f"Three observation models, |S| = {n_states}")
    axes.legend()
