"""An action prior as a table for any features: a row for each context, the probability of each action."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from lifelore.action.priors.action_prior import ActionPrior
from lifelore.core.errors import InputError
from lifelore.figures.style import BLUE, INK, PAPER, VERMILION, house_style, new_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

LONGEST_LABEL = 40
"""Characters of a label; longer labels are cut, so that the table stays readable."""


def plot_prior(
    prior: ActionPrior,
    *,
    labels: Mapping[int, Any] | None = None,
    actions: Sequence[str] | None = None,
    most: int = 25,
    title: str = "",
) -> "Figure":
    """A picture of a prior over any features; save it with ``.savefig("prior.png")``.

    A row is a context, with its counts. A cell is the probability of an action: blue where it exceeds that of the
    uniform distribution, vermilion below.

    Parameters
    ----------
    prior : ActionPrior
    labels : mapping, optional
        Context code to a readable label; default: the prior's own labels, and the code where it has none.
    actions : sequence of str, optional
        Names of the actions, in order; default: their numbers.
    most : int
        Number of contexts drawn, those with the most counts first; ≥ 1.
    title : str
        Default: how many contexts the prior has and how many are drawn.

    Raises
    ------
    InputError
        The prior has no counts, `actions` has another length than the prior's actions, or `most` is below 1.

    Examples
    --------
    >>> from lifelore import ActionPrior
    >>> prior = ActionPrior(2)
    >>> prior.update([7, 9], [[True, False], [True, True]])
    >>> figure = plot_prior(prior, actions=["left", "right"])
    """
    names = [str(action) for action in (range(prior.n_actions) if actions is None else actions)]
    if len(names) != prior.n_actions:
        raise InputError(f"actions must name {prior.n_actions} actions, got {len(names)} names")
    if most < 1:
        raise InputError(f"most must be at least 1, got {most}")
    if not len(prior):
        raise InputError("prior must have counts to be drawn, got an empty prior; live through tasks first")
    named = prior.labels if labels is None else labels
    counted = prior.counts(prior.contexts).sum(axis=1)
    order = np.argsort(-counted, kind="stable")[:most]
    codes, counted = prior.contexts[order], counted[order]
    rows = [_row_name(code, n, named) for code, n in zip(codes.tolist(), counted.tolist(), strict=True)]
    with house_style():
        figure = new_figure(2.6 + 0.07 * max(map(len, rows)) + 0.55 * len(names), 1.0 + 0.24 * len(rows))
        axes = figure.subplots()
        _draw_table(axes, prior.probs(codes), rows, names)
        axes.set_title(
            title or f"Action prior: {len(codes)} of {len(prior)} contexts, most counts first", loc="left"
        )
        axes.set_xlabel("action")
    return figure


def _draw_table(axes: "Axes", probs: NDArray[np.float64], rows: Sequence[str], columns: Sequence[str]) -> None:
    from matplotlib.colors import LinearSegmentedColormap

    uniform = 1 / len(columns)
    scaled = np.clip((probs - uniform) / max(1 - uniform, 1e-9), -1, 1)
    colours = LinearSegmentedColormap.from_list("about", [VERMILION, PAPER, BLUE])
    axes.imshow(scaled, cmap=colours, vmin=-1, vmax=1, aspect="auto")
    for (row, column), value in np.ndenumerate(probs):
        ink = PAPER if abs(scaled[row, column]) > 0.75 else INK
        axes.text(column, row, f"{value:.2f}", ha="center", va="center", fontsize=7.5, color=ink)
    axes.set_xticks(range(len(columns)), columns)
    axes.set_yticks(range(len(rows)), rows)
    axes.set_xticks(np.arange(len(columns) + 1) - 0.5, minor=True)
    axes.set_yticks(np.arange(len(rows) + 1) - 0.5, minor=True)
    axes.grid(which="minor", color=PAPER, linewidth=1.5)
    axes.tick_params(which="both", length=0)
    for spine in axes.spines.values():
        spine.set_visible(False)


def _row_name(code: int, counts: float, labels: Mapping[int, Any]) -> str:
    label = str(labels.get(code, code))
    if len(label) > LONGEST_LABEL:
        label = label[: LONGEST_LABEL - 1] + "…"
    return f"{label}   n = {counts:g}"
