"""Claim C2.3: where the displacements of each relation lie (§2.4.1, Figure 2.4)."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import product

import numpy as np
from numpy.typing import NDArray

from lifelore.core.metrics import Estimate
from lifelore.core.relations import ADJACENT, CORE_RELATIONS, ON
from lifelore.core.streams import stream
from reproduction.chapter2.scenes import tabletop_pairs
from reproduction.chapter2.scenes.tabletop_pairs import KERNELS, STANDARD, Row, data_sets, kernel_name
from reproduction.chapter2.scoring.pair_validation import AS_PRINTED, DROPS, as_scene, displacements
from reproduction.chapter2.scoring.relation_scoring import share_over_scenes
from reproduction.engine.estimates import UNMEASURED, share_of

EDGE = 0.2
"""The printed band begins at y = -0.1, a fifth of the way to the printed cluster at y = -0.5."""
CHOICES = ("all", "no longer than omega", "shortest")
"""Which displacements of a pair are plotted; the thesis plots "the separation displacements"."""
FRACTIONS = (
    "on_centre_sideways_of_its_rise", "on_on_one_side", "adjacent_in_band", "on_outside_band",
    "sign_of_x_tells_left_right",
)  # fmt: skip
BOUNDS = (0.2, 0.9, 0.75, 0.75, 0.9)
"""The bounds of the filed conditions: at most the first, at least the others."""
SHOWN = 660
"""Pairs in the figure: more would hide one another."""
cells, run_cell, shared = tabletop_pairs.pair_cells, tabletop_pairs.run_cell, tabletop_pairs.SETTINGS_OF_A_CELL
Answers = tuple[NDArray[np.str_], NDArray[np.bool_]]
"""The scene of each answer, and whether it is right."""


@dataclass(frozen=True, eq=False)
class Plot:
    """Displacements of some rows as Figure 2.4 shows them: places `at` ``(m, 2)`` to the right and up, metres.

    Each has the number of its row, and its pair's relation and scene, all ``(m,)``.
    """

    at: NDArray[np.float64]
    row: NDArray[np.int64]
    relation: NDArray[np.str_]
    scene: NDArray[np.str_]

    @property
    def middle_of_on(self) -> NDArray[np.float64]:
        """Median to the right and up of the *on* displacements, ``(2,)``; NaN without any."""
        on = self.at[self.relation == ON]
        return np.median(on, axis=0) if len(on) else np.full(2, np.nan)

    @property
    def outside_band(self) -> NDArray[np.bool_]:
        """Which lie on the *on* cluster's side of `EDGE` of the way to it, ``(m,)``."""
        up = self.middle_of_on[1]
        return self.at[:, 1] * np.sign(up) >= EDGE * abs(up)


def plotted(rows: Sequence[Row], kernel: str, drop: str, choice: str, omega: float) -> Plot:
    """The displacements of `rows` found with a kernel of `KERNELS` and chosen by a rule of `CHOICES`."""

    def chosen(moved: NDArray[np.float64]) -> NDArray[np.float64]:
        length = np.linalg.norm(moved, axis=1)
        if choice == "shortest":
            return moved[np.argsort(length, kind="stable")[:1]]
        return moved[length <= omega] if choice == "no longer than omega" else moved

    each = [chosen(displacements(row, kernel, drop)) for row in rows]
    owner = np.repeat(np.arange(len(rows)), [len(moved) for moved in each])
    relation, scene = (np.array([row[key] for row in rows], dtype=str)[owner] for key in ("relation", "scene"))
    return Plot(np.concatenate(each)[:, [0, 2]], owner, relation, scene)


def by_kind(results: Sequence[Mapping]) -> dict[str, list[Row]]:
    """Rows of the simulated data sets together, and of the real scenes where there are any."""
    found: dict[str, list[Row]] = {"simulated": []}
    for number, rows in data_sets(results).items():
        found.setdefault("real" if number == "real" else "simulated", []).extend(rows)
    return found


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """Of all displacements of the simulated pairs at the standard kernel; the band with weak contacts dropped as
    printed; and the share of readings whose values all lie within the bounds of the conditions."""
    pairs = by_kind(results)["simulated"]
    in_grid = [fractions(pairs, plotted(pairs, *r, settings["omega"])) for r in readings()]
    printed = plotted(pairs, AS_PRINTED.kernel, AS_PRINTED.drop, "all", settings["omega"])
    found = at_default(settings, pairs)
    found["adjacent_in_band_as_printed"] = _share(*answers(pairs, printed)[1])
    return found | {"readings_in_which_all_is_so": share_of([all_is_so(own) for own in in_grid])}


def readings() -> list[tuple[str, str, str]]:
    """Kernels, treatments of weak contacts and choices of displacements that the thesis leaves open."""
    return list(product((kernel_name(*kernel) for kernel in KERNELS), DROPS, CHOICES))


def all_is_so(values: Mapping[str, float | None]) -> bool:
    """Whether `fractions` of a reading lie within `BOUNDS`."""
    slope, *shares = (values[name] for name in FRACTIONS)
    most, *least = BOUNDS
    above = (share is not None and share >= bound for share, bound in zip(shares, least, strict=True))
    return slope is not None and slope <= most and all(above)


