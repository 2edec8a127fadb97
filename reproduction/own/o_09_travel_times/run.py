"""O9: seconds of moves and of ways in simulated buildings, predicted before each drive from the drives before it.

A robot drives between twelve places of an office that has rush hours, drift, blocked places and doors, by shortest
ways; where a move is refused it tries another way. Days before `learn_days` are not judged. Judged are moves
that were driven before, so that *last time* and *mean* have an answer. The seeds of the offices chose nothing.
"""

from collections.abc import Iterator, Mapping, Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csgraph

from lifelore.agent.travel import Travel
from lifelore.core.metrics import Estimate, mean_estimate, ratio_estimate
from lifelore.core.streams import stream
from lifelore.domains.buildings.busy_building import DAY, HOUR, MONDAY, BusyBuilding, Drive
from lifelore.domains.buildings.busy_places import move_graph, without
from lifelore.domains.grids.cell_numbers import BuildingGrid
from lifelore.domains.grids.grid_world import GridWorld
from lifelore.domains.worlds import make_world

METHODS = ("travel", "last", "mean", "truth")
"""Predictors, in the order of stored errors; *truth* knows the building and not the noise."""
MOST_REFUSALS = 10
"""Refusals after which a job is given up."""
BINS = np.array([0.0, 0.02, 0.05, 0.1, 0.2, 0.4, 0.6, 0.8, 1.0])
"""Ends of the bins of predicted probabilities of a refusal."""
LIKELY = 4
"""The first bin of moves that are likely to be refused: from 0.2 on."""


def cells(settings: Mapping) -> list[dict]:
    """A life in a building each."""
    return [{"life": number} for number in range(settings["lives"])]


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """Mean absolute errors by method in a life, of moves and ways; refusals by bin of their probability."""
    number = settings["first_seed"] + settings["lives"] * seed + cell["life"]
    building = BusyBuilding(make_world("building", seed=number), number)
    travel = Travel(building.world, BuildingGrid("simulated"))
    seen = Baselines(building.world.neighbour.size)
    moves, logs, ways, bins, squares = [], [], [], np.zeros((len(BINS) - 1, 3)), []
    for drive, clock in _drives(building, settings, number):
        move = drive.states * 4 + drive.actions
        if clock >= MONDAY + settings["learn_days"] * DAY:
            entered = building.world.neighbour.ravel()[move]
            by_method = np.array(
                [travel.seconds(clock).ravel()[move], *seen.expected(move), building.seconds(clock)[entered]]
            )
            passed = ~np.isnan(drive.seconds)
            known = passed & (seen.count[move] > 0)
            moves.append(abs(by_method - drive.seconds)[:, known])
            logs.append(abs(np.log(by_method / drive.seconds))[:, known])
            ways.append(abs((by_method - drive.seconds)[:, passed].sum(axis=1)))
            blocked = travel.blocked(clock).ravel()[move]
            bins += _by_bin(blocked, ~passed)
            squares.append((blocked - ~passed) ** 2)
        travel.observe(drive.states, drive.actions, drive.clock, drive.seconds)
        seen.observe(move, drive.seconds)
    return {
        **cell,
        "seconds": np.concatenate(moves, axis=1).mean(axis=1).tolist(),
        "logarithms": np.concatenate(logs, axis=1).mean(axis=1).tolist(),
        "ways": np.mean(ways, axis=0).tolist(),
        "bins": bins.tolist(),
        "squared": float(np.concatenate(squares).mean()),
    }


