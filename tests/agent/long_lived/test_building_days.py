"""Days in a building as the long-lived agent meets them: ways, answers, and a life."""

from itertools import pairwise

import networkx as nx
import numpy as np
import pytest

from lifelore.agent.long_lived.families.building_days import (
    CROWDED,
    DETOUR,
    FREE,
    REFUSED,
    SPREAD,
    BuildingFamily,
    WayTask,
)
from lifelore.agent.long_lived.knowledge import Knowledge
from lifelore.agent.long_lived.known_types import KnownTypes, effect_counts
from lifelore.agent.long_lived.long_life import live_long
from lifelore.agent.long_lived.task_family import AGENTS
from lifelore.domains.buildings import building_days as world
from lifelore.domains.buildings.building import building_from_map
from lifelore.domains.buildings.building_days import DAYS, BuildingDays, BuildingWay, Day
from lifelore.domains.buildings.office import office_map
from lifelore.domains.grids.grid_world import GridWorld
from lifelore.domains.task_stream import TaskStream

FULL = AGENTS["full"]


def ring():
    """Eight cells around a pillar, numbered row by row: 0 1 2 / 3 4 / 5 6 7."""
    free = np.ones((3, 3), bool)
    free[1, 1] = False
    return GridWorld.from_free("ring", free)


RING = BuildingFamily(BuildingDays(ring(), TaskStream(("quiet",))))
OFFICE = building_from_map(office_map(0, 20, 14))


def way(blocked=(), crowded=(), start=0, destination=2):
    grid = ring()
    neighbour = grid.neighbour.copy()
    closed = np.isin(np.arange(8), list(blocked))
    neighbour[closed] = -1
    neighbour[np.isin(neighbour, list(blocked))] = -1
    return BuildingWay(grid, Day(neighbour, np.isin(np.arange(8), list(crowded)), ~closed), start, destination)


def laws_of(family, *effects):
    """Laws under which the named cells surely have an effect and all others are free."""
    laws = np.zeros((len(effects), family.n_causes, 3))
    laws[:, :, FREE] = 1
    for law, cells in zip(laws, effects, strict=True):
        for cell, effect in cells.items():
            law[cell] = np.eye(3)[effect]
    return laws


def plan(task, laws):
    return task.plan(laws, np.ones(laws.shape[1], bool), None, Knowledge.empty(task.family).shared)


def test_values_by_hand():
    task = WayTask(RING, way())
    found = plan(task, laws_of(RING, {}, {1: CROWDED}, {1: REFUSED}))
    # Behaviour 0 goes through cell 1; the others go round by six moves.
    assert found.values.tolist() == [[-2, -6, -6], [-7, -6, -6], [-3 - DETOUR, -6, -6]]
    assert found.acts.tolist() == [0, 1, 2]


def test_a_way_is_walked_until_a_cell_is_not_as_expected():
    task = WayTask(RING, way(blocked=(1,), crowded=(6,)))
    laws = laws_of(RING, {}, {1: REFUSED, 6: CROWDED})
    plan(task, laws)
    first = task.act(0)
    assert (first.reward, first.ended) == (world.REFUSED, False)
    assert first.effects == ((1, REFUSED), (RING.n_cells, REFUSED))
    # Cell 1 is closed for behaviour 0 too, which meets the crowd unprepared; behaviour 1 expects it.
    assert plan(task, laws).values.tolist() == [[-6, -6], [-11, -11]]
    second = task.act(0)
    assert (second.reward, second.ended) == (2 * world.MOVE + world.CROWD, False)
    assert second.effects == ((3, FREE), (5, FREE), (6, CROWDED))
    plan(task, laws)
    assert task.act(1).ended
    # The next episode knows the day: nothing is news.
    task.begin()
    assert plan(task, laws).values[0].tolist() == [-11, -11]
    assert task.act(0) == type(first)(-11.0, (), True)


