"""`bench destinations`: how soon is a recurring goal found in a known building?

`TASKS` tasks in each generated office of a round. Goals are drawn from `PLACES` hidden destinations, all alike or
by Zipf's law, and starts from all places; the map is known. Every method finds the goals before it in the same
tasks. Steps are those until the goal is entered, the means are over the last half of the tasks, and intervals
resample offices. The last method knows all destinations and how often each is the goal: no order is better. The
one before it knows this of the destinations where a goal was found, and how often it is elsewhere: no learner is
better.
"""

from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy import sparse
from scipy.sparse import csgraph

from benchmarks.rounds import at_most, estimated_row
from lifelore.agent.live.goals.goal_counts import GoalCounts
from lifelore.agent.live.transitions import BuildingGrid, frame_key
from lifelore.core.learning.known_world import NOT_LOOKED, WorldModel
from lifelore.core.learning.tour_search import LENGTH, KnownTour
from lifelore.core.metrics import mean_estimate, ratio_estimate
from lifelore.core.planning.destination_order import by_exact_search, by_nearness, by_rate
from lifelore.core.planning.near_distances import known_neighbours
from lifelore.core.planning.search_order import arrival_times
from lifelore.core.protocols import Progress
from lifelore.core.streams import stream
from lifelore.domains.grids.grid_world import GridWorld
from lifelore.domains.worlds import make_world

PLACES, TASKS = 10, 60
LAWS = {"uniform": 0.0, "Zipf": 1.0}
"""Exponent of the probabilities of the destinations by rank."""
NEVER = 1e9
"""Steps of a tour that no search prefers."""
NOTHING, NEAREST, REUSE, EXACT, TOLD, BEST = (
    "tour of all places",
    "tour of the remembered destinations",
    "policy reuse by probability a step",
    "policy reuse in the exact order",
    "exact search, frequencies known",
    "exact search, all known",
)
RULES = {NEAREST: by_nearness, REUSE: by_rate, EXACT: by_exact_search}
OUT = Path("benchmarks/results")
METHODS = (NOTHING, *RULES, TOLD, BEST)
MOST_RATIO = 1.25
"""Most steps of policy reuse in the exact order, as ratio to the exact search that knows all."""


def bench_destinations(repeats: int, progress: Progress, out: Path = OUT) -> dict:
    """Rows and goals; see `benchmarks.bench`. The figure is written with three repeats or more."""
    rows, goals = [], []
    for number, (law, exponent) in enumerate(LAWS.items()):
        found: dict[str, list[float]] = {name: [] for name in METHODS}
        for seed in range(repeats):
            for name, steps in _office(seed, law, exponent).items():
                found[name].append(float(np.mean(steps[TASKS // 2 :])))
            progress(number * repeats + seed + 1, len(LAWS) * repeats, f"{law}, office {seed}")
        rows += _rows(law, found)
        for other, most in ((BEST, MOST_RATIO), (TOLD, MOST_RATIO), (NEAREST, 1.0)):
            name, ratio = f"{EXACT} / {other}, {law}", ratio_estimate(found[EXACT], found[other])
            rows.append(estimated_row(name, ratio, ""))
            goals.append(at_most(name, most, ratio.value))
    if repeats >= 3:
        _draw(rows, out)
    return {"rows": rows, "goals": goals}


def _draw(rows: list[dict], out: Path) -> None:
    from benchmarks.lives.figure_destinations import draw_destinations
    from lifelore.figures.style import save_figure

    out.mkdir(parents=True, exist_ok=True)
    save_figure(draw_destinations(METHODS, tuple(LAWS), rows), out / "bench_destinations.png")


def _rows(law: str, found: dict[str, list[float]]) -> list[dict]:
    rows = []
    for name, steps in found.items():
        ratio = None if name == BEST else ratio_estimate(steps, found[BEST])
        rows.append(estimated_row(f"{name}, {law}", mean_estimate(steps), "steps", f"{BEST}, {law}", ratio))
    return rows


def _office(seed: int, law: str, exponent: float) -> dict[str, NDArray[np.float64]]:
    """Steps of each method in each task of one office."""
    world = make_world("building", seed=seed)
    stays = np.arange(world.n_states)[:, None]
    target = np.where(world.neighbour < 0, stays, world.neighbour).astype(np.int32)
    known = KnownTour.of(WorldModel(target, world.percepts), world.cells)
    steps = csgraph.shortest_path(sparse.csr_array(known_neighbours(target)), unweighted=True)
    random = stream(seed, "bench destinations", law)
    places = random.choice(world.n_states, PLACES, replace=False)
    chance = np.arange(1.0, PLACES + 1) ** -exponent
    chance /= chance.sum()
    goals = places[random.choice(PLACES, TASKS, p=chance)]
    starts = random.integers(0, world.n_states, TASKS)
    results = {}
    for name in (NOTHING, *RULES):
        counts = _counts(world)
        results[name] = np.empty(TASKS)
        for task, (start, goal) in enumerate(zip(starts.tolist(), goals.tolist(), strict=True)):
            remembered, likely, new = counts.belief()
            if name == NOTHING:
                tried = remembered[:0]
            else:
                tried = remembered[RULES[name](_between(steps, remembered, start), likely, new, _tour(known))]
            results[name][task] = _time(known, steps, tried, start, goal)
            counts.found(goal)
    results[TOLD], results[BEST] = np.empty(TASKS), np.empty(TASKS)
    for task, (start, goal) in enumerate(zip(starts.tolist(), goals.tolist(), strict=True)):
        met = np.isin(places, goals[:task])
        for name, has, tour in ((TOLD, met, _tour(known)), (BEST, np.ones(PLACES, bool), NEVER)):
            order = by_exact_search(
                _between(steps, places[has], start), chance[has], float(chance[~has].sum()), tour
            )
            results[name][task] = _time(known, steps, places[has][order], start, goal)
    return results


def _counts(world: GridWorld) -> GoalCounts:
    return GoalCounts(world, BuildingGrid(frame_key(world)), np.zeros(world.n_states, np.int64))


def _tour(known: KnownTour) -> float:
    return LENGTH * len(known.tour)


def _between(steps: NDArray[np.float64], places: NDArray[np.int64], start: int) -> NDArray[np.float64]:
    return steps[np.r_[places, start]][:, places]


def _time(known: KnownTour, steps: NDArray[np.float64], tried: NDArray[np.int64], start: int, goal: int) -> float:
    """Steps until the goal is found: in a place that is tried, or on the tour after them."""
    way = np.r_[start, tried].astype(np.int64)
    times = np.r_[0.0, np.cumsum(steps[way[:-1], way[1:]])]
    if goal in way:
        return float(times[way.tolist().index(goal)])
    place = np.full(len(steps), NOT_LOOKED, np.int8)
    place[way] = NOT_LOOKED + 1
    order = np.r_[way[-1], known.order(place, int(way[-1]))].astype(np.int32)
    return float(times[-1] + arrival_times(order, known.near)[order.tolist().index(goal)])
