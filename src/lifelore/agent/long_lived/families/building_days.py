"""Ways through a building on days of hidden types, as the long-lived agent meets them.

The map is known; which passages are blocked and where crowds stand is not. Two kinds of causes have effects, which
depend on the type of day:

- entering a cell: it is free, crowded, or refused. Plans use these;
- passing through a region, a square of cells: the worst that was met there. Types are told apart by these.

An act walks the way of a behaviour until a cell is not as the behaviour expects. A day stays as it is in all
episodes of a task, so only new answers are effects, and what was found in this task is certain.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import sparse
from scipy.sparse import csgraph

from lifelore.agent.long_lived.task_family import Abilities, AgentTask, Plan, SharedKnowledge, Step, TaskFamily
from lifelore.domains.buildings import building_days as days
from lifelore.domains.buildings.building_days import BuildingDays, BuildingWay
from lifelore.domains.task_stream import DrawnTask

Array = NDArray[np.float64]

EFFECTS = ("free", "crowded", "refused")
FREE, CROWDED, REFUSED = range(3)
UNKNOWN = -1
REGION = 8
"""Cells a side of a region; smaller regions tell types apart better and take more time."""
SPREAD = 0.25
"""Weight of an effect for a neighbouring cell without effects of its own; more expects larger crowds."""
DETOUR = 20.0
"""Expected cost of going round a refused cell, in points; more avoids doubtful cells by longer ways."""
CLOSED = 1e6
"""Cost of a cell that was refused in this task, in points."""
SURE = (0.98, 0.01, 0.01)
"""Effects of a cell or region of which nothing is known: the map is mostly right."""
MOST_BEHAVIOURS = 257


@dataclass(eq=False)
class BuildingFamily(TaskFamily):
    """Ways through one building.

    Parameters
    ----------
    days : BuildingDays
        Of its types of day nothing is read.
    """

    days: BuildingDays

    name = "building-days"
    acts = tuple(f"walk the best way for type {behaviour}" for behaviour in range(MOST_BEHAVIOURS))
    n_effects = len(EFFECTS)

    def __post_init__(self) -> None:
        world = self.days.world
        self.n_cells = world.n_states
        """Number of cells; the causes of regions follow those of cells."""
        row, column = (world.cells // REGION).T.astype(np.int64)
        self.region_of = np.unique(row * (column.max() + 1) + column, return_inverse=True)[1]
        """(n_cells,) number of each cell's region."""
        n_regions = int(self.region_of.max()) + 1
        self.n_causes = self.n_cells + n_regions
        self.possible = np.tile(SURE, (self.n_causes, 1))
        # The cells of a region are alike, and regions are alike.
        self.groups = np.concatenate([self.region_of, np.full(n_regions, n_regions)])
        self.judges = np.arange(self.n_causes) >= self.n_cells
        self.kinds = self.judges.astype(np.int64)
        start, move = np.nonzero(world.neighbour >= 0)
        end, shape = world.neighbour[start, move], (self.n_cells, self.n_cells)
        self.entries = sparse.csr_matrix((np.ones(len(end)), (end, start)), shape=shape)
        """(n_cells, n_cells) of ones: from a cell to those from which the map lets it be entered."""

    def smoothed(self, counts: Array) -> Array:
        """A cell without effects has those of its neighbours, with less weight: crowds cover several cells."""
        found = counts.copy()
        cells = counts[:, : self.n_cells]
        for own, into in zip(cells, found, strict=True):
            untried = ~own.any(axis=1)
            into[: self.n_cells][untried] = SPREAD * (self.entries[untried] @ own)
        return found

    def meet(self, number: int, abilities: Abilities, context: int | None = None) -> "tuple[DrawnTask, WayTask]":
        """Way `number`, drawn and met; there are no relations to perceive."""
        drawn, way = self.days.task(number, context)
        return drawn, WayTask(self, way)

    def best_return(self, number: int, context: int | None = None) -> float:
        """Points of the best way for who knows the day."""
        return self.days.task(number, context)[1].best_return

    def cause_name(self, cause: int) -> str:
        """A cause in words."""
        if cause < self.n_cells:
            row, column = self.days.world.cells[cause]
            return f"enter the cell in row {row}, column {column}"
        cell = int(np.flatnonzero(self.region_of == cause - self.n_cells)[0])
        row, column = self.days.world.cells[cell] // REGION * REGION
        return f"pass through the region from row {row}, column {column} on"

    def effect_name(self, cause: int, effect: int) -> str:
        """An effect in words."""
        return EFFECTS[effect]


