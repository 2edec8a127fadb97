"""Search for the goal along a tour: a learner that remembers a world visits its known places in a planned order.

The goal may be in any place not yet visited in the task, so the learner wants the order with the least mean time
of arrival: at the start of each episode it takes the rest of a short closed tour and improves it from where it
stands. On the way, it still tries a move that was never made, or enters a place that it did not know before the
task, where that is no farther than the tour's next place.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy import sparse
from scipy.sparse import csgraph

from lifelore.core.compiled.random_state import uniform_integer
from lifelore.core.learning.curve import EPISODE, GOALS, STEP
from lifelore.core.learning.known_world import NOT_LOOKED, WorldModel
from lifelore.core.learning.model_learning import ModelLearner, explore
from lifelore.core.planning.closed_tour import closed_tour, nearest_walk
from lifelore.core.planning.near_distances import NearDistances, known_neighbours, near_distances
from lifelore.core.planning.search_order import search_order

LENGTH = 1.1
"""Steps a place of a closed tour, as measured on maps of offices."""
LEAST_PLACES = 8
"""Number of known places below which no tour is planned."""

Choose = Callable[[NDArray[np.float64], NDArray[np.int64], float], NDArray[np.int64]]
"""Orders destinations: takes the steps between them (the last row from the start), their states, and the steps of
the tour; returns those to try before the tour."""


@dataclass(frozen=True)
class KnownTour:
    """A closed tour of the places that a model knows.

    begin, ends : (n_states + 1,) and (n_moves,) int32, the known moves in both directions: those of state s lead
        to ``ends[begin[s]:begin[s + 1]]``
    near : NearDistances
    tour : (n,) int32, the places of the largest region that known moves join
    destinations : (n,) int64, places that are more likely than others to hold the goal
    choose : orders those that are tried before the tour
    """

    begin: NDArray[np.int32]
    ends: NDArray[np.int32]
    near: NearDistances
    tour: NDArray[np.int32]
    destinations: NDArray[np.int64]
    choose: Choose | None = None

    @classmethod
    def of(cls, model: WorldModel, cells: NDArray[np.integer], before: "KnownTour | None" = None) -> "KnownTour":
        """The tour of a model; `before` if it knows the same moves.

        Parameters
        ----------
        model : WorldModel
        cells : (n_states, 2) int
            Row and column of each state in its grid.
        before : KnownTour, optional
        """
        graph = known_neighbours(model.target)
        begin, ends = graph.indptr.astype(np.int32), graph.indices.astype(np.int32)
        if before is not None and np.array_equal(begin, before.begin) and np.array_equal(ends, before.ends):
            return before
        n = len(cells)
        _, region = csgraph.connected_components(graph, directed=False)
        start = int(np.argmax(region == np.bincount(region).argmax()))
        near = near_distances(graph, cells)
        walk = nearest_walk(start, begin, ends, np.zeros(n, np.bool_), n)
        return cls(begin, ends, near, closed_tour(near, walk), np.empty(0, np.int64))

    def with_destinations(self, destinations: NDArray[np.int64], choose: Choose) -> "KnownTour":
        """The same tour with places to try before it."""
        return replace(self, destinations=destinations, choose=choose)

    def order(self, place: NDArray[np.int8], start: int) -> NDArray[np.int32]:
        """The places not yet visited in the order of visits from `start`; none out of the tour's reach."""
        wanted = np.zeros(len(place), np.bool_)
        wanted[self.tour] = place[self.tour] == NOT_LOOKED
        wanted[start] = False
        tried = self._tried(wanted, start)
        if len(tried):
            wanted[tried], start = False, int(tried[-1])
        nearest = self._nearest(wanted, start) if len(self.tour) >= LEAST_PLACES else -1
        if nearest < 0:
            return tried
        return np.r_[tried, search_order(self.near, self.tour, wanted, start, nearest)]

    def _tried(self, wanted: NDArray[np.bool_], start: int) -> NDArray[np.int32]:
        """The destinations to try before the tour."""
        places = self.destinations[wanted[self.destinations]]
        if self.choose is None or not len(places):
            return np.empty(0, np.int32)
        moves = np.ones(len(self.ends)), self.ends, self.begin
        graph = sparse.csr_array(moves, shape=(len(wanted),) * 2)
        steps = csgraph.dijkstra(graph, indices=np.r_[places, start], unweighted=True)[:, places]
        return self.choose(steps, places, LENGTH * len(self.tour)).astype(np.int32)

    def _nearest(self, wanted: NDArray[np.bool_], start: int) -> int:
        """The wanted state nearest to `start`, -1 if none is reached."""
        # A walk of one step to the nearest place not visited.
        walk = nearest_walk(start, self.begin, self.ends, ~wanted, 2)
        return int(walk[1]) if len(walk) > 1 else -1


def explore_on_tour(
    tables,
    model,
    state_info,
    strategy,
    learner: ModelLearner,
    known: KnownTour,
    curve,
    max_steps,
    discount,
    budget,
) -> int:
    """Run at most `budget` steps as `explore` does, with the order of visits planned anew in each episode."""
    done = 0
    while done < budget and learner.cursor[EPISODE] < curve.returns.size:
        step = int(learner.cursor[STEP])
        if step == 0 and not learner.cursor[GOALS]:
            # The state in which `explore` is about to start the episode.
            start = int(tables.starts[uniform_integer(learner.world_random.copy(), tables.starts.size)])
            set_tour(learner, known.order(learner.place, start))
        steps = min(budget - done, max_steps - step)
        done += explore(tables, model, state_info, strategy, learner, curve, max_steps, discount, steps)
    return done


def set_tour(learner: ModelLearner, order: NDArray[np.int32]) -> None:
    """Make a learner visit places in this order."""
    learner.tour[: len(order)] = order
    learner.later[:] = False
    learner.later[order] = True
    learner.tour_at[:] = 0, len(order)
