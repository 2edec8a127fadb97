"""C2.3: where the displacements of each relation lie, seen from the front (§2.4.1, Figure 2.4).

The printed plot has no unit, and its signs agree only if y points down (erratum E18): displacements are χ_A - χ_B
with x to the camera's right and y down, and places are fractions of where the *on* cluster lies.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import product

import numpy as np
from numpy.typing import NDArray

from lifelore.core.intervals import percentile_interval
from lifelore.core.metrics import Estimate
from lifelore.core.relations import ADJACENT, CORE_RELATIONS, ON
from lifelore.core.streams import stream
from lifelore.figures.scenes.object_palette import mixed
from lifelore.figures.style import BLUE, GREEN, GREY, INK, LIGHT, ORANGE, PAPER, Axes
from reproduction.chapter2.scenes import tabletop_pairs
from reproduction.chapter2.scenes.tabletop_pairs import Row, simulated_sets
from reproduction.chapter2.scoring.pair_validation import CONTACT_READINGS, Reading, displacements
from reproduction.engine.estimates import UNMEASURED, share_by_cluster
from reproduction.figures.panels import panels

EDGE = 0.2
"""The printed band begins at y = -0.1, a fifth of the way to the printed cluster at y = -0.5."""
CHOICES = ("all", "no longer than omega", "shortest")
"""Which displacements of a pair are plotted; the thesis plots "the separation displacements"."""
cells, run_cell, shared = tabletop_pairs.pair_cells, tabletop_pairs.run_cell, tabletop_pairs.SETTINGS_OF_A_CELL


@dataclass(frozen=True, eq=False)
class Plot:
    """Displacements of some rows as Figure 2.4 shows them: places `at` ``(m, 2)`` to the right and down, metres.

    Each has the number of its row, and its pair's relation and scene, all ``(m,)``.
    """

    at: NDArray[np.float64]
    row: NDArray[np.int64]
    relation: NDArray[np.str_]
    scene: NDArray[np.str_]

    @property
    def middle_of_on(self) -> NDArray[np.float64]:
        """Median place of the *on* displacements, ``(2,)``; NaN without any."""
        on = self.at[self.relation == ON]
        return np.median(on, axis=0) if len(on) else np.full(2, np.nan)

    @property
    def outside_band(self) -> NDArray[np.bool_]:
        """Which lie on the *on* cluster's side of `EDGE` of the way to it, ``(m,)``."""
        y = self.middle_of_on[1]
        return self.at[:, 1] * np.sign(y) >= EDGE * abs(y)


def plotted(rows: Sequence[Row], reading: Reading, choice: str, omega: float) -> Plot:
    """The displacements of `rows` chosen by a rule of `CHOICES`."""

    def chosen(moved: NDArray[np.float64]) -> NDArray[np.float64]:
        length = np.linalg.norm(moved, axis=1)
        if choice == "shortest":
            return moved[np.argsort(length, kind="stable")[:1]]
        return moved[length <= omega] if choice == "no longer than omega" else moved

    each = [chosen(displacements(row, reading.kernel, reading.threshold)) for row in rows]
    owner = np.repeat(np.arange(len(rows)), [len(moved) for moved in each])
    relation, scene = (np.array([row[key] for row in rows], dtype=str)[owner] for key in ("relation", "scene"))
    return Plot(np.concatenate(each)[:, [0, 2]] * (1, -1), owner, relation, scene)


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """The measures of all displacements of the simulated pairs at the standard kernel."""
    pairs = [row for rows in simulated_sets(results) for row in rows]
    return measures(pairs, plotted(pairs, Reading(), CHOICES[0], settings["omega"]), settings["resamples"])


