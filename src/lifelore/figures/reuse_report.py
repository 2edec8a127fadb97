"""Picture of `reuse report`: outcomes by decision, each policy in the control group, and regret by the library."""

import math
from collections.abc import Mapping
from typing import TYPE_CHECKING

from lifelore.figures.style import BLUE, GREY, INK, LIGHT, ORANGE, house_style, new_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

GROUPS = {"personal": ("chosen by belief", BLUE), "control": ("held out", ORANGE)}
MOST_POLICIES = 20
"""Policies drawn: the best ones."""


def draw_reuse_report(document: Mapping) -> "Figure":
    """The picture from what `agent.personalise.study_report` returns."""
    with house_style():
        figure = new_figure(10.4, 3.8)
        curves, policies, regret = figure.subplots(1, 3, width_ratios=[1.3, 1.2, 0.7])
        _draw_curves(curves, document["by_decision"])
        _draw_policies(policies, document)
        _draw_regret(regret, document["regret"])
        figure.suptitle(_headline(document), x=0.01, ha="left")
        figure.supxlabel(
            f"Study {document['study']}: {document['decisions']} decisions, {document['pending']} open; "
            f"held out: {document['control_gets']}. Each user counts once; bars, bands: 95 % intervals.",
            fontsize=8, color=GREY, parse_math=False,
        )  # fmt: skip
    return figure


def _headline(document: Mapping) -> str:
    uplift = document["uplift"]
    if uplift is None:
        return "No comparison yet: one of the two groups has no outcome"
    text = f"Uplift {_signed(uplift['value'])}"
    if uplift["ci95"]:
        text += f" ({_signed(uplift['ci95'][0])} to {_signed(uplift['ci95'][1])})"
    return f"{text} over {uplift['n'][0]} users against {uplift['n'][1]} held out"


def _draw_curves(axes: "Axes", points: list) -> None:
    from matplotlib.ticker import MaxNLocator

    for name, (label, colour) in GROUPS.items():
        known = [(point["decision"], point[name]) for point in points if point[name]]
        if not known:
            continue
        places = [place for place, _ in known]
        axes.plot(places, [one["value"] for _, one in known], color=colour, label=label)
        low, high = zip(*(one["ci95"] or (math.nan, math.nan) for _, one in known), strict=True)
        axes.fill_between(places, low, high, color=colour, alpha=0.18, linewidth=0)
    axes.set(title="Mean outcome", xlabel="decision for a user")
    axes.xaxis.set_major_locator(MaxNLocator(integer=True))
    axes.grid(axis="y", color=LIGHT)
    if axes.get_legend_handles_labels()[0]:
        axes.legend()


def _draw_policies(axes: "Axes", document: Mapping) -> None:
    rows = [(row["name"], row["outcome"], GREY) for row in document["policies"] if row["outcome"]]
    rows = sorted(rows, key=lambda row: -row[1]["value"])[:MOST_POLICIES]
    for name, (label, colour) in GROUPS.items():
        if document[name]:
            rows.append((label, document[name], colour))
    for place, (_, outcome, colour) in enumerate(rows):
        if outcome["ci95"]:
            axes.plot(outcome["ci95"], [place, place], color=colour, linewidth=1.4, zorder=2)
        axes.plot([outcome["value"]], [place], "o", color=colour, ms=5, zorder=3)
    axes.set_yticks(range(len(rows)), [_short(row[0]) for row in rows], fontsize=7.5, parse_math=False)
    axes.set(title="Each policy, held-out users", xlabel="mean outcome of a user")
    axes.invert_yaxis()
    axes.grid(axis="x", color=LIGHT)


def _draw_regret(axes: "Axes", regret: Mapping) -> None:
    for place, (name, (_, colour)) in enumerate(GROUPS.items()):
        if not regret[name]:
            continue
        axes.bar([place], [regret[name]["value"]], width=0.7, color=colour, alpha=0.9, zorder=2)
        if regret[name]["ci95"]:
            axes.plot([place, place], regret[name]["ci95"], color=INK, linewidth=1.1, zorder=3)
    axes.set(title="Regret, by the library", xlim=(-0.6, 1.6))
    axes.set_xticks([0, 1], [label for label, _ in GROUPS.values()], fontsize=7.5)
    axes.grid(axis="y", color=LIGHT)


def _signed(value: float) -> str:
    return f"{value:+.3g}".replace("-", "−")


def _short(name: str) -> str:
    return name if len(name) <= 24 else name[:23] + "…"
