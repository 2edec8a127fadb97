"""Runs of a robot teach transitions and the prior: once, exactly, and with effect on the next life."""

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from lifelore.agent.learn_from.learn_from import forget_source, learn_from
from lifelore.agent.learn_from.run_log import Run, read_runs
from lifelore.agent.live.buildings.recognition import recognised_place
from lifelore.agent.live.driven.route import cheapest_route
from lifelore.agent.live.life import live
from lifelore.agent.live.life_settings import LifeSettings, MemorySettings
from lifelore.agent.live.lore import Lore
from lifelore.agent.travel import Travel
from lifelore.core.errors import InputError, NotFoundError
from lifelore.domains.worlds import WorldSettings, map_from_settings, world_from_settings
from lifelore.memory import open_memory

from .robot_runs import csv_text, driven_run

OFFICE = WorldSettings("building", str(Path(__file__).parents[3] / "examples" / "data" / "office.yaml"), seed=3)


@pytest.fixture(scope="module")
def world():
    return world_from_settings(OFFICE)


@pytest.fixture(scope="module")
def runs(world):
    return [driven_run(world, number) for number in range(12)]


def settings(path) -> dict[str, Any]:
    return {"map": OFFICE.map, "memory": path, "robot": "rosie"}


def known(world, path) -> Lore:
    with open_memory(path) as memory:
        return Lore.recalled(world, 0.1, memory)


def test_what_was_driven_is_known_and_true(world, runs, tmp_path):
    report = learn_from(runs, **settings(tmp_path / "m.db"))
    assert (report["runs"], report["new"], report["to_goal"], report["warnings"]) == (12, 12, 12, [])
    assert report["competence"] > 0.9  # shortest paths, but for noise at the borders of cells
    lore = known(world, tmp_path / "m.db")
    state, action = np.nonzero(lore.model.target >= 0)
    assert len(state) > 200
    assert np.array_equal(lore.model.target[state, action], world.neighbour[state, action])
    seen = lore.model.percept >= 0
    assert np.array_equal(lore.model.percept[seen], world.percepts[seen])
    assert len(lore.prior) > 5


def test_a_run_is_learnt_once_in_whatever_file(world, runs, tmp_path):
    (tmp_path / "first.csv").write_text(csv_text(runs[:3]))
    (tmp_path / "longer.csv").write_text(csv_text(runs[:4]))
    path = tmp_path / "m.db"
    assert learn_from(read_runs(tmp_path / "first.csv"), **settings(path))["new"] == 3
    before = known(world, path)
    assert learn_from(read_runs(tmp_path / "first.csv"), **settings(path))["new"] == 0
    again = known(world, path)
    assert np.array_equal(before.model.target, again.model.target)
    codes = np.unique(world.percepts)
    assert np.array_equal(before.prior.probs(codes), again.prior.probs(codes))
    assert learn_from(read_runs(tmp_path / "longer.csv"), **settings(path))["new"] == 1


@pytest.mark.slow
def test_the_next_life_begins_better(world, tmp_path):
    """The first task of a life: moves save steps, and the prior saves collisions."""
    learn_from([driven_run(world, number) for number in range(60)], **settings(tmp_path / "taught.db"))

    def first_task(path) -> dict:
        life = live(LifeSettings(OFFICE, memory=MemorySettings(str(path)), tasks=1))
        return life.report["tasks"][0]["agents"]["lore"]

    taught, fresh = first_task(tmp_path / "taught.db"), first_task(tmp_path / "fresh.db")
    assert taught["steps_to_80"] < 0.85 * fresh["steps_to_80"]
    assert taught["collisions"] < 0.2 * fresh["collisions"]


def test_a_bump_where_the_map_is_free_is_reported(world, tmp_path):
    state = int(np.flatnonzero((world.neighbour >= 0).all(axis=1))[0])
    east = int(world.neighbour[state, 2])
    here, there = world.positions(np.array([state, east]))
    bumped = Run(
        "b", np.array([0.0, 1.0]), np.array([here, here + 0.2 * (there - here)]), np.full(2, np.nan), ["", "bump"]
    )
    report = learn_from([bumped], **settings(tmp_path / "m.db"))
    assert (report["bumps"], report["moves"]) == (1, 0)
    assert report["new_obstacles"] == [[*(round(float(x), 3) for x in here), "east"]]
    assert "no run ended with the outcome goal" in report["warnings"][-1]