def readings(settings: Mapping, results: Sequence[Mapping]) -> Iterator[tuple[dict, dict[str, Estimate]]]:
    """The measures for every kernel, threshold and choice of displacements."""
    pairs = [row for rows in simulated_sets(results) for row in rows]
    for reading, choice in product(CONTACT_READINGS, CHOICES):
        plot = plotted(pairs, reading, choice, settings["omega"])
        head = {"kernel": reading.kernel, "threshold": reading.threshold, "displacements": choice}
        yield head, measures(pairs, plot, max(2, settings["resamples"] // 10))


def measures(rows: Sequence[Row], plot: Plot, resamples: int) -> dict[str, Estimate]:
    """|x| / |y| of the *on* cluster; shares of *on* outside, *adjacent* inside the band, and sides by sign."""
    on, adjacent = plot.relation == ON, plot.relation == ADJACENT
    return {
        "on_sideways_of_its_rise": sideways_of_rise(plot, resamples),
        "on_outside_band": share_by_cluster(plot.outside_band[on], plot.scene[on]),
        "adjacent_in_band": share_by_cluster(~plot.outside_band[adjacent], plot.scene[adjacent]),
        "sign_of_x_tells_left_right": share_by_cluster(*sign_answers(rows, plot)),
    }


def sign_answers(rows: Sequence[Row], plot: Plot) -> tuple[list[bool], list[str]]:
    """Of every adjacent pair that stands sideways: whether its mean x has the sign of its side, and its scene."""
    answers, scenes = [], []
    for number, row in enumerate(rows):
        right, behind, _ = row["centres"]
        own = plot.at[plot.row == number, 0]
        if row["relation"] == ADJACENT and abs(right) > abs(behind) and len(own):
            answers.append(bool((own.mean() > 0) == (right > 0)))
            scenes.append(row["scene"])
    return answers, scenes


def sideways_of_rise(plot: Plot, resamples: int) -> Estimate:
    """|x| / |y| of the middle of *on*; pairs resampled (percentiles)."""
    on = plot.relation == ON
    if not on.any():
        return UNMEASURED
    own = [plot.at[on & (plot.row == owner)] for owner in np.unique(plot.row[on])]
    draws = stream(len(own), "C2.3", "pairs resampled").integers(0, len(own), (resamples, len(own)))
    middles = [np.median(np.concatenate([own[i] for i in draw]), axis=0) for draw in draws]
    interval = percentile_interval([_slope(middle) for middle in middles])
    value = _slope(plot.middle_of_on)
    return Estimate(value, value, interval, int(on.sum()))


def _slope(middle: NDArray[np.float64]) -> float:
    return float(abs(middle[0]) / max(abs(middle[1]), 1e-9))


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """The displacements of the first data set by relation, as many pairs as the thesis plots, millimetres."""
    plot = plotted(simulated_sets(results)[0], Reading(), CHOICES[0], settings["omega"])
    middle = np.round(1000 * plot.middle_of_on, 1).tolist()
    return [
        {"relation": name, "middle_of_on": middle, "mm": np.round(1000 * plot.at[own], 1).tolist()}
        for name in CORE_RELATIONS
        if (own := plot.relation == name).any()
    ]


LOOKS = {"on": (BLUE, "o"), "adjacent": (ORANGE, "s"), "both": (GREEN, "^"), "none": (GREY, "x")}
"""Colour and marker of each relation, distinguishable with every common colour blindness."""
CLOSE = 20
"""Millimetres; how far the second view reaches."""


@panels(9.6, 4.6, 1, 2, grid="")
def draw(result: Mapping, whole: Axes, close: Axes) -> None:
    """Displacements between contact points, seen from the front and coloured by relation (Figure 2.4).

    All displacements, and those close to the origin.
    """
    rows = result["rows"]
    furthest = 1.05 * max(np.abs(row["mm"]).max() for row in rows)
    draw_displacements(whole, rows, "all displacements", furthest)
    draw_displacements(close, rows, f"within {CLOSE} mm", CLOSE)
    whole.legend(loc="upper right")
    right, down = (place + 0.0 for place in rows[0]["middle_of_on"])
    close.plot(right, down, "+", ms=13, mew=2, color=INK, zorder=5)
    words = f"+ middle of on ({right:.1f}, {down:.1f}) mm\nthesis: (0, −0.5), no unit".replace("-", "−")
    box = {"facecolor": PAPER, "edgecolor": "none", "alpha": 0.8, "pad": 2}
    close.annotate(words, (0.03, 0.03), xycoords="axes fraction", fontsize=8, color=INK, bbox=box, zorder=6)
    close.annotate("band of adjacent (thesis: above y = −0.1)", (0.04, 0.95), xycoords="axes fraction", fontsize=8)


def draw_displacements(axes: Axes, rows: Sequence[Mapping], title: str, reach: float) -> None:
    """The displacements of each relation within `reach` mm, and the band of *adjacent*, shaded.

    Many points fade, so that dense places stay visible.
    `rows` are ``{"relation", "mm", "middle_of_on"}``.
    """
    down = rows[0]["middle_of_on"][1]
    groups = {row["relation"]: np.array(row["mm"]).reshape(-1, 2) for row in rows}
    axes.axhline(0, color=LIGHT, lw=1, zorder=0)
    axes.axvline(0, color=LIGHT, lw=1, zorder=0)
    for relation, at in groups.items():
        colour, marker = LOOKS[relation]
        alpha = float(np.clip(12 / np.sqrt(max(1, len(at))), 0.25, 0.85))
        edge = {} if marker == "x" else {"edgecolors": mixed(colour, INK, 0.3)}
        axes.scatter(*at.T, s=20, marker=marker, color=colour, alpha=alpha, linewidths=0.5, **edge)
        axes.scatter([], [], s=22, marker=marker, color=colour, label=relation)
    axes.set(title=title, xlabel="x (mm to the right)", ylabel="y (mm, down is positive, as in a picture)")
    if down is not None:
        ends = sorted((EDGE * down, -np.sign(down) * 2 * reach))
        axes.axhspan(ends[0], ends[1], color=mixed(LOOKS[ADJACENT][0], PAPER, 0.85), lw=0, zorder=-1)
    axes.set(xlim=(-reach, reach), ylim=(-reach, reach))
    axes.set_aspect("equal")