class WayTask(AgentTask):
    """A way as the agent meets it.

    Parameters
    ----------
    family : BuildingFamily
    way : BuildingWay
        Of its day nothing is read.
    """

    def __init__(self, family: BuildingFamily, way: BuildingWay) -> None:
        self.family, self.way = family, way
        self.found = np.full(family.n_cells, UNKNOWN)
        self._worst: dict[int, int] = {}
        self._ways: list[list[int]] = []
        self._expected = np.zeros((0, family.n_cells), np.int64)
        self.begin()

    def begin(self) -> None:
        """Begin an episode at the start."""
        self.cell = self.way.reset().cell

    def describe(self) -> str:
        """Where the robot is, and what it found."""
        crowded, refused = ((self.found == effect).sum() for effect in (CROWDED, REFUSED))
        row, column = self.family.days.world.cells[self.cell]
        return f"in row {row}, column {column}; found {crowded} crowded and {refused} closed cells"

    # ---- acts ---------------------------------------------------------------------------------------

    def act(self, act: int) -> Step:
        """Walk the way of behaviour `act` until a cell is not as it expects."""
        gained, ended, news = 0.0, False, []
        worst: dict[int, int] = {}
        neighbour = self.family.days.world.neighbour
        for target in self._ways[act]:
            move = int(np.flatnonzero(neighbour[self.cell] == target)[0])
            seen, reward, ended = self.way.step(move)
            gained, self.cell = gained + reward, seen.cell
            effect = REFUSED if seen.refused else CROWDED if reward == days.CROWD else FREE
            if self.found[target] == UNKNOWN:
                self.found[target] = effect
                news.append((target, effect))
            region = int(self.family.region_of[target])
            worst[region] = max(worst.get(region, FREE), effect)
            if ended or seen.refused or effect != self._expected[act, target]:
                break
        return Step(gained, (*news, *self._news_of_regions(worst)), ended)

    def _news_of_regions(self, worst: dict[int, int]) -> list[tuple[int, int]]:
        """The regions that were not met before in this task, or turned out worse."""
        news = [(region, effect) for region, effect in worst.items() if effect > self._worst.get(region, -1)]
        self._worst.update(news)
        return [(self.family.n_cells + region, effect) for region, effect in news]

    # ---- plans --------------------------------------------------------------------------------------

    def plan(self, laws: Array, tried: NDArray[np.bool_], new: int | None, shared: SharedKnowledge) -> Plan:
        """The shortest way of each type under its expected costs, and its cost under all."""
        cells = laws[:, : self.family.n_cells]
        cost = cells @ np.array([-days.MOVE, -days.CROWD, DETOUR - days.REFUSED])
        for effect, price in ((FREE, -days.MOVE), (CROWDED, -days.CROWD), (REFUSED, CLOSED)):
            cost[:, self.found == effect] = price
        self._expected = np.where(self.found == UNKNOWN, cells.argmax(axis=2), self.found)
        self._ways = [self._shortest_way(own) for own in cost]
        values = np.array([-cost[:, way].sum(axis=1) for way in self._ways]).T
        acts = np.arange(len(laws))
        return Plan(values, acts, acts)

    def _shortest_way(self, cost: Array) -> list[int]:
        """Cells of the cheapest way to the destination, without the first; `cost` (n_cells,) of entering each."""
        entries = self.family.entries
        graph = sparse.csr_matrix(
            (np.repeat(cost, np.diff(entries.indptr)), entries.indices, entries.indptr), shape=entries.shape
        )
        _, following = csgraph.dijkstra(graph, indices=self.way.destination, return_predecessors=True)
        cell, way = self.cell, []
        while cell != self.way.destination:
            cell = int(following[cell])
            way.append(cell)
        return way