class Baselines:
    """The last and the mean time of each of `n` moves; the mean of all passes where a move was never driven."""

    def __init__(self, n: int) -> None:
        self.count, self.sum, self.last = np.zeros(n), np.zeros(n), np.zeros(n)

    def expected(self, move: NDArray[np.int64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Seconds of each `move` by the last time, and by the mean."""
        known, every = self.count[move] > 0, self.sum.sum() / max(self.count.sum(), 1)
        mean = self.sum[move] / np.maximum(self.count[move], 1)
        return np.where(known, self.last[move], every), np.where(known, mean, every)

    def observe(self, move: NDArray[np.int64], seconds: NDArray[np.float64]) -> None:
        """Take in a drive."""
        passed = ~np.isnan(seconds)
        np.add.at(self.count, move[passed], 1)
        np.add.at(self.sum, move[passed], seconds[passed])
        self.last[move[passed]] = seconds[passed]


def _drives(building: BusyBuilding, settings: Mapping, number: int) -> Iterator[tuple[Drive, float]]:
    """All drives of a life, each with its start."""
    rng = stream(number, "jobs of a courier")
    places = rng.choice(np.flatnonzero(building.never_blocked), settings["places"], replace=False)
    at, free, (first, last) = int(places[0]), MONDAY, settings["hours"]
    for day in range(settings["days"]):
        for hour in np.sort(rng.uniform(first, last, settings["jobs_a_day"])):
            clock = max(MONDAY + day * DAY + hour * HOUR, free)
            goal = int(rng.choice(places[places != at]))
            opened = np.ones(building.world.n_states, np.bool_)
            for _ in range(MOST_REFUSALS):
                way = _shortest_way(building.world, opened, at, goal)
                if way is None:
                    break
                drive = building.drive(way, clock, rng)
                yield drive, clock
                clock = free = drive.end
                if not np.isnan(drive.seconds[-1]):
                    at = goal
                    break
                at = int(drive.states[-1])
                opened[building.world.neighbour[at, drive.actions[-1]]] = False


def _shortest_way(world: GridWorld, opened: NDArray[np.bool_], start: int, goal: int) -> NDArray[np.int64] | None:
    """States of a shortest way through open cells; None if there is none or the robot is there."""
    graph = move_graph(without(world.neighbour, opened))
    before = csgraph.shortest_path(graph, indices=start, unweighted=True, return_predecessors=True)[1]
    way = [goal]
    while before[way[-1]] >= 0:
        way.append(int(before[way[-1]]))
    return np.array(way[::-1]) if way[-1] == start and len(way) > 1 else None


def _by_bin(probability: NDArray[np.float64], refused: NDArray[np.bool_]) -> NDArray[np.float64]:
    """Number of moves, sum of probabilities and number of refusals of each bin: (bins, 3)."""
    place = np.clip(np.searchsorted(BINS, probability, side="right") - 1, 0, len(BINS) - 2)
    columns = (np.ones(len(place)), probability, refused)
    sums = [np.bincount(place, column, minlength=len(BINS) - 1) for column in columns]
    return np.column_stack(sums).astype(np.float64)


def readings(settings: Mapping, results: Sequence[Mapping]) -> Iterator[tuple[dict, dict[str, Estimate]]]:
    """The same for errors in seconds and in their logarithms."""
    for scale in ("seconds", "logarithms"):
        yield {"errors in": scale}, _numbers(results, scale)


def _numbers(results: Sequence[Mapping], scale: str) -> dict[str, Estimate]:
    moves, ways = (np.array([result[key] for result in results]) for key in (scale, "ways"))
    bins = np.array([result["bins"] for result in results])
    n, refused = bins[:, :, 0].sum(axis=1), bins[:, :, 2].sum(axis=1)
    likely = bins[:, LIKELY:].sum(axis=1)
    share = refused / n
    return {
        "moves_to_better": ratio_estimate(moves[:, 0], moves[:, 1:3].min(axis=1)),
        "truth_to_better": ratio_estimate(moves[:, 3], moves[:, 1:3].min(axis=1)),
        "ways_to_better": ratio_estimate(ways[:, 0], ways[:, 1:3].min(axis=1)),
        "squared_to_share": ratio_estimate([result["squared"] for result in results], share * (1 - share)),
        "likely_refused": ratio_estimate(likely[:, 2], np.maximum(likely[:, 0], 1)),
        "likely_predicted": ratio_estimate(likely[:, 1], np.maximum(likely[:, 0], 1)),
        "likely_gap": mean_estimate((likely[:, 1] - likely[:, 2]) / np.maximum(likely[:, 0], 1)),
    }
