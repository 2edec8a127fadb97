"""Figures of a claim's statements: the number of each beside its bound, and a dot for each of its readings."""

import json
from collections.abc import Mapping, Sequence

import numpy as np

from lifelore.figures.style import BLUE, GREY, INK, ORANGE, VERMILION, Axes, Figure, new_figure
from reproduction.engine.claim import Claim
from reproduction.engine.statement import HALF, MISSING, NO, YES, Statement, number_in_words

COLOURS = {YES: BLUE, HALF: ORANGE, NO: VERMILION, MISSING: GREY}
WORDS = {YES: "holds", HALF: "holds on average", NO: "does not hold"}
MOST_LABEL = 34
"""Characters of a choice's value that a row shows."""


def draw_numbers(claim: Claim, result: Mapping) -> Figure:
    """A strip a statement with its number at the default, the 95 % interval, and the bound."""
    shown = [one for one in claim.statements if one.measure in result["measured"]]
    figure = new_figure(7.6, 0.6 + 0.62 * len(shown))
    strips = figure.subplots(len(shown), 1, squeeze=False)[:, 0]
    for axes, statement in zip(strips, shown, strict=True):
        number, colour = result["measured"][statement.measure], COLOURS[statement.mark(result["measured"])]
        if number["ci95"]:
            axes.plot(number["ci95"], [0, 0], color=colour, lw=2)
        if number["value"] is not None:
            axes.plot(number["value"], 0, "o", color=colour, ms=6)
        _draw_bound(axes, statement)
        axes.set(ylim=(-1, 1), yticks=[])
        axes.set_title(f"{_plain(statement.says)}: {number_in_words(number)}", loc="left", fontsize=9)
    _draw_legend(figure)
    return figure


def draw_readings(claim: Claim, result: Mapping) -> Figure:
    """The strips of a result's statements that were read in more than one way."""
    found = {
        one: [reading for reading in result["readings"] if one.measure in reading] for one in claim.statements
    }
    found = {one: readings for one, readings in found.items() if readings}
    rows = {one: _rows(one, readings) for one, readings in found.items()}
    heights = [1.0 + 0.28 * len(rows[one][1]) for one in found]
    figure = new_figure(7.6, 0.5 + sum(heights))
    strips = figure.subplots(len(found), 1, squeeze=False, height_ratios=heights)[:, 0]
    for axes, (statement, readings) in zip(strips, found.items(), strict=True):
        _draw_strip(axes, statement, readings, *rows[statement], result["measured"][statement.measure]["value"])
    _draw_legend(figure, default=True)
    figure.suptitle(f"{claim.id}: every reading of the choices left open, a dot each", x=0.01, ha="left")
    return figure


def _plain(says: str) -> str:
    """A statement without the marks of emphasis that its page has."""
    return says.replace("*", "")


def _draw_legend(figure: Figure, default: bool = False) -> None:
    from matplotlib.lines import Line2D

    looks = {"marker": "o", "linestyle": "", "markersize": 4}
    handles = [Line2D([], [], color=COLOURS[mark], label=words, **looks) for mark, words in WORDS.items()]
    if default:
        handles.append(Line2D([], [], color=INK, lw=0.8, label="default"))
    handles.append(Line2D([], [], color=GREY, ls="--", label="bound"))
    figure.legend(handles=handles, loc="outside lower left", ncols=5, fontsize=8)


def _draw_bound(axes: Axes, statement: Statement) -> None:
    for bound in np.atleast_1d(np.asarray(statement.bound, float)):
        axes.axvline(bound, color=GREY, lw=0.9, ls=(0, (3, 2)))


def deciding_choice(statement: Statement, readings: Sequence[Mapping]) -> str:
    """The choice whose values differ most in how often the statement holds; empty where no choice varies."""
    holds = np.array([statement.mark(reading) == YES for reading in readings], float)
    spread = {}
    for key in dict.fromkeys(key for reading in readings for key in reading["cell"]):
        values = [_label(reading["cell"].get(key)) for reading in readings]
        shares = [holds[[value == one for value in values]].mean() for one in dict.fromkeys(values)]
        if len(shares) > 1:
            spread[key] = max(shares) - min(shares)
    return max(spread, key=lambda key: spread[key], default="")


def _rows(statement: Statement, readings: Sequence[Mapping]) -> tuple[str, list[str]]:
    key = deciding_choice(statement, readings)
    return key, list(dict.fromkeys(_label(reading["cell"].get(key)) for reading in readings))


def _label(value: object) -> str:
    text = value if isinstance(value, str) else "–" if value is None else json.dumps(value, ensure_ascii=False)
    return text if len(text) <= MOST_LABEL else text[: MOST_LABEL - 1] + "…"


def _draw_strip(
    axes: Axes,
    statement: Statement,
    readings: Sequence[Mapping],
    key: str,
    rows: Sequence[str],
    default: float | None,
) -> None:
    """Dots at the statement's measure, coloured by its mark; dashed: its bound; a ring: the default's value."""
    for place, row in enumerate(rows):
        own = [reading for reading in readings if _label(reading["cell"].get(key)) == row]
        own.sort(key=lambda reading: reading[statement.measure]["value"] or 0.0)
        for reading, shift in zip(own, np.linspace(-0.25, 0.25, len(own)) if len(own) > 1 else [0.0], strict=True):
            colour = COLOURS[statement.mark(reading)]
            axes.plot(reading[statement.measure]["value"], place + shift, "o", ms=3.6, color=colour, mew=0)
    if default is not None:
        axes.axvline(default, color=INK, lw=0.8, alpha=0.6)
    _draw_bound(axes, statement)
    axes.set(ylim=(len(rows) - 0.5, -0.5), yticks=range(len(rows)), yticklabels=rows, ylabel=key.replace("_", " "))
    share = sum(statement.mark(reading) == YES for reading in readings)
    axes.set_title(f"{_plain(statement.says)}: {share} of {len(readings)}", loc="left", fontsize=9)
    values = np.array(
        [r[statement.measure]["value"] for r in readings if r[statement.measure]["value"] is not None]
    )
    if values.size and np.ptp(values) > 50 * (np.percentile(values, 75) - np.percentile(values, 25) + 1e-12):
        axes.set_xscale("symlog", linthresh=float(np.median(np.abs(values))) or 1.0)
