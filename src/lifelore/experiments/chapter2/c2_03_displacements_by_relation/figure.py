"""Displacements between contact points, seen from the front and coloured by relation (thesis Fig 2.4)."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from lifelore.core.errors import InputError
from lifelore.core.relations import ADJACENT, ON
from lifelore.experiments.chapter2.c2_03_displacements_by_relation.measure import EDGE
from lifelore.figures.object_palette import mixed, relation_palette
from lifelore.figures.style import GREY, INK, LIGHT, PAPER, house_style, new_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

CLOSE = 25
"""Millimetres; how far the figure's second view reaches."""


def draw(result: Mapping):
    panels = {}
    for kind in ("simulated", "real"):
        found = [row for row in result["rows"] if row["scenes"] == kind and "mm" in row]
        if found:
            panel = _panel_of(found)
            panels[f"{kind} pairs"] = panel
            panels[f"{kind} pairs, within {CLOSE} mm"] = panel | {"reach": CLOSE}
    return draw_displacement_panels(panels)


def _panel_of(found: Sequence[Mapping]) -> dict:
    at = np.array([place for row in found for place in row["mm"]])
    panel = {"displacements": at, "relations": [row["relation"] for row in found for _ in row["mm"]]}
    right, up = found[0]["middle_of_on"]
    if right is None:
        return panel
    band = (-np.inf, EDGE * up) if up > 0 else (EDGE * up, np.inf)
    return panel | {"centres": {ON: (right, up)}, "bands": {ADJACENT: band}}


_SIGNS = {"on": "o", "adjacent": "s", "both": "^", "none": "x"}


def draw_displacements(
    displacements: ArrayLike,
    relations: Sequence[str],
    *,
    centres: Mapping[str, tuple[float, float]] | None = None,
    bands: Mapping[str, tuple[float, float]] | None = None,
    unit: str = "mm",
    title: str = "",
) -> "Figure":
    """The figure, displacements of a from b.

    Parameters
    ----------
    displacements : (n, 2)
        To the right and up.
    relations : sequence of str
        The label of the pair each belongs to.
    centres : mapping of relation to (right, up), optional
        A cluster's middle, marked by a cross.
    bands : mapping of relation to (low, high), optional
        Heights between which a relation's displacements lie, shaded; either may be infinite.
    unit : str
    title : str

    Raises
    ------
    InputError
        Displacements and relations do not correspond.
    """
    panel = {"displacements": displacements, "relations": relations, "centres": centres, "bands": bands}
    return draw_displacement_panels({title: panel}, unit=unit)


def draw_displacement_panels(panels: Mapping[str, Mapping], *, unit: str = "mm") -> "Figure":
    """As `draw_displacements`, several sets of scenes or views of one, two in a row, each at its own scale.

    Parameters
    ----------
    panels : mapping of title to mapping
        Each ``{"displacements", "relations"}`` and, optional, ``"centres"``, ``"bands"`` and ``"reach"``: how far
        from the origin is shown.
    unit : str

    Raises
    ------
    InputError
        Displacements and relations of a panel do not correspond.
    """
    every_at = [_checked(panel["displacements"], panel["relations"]) for panel in panels.values()]
    with house_style():
        spans = [np.ptp(at, axis=0) if len(at) else np.ones(2) for at in every_at]
        tallest = max(float(np.clip(high / max(wide, 1e-9), 0.35, 1.1)) for wide, high in spans)
        columns = min(2, len(panels))
        n_rows = -(-len(panels) // columns)
        figure = new_figure(
            6.4 if columns == 1 else 10.0, n_rows * (1.3 + (4.6 if columns == 1 else 3.2) * tallest)
        )
        every = figure.subplots(n_rows, columns, squeeze=False).ravel()
        for axes in every[len(panels) :]:
            axes.set_axis_off()
        for axes, at, (title, panel) in zip(every, every_at, panels.items(), strict=False):
            _panel(axes, at, panel)
            axes.set(xlabel=f"to the right of b ({unit})", ylabel=f"above b ({unit})", title=title)
    return figure


def _checked(displacements: ArrayLike, relations: Sequence[str]) -> np.ndarray:
    at = np.asarray(displacements, float)
    if at.shape != (len(relations), 2):
        raise InputError(f"displacements must have shape ({len(relations)}, 2), one a relation, got {at.shape}")
    return at


def _panel(axes: "Axes", at: np.ndarray, panel: Mapping) -> None:
    relations = panel["relations"]
    palette = relation_palette(relations)
    axes.axhline(0, color=LIGHT, lw=1, zorder=0)
    axes.axvline(0, color=LIGHT, lw=1, zorder=0)
    for name in palette:
        if name in set(relations):
            _scatter(axes, at[np.array(relations) == name], name, palette[name])
    if panel.get("reach"):
        axes.set(xlim=(-panel["reach"], panel["reach"]), ylim=(-panel["reach"], panel["reach"]))
    for name, (low, high) in (panel.get("bands") or {}).items():
        _band(axes, low, high, mixed(palette[name], PAPER, 0.85))
    for name, centre in (panel.get("centres") or {}).items():
        _cross(axes, centre, palette.get(name, INK))
    axes.set_aspect("equal", adjustable="box" if panel.get("reach") else "datalim")
    if not panel.get("reach"):
        axes.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0), handletextpad=0.2)


def _band(axes: "Axes", low: float, high: float, colour: str) -> None:
    seen = axes.get_ylim()
    beyond = 10 * (seen[1] - seen[0])
    axes.axhspan(max(low, seen[0] - beyond), min(high, seen[1] + beyond), color=colour, lw=0, zorder=-1)
    # A band without an end reaches beyond the picture and does not widen it.
    axes.set_ylim(
        min(seen[0], low) if np.isfinite(low) else seen[0], max(seen[1], high) if np.isfinite(high) else seen[1]
    )


def _scatter(axes: "Axes", at: np.ndarray, name: str, colour: str) -> None:
    # Many points fade, so that where they are dense stays visible.
    alpha = float(np.clip(12 / np.sqrt(max(1, len(at))), 0.25, 0.85))
    edge = {} if name == "none" else {"edgecolors": mixed(colour, INK, 0.3)}
    axes.scatter(
        *at.T, s=20, marker=_SIGNS.get(name, "D"), color=colour, alpha=alpha, linewidths=0.5,
        label=f"{name.replace('_', ' ')} ({len(at)})", zorder=1 if name == "none" else 2, **edge,
    )  # fmt: skip


def _cross(axes: "Axes", centre: tuple[float, float], colour: str) -> None:
    axes.plot(*centre, "+", ms=17, mew=5, color=PAPER, zorder=4)
    axes.plot(*centre, "+", ms=15, mew=2.2, color=mixed(colour, INK, 0.45), zorder=5)
    right, up = (at + 0.0 for at in centre)  # no minus before a zero
    axes.annotate(
        f"({right:.2g}, {up:.2g})", centre, (9, -3), textcoords="offset points", fontsize=7.5,
        va="top", color=INK, zorder=5,
        bbox={"facecolor": PAPER, "alpha": 0.75, "edgecolor": GREY, "lw": 0.4, "pad": 1.5},
    )  # fmt: skip