def test_a_log_in_another_frame_is_refused_or_warned_of(world, runs, tmp_path):
    path = tmp_path / "m.db"
    far = [replace(run, points=run.points + 100.0) for run in runs]
    with pytest.raises(InputError, match=r"where the robot cannot be on this map .* no single offset mends it"):
        learn_from(far, **settings(path))
    moved = [replace(run, points=run.points + np.array([5.0, 2.0])) for run in runs]
    with pytest.raises(InputError, match=r"--shift=-[45]\.?\d*,-[12]\.?\d*,0 leaves 0\.\d%") as caught:
        learn_from(moved, **settings(path), source="log.csv")
    assert str(caught.value).startswith("log.csv: ")
    with open_memory(path) as memory:
        assert memory.tasks("rosie") == 0
    assert learn_from(moved, **settings(path), shift=(-5.0, -2.0, 0.0))["new"] == 12


def test_real_noise_is_learnt_and_noise_of_half_a_cell_is_not(world, tmp_path):
    def noisy(sigma):
        return [driven_run(world, number, noise=sigma) for number in range(12)]

    clean = learn_from(noisy(0.0), **settings(tmp_path / "a.db"))
    real = learn_from(noisy(0.05), **settings(tmp_path / "b.db"))
    assert real["warnings"] == []
    assert 0.03 < real["noise"] < 0.07
    assert abs(real["moves"] - clean["moves"]) < 0.1 * clean["moves"]
    with pytest.raises(InputError, match=r"the poses tremble by 0\.\d+ m"):
        learn_from(noisy(0.25), **settings(tmp_path / "c.db"))
    millimetres = [replace(run, points=1000 * run.points) for run in noisy(0.005)]
    with pytest.raises(InputError, match=r"poses lie where the robot cannot be.*metres"):
        learn_from(millimetres, **settings(tmp_path / "d.db"))


def corridor(world) -> tuple[int, int]:
    """Two neighbouring states from which the way round is short."""
    open_floor = np.flatnonzero((world.neighbour >= 0).all(axis=1))
    return next(
        (s, int(world.neighbour[s, 2])) for s in open_floor.tolist() if world.neighbour[s, 2] in open_floor
    )


def short_run(world, start: int, goal: int, at: float, bump: bool) -> Run:
    """From the middle of a cell to the next, or a bump at 40 % of the way; `at` in seconds since 1970."""
    here, there = world.positions(np.array([start, goal]))
    points = here + np.outer([0.0, 0.4] if bump else [0.0, 1.0], there - here)
    return Run("r", at + np.arange(2.0), points, np.full(2, np.nan), ["", "bump" if bump else ""])


def way_around(world, path, start: int, goal: int, clock: float) -> list[int]:
    """States of the way of least `Travel` cost."""
    with open_memory(path) as memory:
        occupancy = map_from_settings(OFFICE)
        place = recognised_place(OFFICE, world, occupancy, memory)
        cost = Travel.recalled(world, place.grid, memory).costs(clock).cost
    route = cheapest_route(world, start, goal, cost)
    assert route is not None
    return route.states.tolist()


def test_bumps_close_a_place_that_passes_and_age_reopen(world, runs, tmp_path):
    path, (start, closed) = tmp_path / "m.db", corridor(world)
    goal, monday, day = int(world.neighbour[closed, 2]), 1704067200.0, 86400.0
    learn_from(
        [replace(run, time=run.time + monday - 6000 + 300 * k) for k, run in enumerate(runs)], **settings(path)
    )
    assert way_around(world, path, start, goal, monday) == [start, closed, goal]
    bumps = [short_run(world, start, closed, monday + 600 * k, bump=True) for k in range(1, 4)]
    learn_from(bumps, **settings(path))
    assert closed not in way_around(world, path, start, goal, monday + 3600)
    assert known(world, path).model.target[start, 2] != start  # no transition: the bump ages
    assert way_around(world, path, start, goal, monday + 365 * day) == [
        start,
        closed,
        goal,
    ]  # the way round is short
    passes = [short_run(world, start, closed, monday + 600 * k, bump=False) for k in range(7, 12)]
    learn_from(passes, **settings(path))
    assert way_around(world, path, start, goal, monday + 7200) == [start, closed, goal]


