"""C3.10: the features that the agents of C3.9 choose after each of thirty tasks.

Thesis: §3.3.3, Alg. 6, §3.4.6, Figure 3.14.
"""

from collections.abc import Iterator, Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from lifelore.core.metrics import Estimate
from lifelore.figures.style import GREY, INK, PAPER, VERMILION, Axes
from reproduction.chapter3.c3_09_online_features.run import DRAWN, grid_of, mask_of, run_cell, shared
from reproduction.chapter3.factory.comparison import is_default
from reproduction.chapter3.factory.modified_tasks import CARDINALS, FEATURES, FULL_SET, features_in_words
from reproduction.chapter3.factory.online_selection import SELECTED
from reproduction.engine.estimates import exact_share
from reproduction.engine.grid import Cell
from reproduction.engine.records import nested, values_of
from reproduction.figures.panels import panels

__all__ = ["readings", "rows", "run_cell", "shared"]

GOAL = mask_of(CARDINALS)


def masks_of(settings: Mapping, results: Sequence[Mapping], cell: Mapping) -> NDArray[np.int64]:
    """Sets chosen after each task in a cell of the grid as bit masks, (n_runs, n_tasks)."""
    where = grid_of(settings).where(SELECTED, cell)
    return values_of(nested(results, "found"), "chosen", **where).astype(np.int64)


def shares(masks: NDArray[np.int64]) -> NDArray[np.float64]:
    """Share of runs in which each feature is chosen, (10, n_tasks), from (n_runs, n_tasks) masks."""
    bits = masks[:, :, None] >> np.arange(len(FULL_SET)) & 1
    return bits.mean(axis=0).T


def numbers(masks: NDArray[np.int64], last: int) -> dict[str, Estimate]:
    """Shares of runs: φ2 after each of the `last` tasks; with its rarest feature; with the commonest other."""
    at_end = dict(zip(FULL_SET.names, shares(masks)[:, -1], strict=True))
    chosen = {name: (masks[:, -1] >> i & 1).tolist() for i, name in enumerate(FULL_SET.names)}
    rarest = min(CARDINALS, key=at_end.__getitem__)
    commonest = max((name for name in FULL_SET.names if name not in CARDINALS), key=at_end.__getitem__)
    return {
        "settled_share": exact_share((masks[:, -last:] == GOAL).all(axis=1).tolist()),
        "rarest_of_four": exact_share(chosen[rarest]),
        "commonest_other": exact_share(chosen[commonest]),
    }


def readings(settings: Mapping, results: Sequence[Mapping]) -> Iterator[tuple[Cell, dict[str, Estimate]]]:
    """How surely φ2 is chosen in every cell; an exact policy depends on no choice but which states count."""
    grid = grid_of(settings)
    for cell in grid.cells:
        if cell["source"].startswith("learnt") or is_default(grid, cell, but=["source"]):
            yield cell, numbers(masks_of(settings, results, cell), settings["last"])


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """The share of runs with each feature after each task at the default."""
    found = shares(masks_of(settings, results[:DRAWN], grid_of(settings).default))
    return [
        {"feature": name, "shares": of_feature.tolist()}
        for name, of_feature in zip(FULL_SET.names, found, strict=True)
    ]


@panels(6.8, 3.4, grid="")
def draw(result: Mapping, axes: Axes) -> None:
    """Figure of claim C3.10: the share of runs in which each feature is chosen, after each task.

    A row for each feature, the four of φ2 above the line; the brighter, the more runs.
    """
    from matplotlib.colors import LinearSegmentedColormap

    found = {row["feature"]: row["shares"] for row in result["rows"]}
    shares = np.array([found[feature] for feature in FEATURES])
    image = axes.imshow(
        shares, cmap=LinearSegmentedColormap.from_list("share", [INK, PAPER]), vmin=0, vmax=1, aspect="auto",
        interpolation="nearest", extent=(0.5, shares.shape[1] + 0.5, len(FEATURES) - 0.5, -0.5),
    )  # fmt: skip
    axes.axhline(3.5, color=VERMILION, linewidth=1.2)
    axes.set_yticks(range(len(FEATURES)), features_in_words(FEATURES))
    axes.tick_params(axis="y", length=0)
    axes.set_xlabel("tasks")
    axes.figure.colorbar(image, ax=axes, pad=0.02, label="share of runs")
    axes.figure.supxlabel(
        f"{min(DRAWN, result['settings']['runs'])} runs. N to SE: cells around the robot's. Above the line: φ2.",
        fontsize=8, color=GREY,
    )  # fmt: skip