def test_shortest_ways_under_doubtful_laws_by_another_library():
    family = BuildingFamily(BuildingDays(OFFICE, TaskStream(tuple(DAYS))))
    laws = np.random.default_rng(0).dirichlet((8, 1, 0.3), size=(2, family.n_causes))
    cost = laws[:, : family.n_cells] @ np.array([1.0, 6.0, 2.0 + DETOUR])
    for number in range(5):
        _, task = family.meet(number, FULL)
        values = plan(task, laws).values
        for type_ in range(2):
            graph = nx.DiGraph()
            for cell, targets in enumerate(OFFICE.neighbour.tolist()):
                graph.add_weighted_edges_from((cell, t, cost[type_, t]) for t in targets if t >= 0)
            best = nx.dijkstra_path_length(graph, task.way.start, task.way.destination)
            assert values[type_, type_] == pytest.approx(-best)
            assert (values[type_] <= -best + 1e-9).all()


def test_who_knows_the_day_gets_the_best_return():
    family = BuildingFamily(BuildingDays(OFFICE, TaskStream(("works", "meeting"), loyalty=0.0)))
    for number in range(6):
        drawn, task = family.meet(number, FULL)
        day = world.day_in(OFFICE, drawn.hidden_type)
        law = dict.fromkeys(np.flatnonzero(~day.open), REFUSED) | dict.fromkeys(
            np.flatnonzero(day.crowded), CROWDED
        )
        found = plan(task, laws_of(family, law))
        step = task.act(0)
        assert step.ended
        assert found.values[0, 0] == step.reward == family.best_return(number)


def test_cells_without_effects_have_those_of_their_neighbours():
    counts = np.zeros((1, RING.n_causes, 3))
    counts[0, 1, CROWDED], counts[0, 2, FREE] = 4, 1
    found = RING.smoothed(counts)
    assert found[0, 0].tolist() == [0, 4 * SPREAD, 0]
    assert found[0, 4].tolist() == [SPREAD, 0, 0]
    assert np.array_equal(found[0, 1:3], counts[0, 1:3])
    assert not found[0, RING.n_cells :].any()


def test_types_are_told_apart_by_regions_alone():
    counts = effect_counts(RING, [(1, REFUSED), (RING.n_cells, REFUSED)])
    known = KnownTypes.joined(RING, ["a"], counts.counts(range(RING.n_causes))[None])
    assert known.judged.tolist() == [RING.n_cells]
    assert known.library(np.ones(1)).n_policies == 1


def test_the_day_is_not_read():
    quiet, works = (WayTask(RING, way(blocked)) for blocked in ((), (1,)))
    laws = laws_of(RING, {}, {1: CROWDED})
    assert np.array_equal(plan(quiet, laws).values, plan(works, laws).values)
    assert quiet._ways == works._ways
    assert all(b in RING.days.world.neighbour[a] for a, b in pairwise([0, *quiet._ways[0]]))


def missed(family, agent, tasks):
    """Points of the first episodes below the best possible, and the number of types met."""
    lived = live_long(family, tasks=tasks, agent=agent, episodes=2)["tasks"]
    points = np.array([task["best_return"] - task["returns"][0] for task in lived])
    assert points.min() >= 0
    return points, sum(task["new_type"] for task in lived)


def test_a_day_is_learnt_and_reused():
    family = BuildingFamily(BuildingDays(OFFICE, TaskStream(("works",), n_contexts=1), n_destinations=2))
    full, types = missed(family, "full", 24)
    # At 5 % false alarms, four or more in 23 tasks have a probability below 3 %.
    assert types <= 4
    assert full[12:].mean() < 0.3 * missed(family, "scratch", 24)[0][12:].mean()


@pytest.mark.slow
def test_reuse_and_memory_pay():
    stream = TaskStream(tuple(DAYS), n_contexts=3, loyalty=0.9)
    family = BuildingFamily(BuildingDays(OFFICE, stream, n_destinations=3))
    agents = "full", "no-reuse", "scratch"
    full, no_reuse, scratch = (missed(family, agent, 30)[0][15:].mean() for agent in agents)
    assert full < no_reuse < scratch