@pytest.mark.parametrize(("n", "least", "most"), [(1, 0.1, 0.4), (2, 0.6, 1.0)])
def test_bumps_of_one_minute_add_up(world, runs, tmp_path, n, least, most):
    """A life of passes first, so that refusals are rare; then `n` bumps within a minute."""
    path, (start, closed), monday = tmp_path / "m.db", corridor(world), 1704067200.0
    learn_from([replace(run, time=run.time + monday + 600 * k) for k, run in enumerate(runs)], **settings(path))
    once = short_run(world, start, closed, monday + 86400, bump=True)
    bumps = replace(once, time=once.time[0] + np.arange(2.0 * n), points=np.tile(once.points, (n, 1)),
                    heading=np.full(2 * n, np.nan), outcome=["", "bump"] * n)  # fmt: skip
    learn_from([bumps], **settings(path))
    with open_memory(path) as memory:
        grid = recognised_place(OFFICE, world, map_from_settings(OFFICE), memory).grid
        blocked = Travel.recalled(world, grid, memory).blocked(monday + 86500)[start, 2]
    assert least < blocked <= most


def content(path) -> dict:
    """All records of a memory by name."""
    with open_memory(path) as memory:
        names = [(one["kind"], one["key"], one["version"]) for one in memory.show()["lore"]]
        found = {name: memory.recall(*name) for name in names}
        return {name: (one.slots.tolist(), one.values.tolist()) for name, one in found.items() if len(one.slots)}


def test_a_source_is_undone_and_can_be_learnt_again(world, runs, tmp_path):
    path = tmp_path / "m.db"
    learn_from(runs[:3], **settings(path), source="monday.csv")
    before = content(path)
    learn_from(runs[3:8], **settings(path), source="tuesday.csv")
    both = content(path)
    assert both != before
    with open_memory(path) as memory:
        with pytest.raises(NotFoundError, match="has taught nothing here"):
            forget_source(memory, "tuesday.csv", robot="karl")
        assert forget_source(memory, "tuesday.csv", robot="rosie") == 5
        with pytest.raises(
            NotFoundError, match=r"'tuesday.csv' has taught nothing here; known sources: monday.csv"
        ):
            forget_source(memory, "tuesday.csv")
    assert content(path) == before
    assert learn_from(runs[3:8], **settings(path), source="tuesday.csv")["new"] == 5
    again = content(path)
    assert set(again) == set(both)
    assert all(again[name] == both[name] for name in both if name[0] != "passes")  # these have no clock: run now


def test_what_two_sources_hold_stays_when_one_is_undone(world, runs, tmp_path):
    path = tmp_path / "m.db"
    shorter = replace(runs[0], time=runs[0].time[:-1], points=runs[0].points[:-1], heading=runs[0].heading[:-1],
                      outcome=runs[0].outcome[:-1])  # fmt: skip
    learn_from([runs[0]], **settings(path), source="a.csv")
    target = known(world, path).model.target
    learn_from([shorter], **settings(path), source="b.csv")
    with open_memory(path) as memory:
        forget_source(memory, "a.csv")
    left = known(world, path).model.target
    assert (left != target).sum() <= 1  # the last move alone was only in a.csv
    assert (left >= 0).sum() > 5


def test_a_dry_run_stores_nothing(world, runs, tmp_path):
    path = tmp_path / "m.db"
    dry = settings(path) | {"dry_run": True}
    said = learn_from(runs, **dry)
    assert (said["new"], said["dry_run"], path.exists()) == (12, True, False)
    learn_from(runs[:5], **settings(path))
    before = content(path)
    assert learn_from(runs, **dry)["new"] == 7
    assert content(path) == before


def test_a_map_is_needed():
    with pytest.raises(InputError, match="map must be given"):
        learn_from([], map=None)  # type: ignore[arg-type]


def test_without_outcomes_runs_may_be_declared_to_reach_their_goal(world, tmp_path):
    run = driven_run(world, 1, outcome="")
    assert learn_from([run], **settings(tmp_path / "a.db"))["to_goal"] == 0
    assert learn_from([run], **settings(tmp_path / "b.db"), reached_goal=True)["to_goal"] == 1
