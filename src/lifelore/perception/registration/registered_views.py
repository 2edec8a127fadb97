"""Registration of several views of one tabletop, each to the placed view that it fits best."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lifelore.core.errors import InputError
from lifelore.perception.registration.registered_pair import Registration, registered_pair
from lifelore.perception.registration.tabletop_view import TabletopView


@dataclass(frozen=True, eq=False)
class PlacedView:
    """A view's place.

    Parameters
    ----------
    pose : (4, 4) float64
        From the view's frame to the first view's.
    to : int, optional
        Number of the view that it was registered to; None for the first.
    agreement : float, optional
        Share of the cells with objects that both views show alike, see `agreement`; None for the first.
    """

    pose: NDArray[np.float64]
    to: int | None = None
    agreement: float | None = None


def registered_views(views: Sequence[TabletopView], names: Sequence[str]) -> list[PlacedView]:
    """The places of all views in the frame of the first.

    Parameters
    ----------
    views : sequence of TabletopView
        At least one.
    names : sequence of str
        Names of the views for the error.

    Raises
    ------
    InputError
        A view fits none of the others surely.
    """
    placed = {0: PlacedView(np.eye(4))}
    tried: dict[tuple[int, int], Registration | None] = {}
    while len(placed) < len(views):
        for number in set(range(len(views))) - set(placed):
            for to in placed:
                if (to, number) not in tried:
                    tried[to, number] = registered_pair(views[to], views[number])
        sure = [
            (pair, found)
            for pair, found in sorted(tried.items())
            if pair[1] not in placed and found is not None and found.doubt is None
        ]
        if not sure:
            raise _unsure({pair: found for pair, found in tried.items() if pair[1] not in placed}, names)
        (to, number), best = max(sure, key=lambda entry: entry[1].agreement.evidence)
        placed[number] = PlacedView(placed[to].pose @ best.motion, to, best.agreement.share)
    return [placed[number] for number in range(len(views))]


def _unsure(tried: dict[tuple[int, int], Registration | None], names: Sequence[str]) -> InputError:
    """The error that names the view that comes nearest to a place, and why it has none."""
    (to, number), found = max(
        sorted(tried.items()),
        key=lambda entry: -np.inf if entry[1] is None else entry[1].agreement.evidence,
    )
    doubt = "they show nothing in common" if found is None else found.doubt
    return InputError(
        f"the views {names[to]} and {names[number]} cannot be registered surely: {doubt}; give poses"
        " (--poses FILE), or views that show more of the same objects"
    )
