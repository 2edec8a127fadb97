"""The order in which to try places that may hold the goal, each with its own probability.

With probability `elsewhere` the goal is in none of them, and a tour of all places takes `tour` steps to pass
every place. Each rule returns the places to try before that tour, in order:

* `by_rate`: the place with the largest probability a step, as long as that is more than the tour's
  own; a place where the goal was not found has probability 0 from then on (Bayes' rule).
* `by_exact_search`: the least expected time, by dynamic programming over sets of places.
"""

import numpy as np
from numpy.typing import NDArray

from lifelore.core.compiled.jit import kernel
from lifelore.core.errors import InputError

MOST_EXACT = 12
"""Largest number of places of `by_exact_search`; each more doubles its time and main memory."""

Array = NDArray[np.float64]


def by_rate(steps: Array, chance: Array, elsewhere: float, tour: float) -> list[int]:
    """Places in order of probability a step.

    Parameters
    ----------
    steps : (n + 1, n) float
        Steps to each place from each other one; the last row is from the start. Infinite where no way is known.
    chance : (n,) float
        Probability that the goal is in each place.
    elsewhere : float
        Probability that it is in none.
    tour : float
        Steps of a tour of all places, > 0.
    """
    order: list[int] = []
    here, left = len(chance), np.ones(len(chance), bool)
    while left.any():
        rate = np.where(left, chance / np.maximum(steps[here], 1.0), -1.0)
        here = int(rate.argmax())
        if rate[here] <= elsewhere / tour:
            break
        order.append(here)
        left[here] = False
    return order


def by_exact_search(steps: Array, chance: Array, elsewhere: float, tour: float) -> list[int]:
    """The places and order of least expected time; parameters as in `by_rate`.

    The goal in a place that was tried is found on arrival, any other one halfway through the tour that follows.

    Raises
    ------
    InputError
        There are more than `MOST_EXACT` places.
    """
    n = len(chance)
    if n > MOST_EXACT:
        raise InputError(f"chance must have at most {MOST_EXACT} places for an exact search, got {n}; use by_rate")
    if n == 0:
        return []
    following = np.full((1 << n, n + 1), -1)
    _least_time(np.ascontiguousarray(steps, float), np.asarray(chance, float), elsewhere, tour / 2, following)
    order, tried, here = [], 0, n
    while (place := int(following[tried, here])) >= 0:
        order.append(place)
        tried, here = tried | 1 << place, place
    return order


@kernel
def _least_time(steps, chance, elsewhere, rest, following):
    """Fill `following` with the best next place for each set of places tried and each last one; -1: the tour."""
    n = chance.size
    least = np.empty((1 << n, n + 1))
    for tried in range((1 << n) - 1, -1, -1):
        left = elsewhere
        for place in range(n):
            if not tried >> place & 1:
                left += chance[place]
        for here in range(n + 1):
            # Every step until the next event is paid by what may still be unfound.
            least[tried, here] = left * rest
            for place in range(n):
                if not tried >> place & 1 and steps[here, place] < np.inf:
                    time = left * steps[here, place] + least[tried | 1 << place, place]
                    if time < least[tried, here]:
                        least[tried, here] = time
                        following[tried, here] = place