def at_default(settings: Mapping, pairs: Sequence[Row]) -> dict[str, Estimate]:
    """The `FRACTIONS` with their intervals, of all displacements at the standard kernel."""
    plot = plotted(pairs, STANDARD, DROPS[0], "all", settings["omega"])
    up, *others = (_share(*answered) for answered in answers(pairs, plot))
    if up.n and up.value < 0.5:
        ends = None if up.ci95 is None else (1 - up.ci95[1], 1 - up.ci95[0])
        up = Estimate(1 - up.value, 1 - up.median, ends, up.n)
    slope = sideways_of_rise(plot, settings["resamples"])
    return dict(zip(FRACTIONS, (slope, up, *others), strict=True))


def answers(rows: Sequence[Row], plot: Plot) -> tuple[Answers, Answers, Answers, Answers]:
    """Of each share after the slope: *on* upwards, *adjacent* in the band, *on* outside, side by sign of x."""
    on, adjacent = plot.relation == ON, plot.relation == ADJACENT
    return (
        (plot.scene[on], plot.at[on, 1] > 0),
        (plot.scene[adjacent], ~plot.outside_band[adjacent]),
        (plot.scene[on], plot.outside_band[on]),
        sign_answers(rows, plot),
    )


def sign_answers(rows: Sequence[Row], plot: Plot) -> Answers:
    """Of every adjacent pair that stands sideways: its scene, and whether its mean x has the sign of its side."""
    found = []
    for number, row in enumerate(rows):
        side = sideways(row) if row["relation"] == ADJACENT else None
        own = plot.at[plot.row == number, 0]
        if side is not None and len(own):
            found.append((row["scene"], bool((own.mean() > 0) == (side > 0))))
    return np.array([scene for scene, _ in found], dtype=str), np.array([right for _, right in found], dtype=bool)


def sideways(row: Row) -> float | None:
    """How far a's middle is to the right of b's, metres; None where it is further behind or before it."""
    if row["gap"] is None:
        return None
    order = 0 if row["a"] == row["pair"][0] else 1
    behind, right = as_scene(row).features.columns(("behind", "right"))[order]
    return float(right) if abs(right) > abs(behind) else None


def _share(scene: NDArray[np.str_], right: NDArray[np.bool_]) -> Estimate:
    at = np.unique(scene, return_inverse=True)[1]
    return share_over_scenes(np.bincount(at, right), np.bincount(at))


def sideways_of_rise(plot: Plot, resamples: int) -> Estimate:
    """|x| / |y| of the middle of *on*; rows resampled (percentiles)."""
    on = plot.relation == ON
    if not on.any():
        return UNMEASURED
    own = [plot.at[on & (plot.row == owner)] for owner in np.unique(plot.row[on])]
    draws = stream(len(own), "C2.3", "pairs resampled").integers(0, len(own), (resamples, len(own)))
    middles = [np.median(np.concatenate([own[i] for i in draw]), axis=0) for draw in draws]
    low, high = np.quantile([_slope(middle) for middle in middles], [0.025, 0.975])
    value = _slope(plot.middle_of_on)
    return Estimate(value, value, (float(low), float(high)), int(on.sum()))


def _slope(middle: NDArray[np.float64]) -> float:
    return float(abs(middle[0]) / max(abs(middle[1]), 1e-9))


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """The points of the plot and where each relation lies; then the shares for every other reading.

    The points are those of the first `SHOWN` pairs of a kind; shares count all.
    """
    points, grid = [], []
    for kind, pairs in by_kind(results).items():
        plot = plotted(pairs, STANDARD, DROPS[0], "all", settings["omega"])
        middle = np.round(1000 * plot.middle_of_on, 1).tolist()
        for name in CORE_RELATIONS:
            own = plot.relation == name
            if own.any():
                shown = 1000 * plot.at[own & (plot.row < SHOWN)]
                place = {"scenes": kind, "relation": name, "outside_band": float(plot.outside_band[own].mean())}
                points.append(place | {"middle_of_on": middle, "mm": np.round(shown, 1).tolist()})
        for kernel, drop, choice in readings():
            other = plotted(pairs, kernel, drop, choice, settings["omega"])
            row = {"scenes": kind, "reading": {"kernel": kernel, "drop": drop, "choice": choice}}
            grid.append({**row, "displacements": len(other.at), **fractions(pairs, other)})
    return points + grid


def fractions(rows: Sequence[Row], plot: Plot) -> dict[str, float | None]:
    """The `FRACTIONS` that the conditions ask for, without intervals; None where nothing is asked."""
    up, *others = (float(right.mean()) if len(right) else float("nan") for _, right in answers(rows, plot))
    values = dict(zip(FRACTIONS, (_slope(plot.middle_of_on), max(up, 1 - up), *others), strict=True))
    return {name: round(value, 4) if np.isfinite(value) else None for name, value in values.items()}
