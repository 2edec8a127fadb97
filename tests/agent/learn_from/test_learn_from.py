"""Runs of a robot teach transitions and the prior: once, exactly, and with effect on the next life."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from lifelore.agent.learn_from.learn_from import LearnFromSettings, learn_from
from lifelore.agent.learn_from.run_log import Run, read_runs
from lifelore.agent.live.life import live
from lifelore.agent.live.life_settings import LifeSettings, MemorySettings
from lifelore.agent.live.lore import Lore, prior_scope
from lifelore.core.errors import InputError
from lifelore.domains.worlds import WorldSettings, world_from_settings
from lifelore.memory import open_memory

from .robot_runs import csv_text, driven_run

OFFICE = WorldSettings("building", str(Path(__file__).parents[3] / "examples" / "data" / "office.yaml"), seed=3)


@pytest.fixture(scope="module")
def world():
    return world_from_settings(OFFICE)


@pytest.fixture(scope="module")
def runs(world):
    return [driven_run(world, number) for number in range(12)]


def settings(path) -> LearnFromSettings:
    return LearnFromSettings(OFFICE, MemorySettings(str(path), "rosie"))


def known(world, path) -> Lore:
    with open_memory(path) as memory:
        return Lore.recalled(world, prior_scope(world, "observation"), 0.1, memory)


def test_what_was_driven_is_known_and_true(world, runs, tmp_path):
    report = learn_from(runs, settings(tmp_path / "m.db"))
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
    assert learn_from(read_runs(tmp_path / "first.csv"), settings(path))["new"] == 3
    before = known(world, path)
    assert learn_from(read_runs(tmp_path / "first.csv"), settings(path))["new"] == 0
    again = known(world, path)
    assert np.array_equal(before.model.target, again.model.target)
    codes = np.unique(world.percepts)
    assert np.array_equal(before.prior.probs(codes), again.prior.probs(codes))
    assert learn_from(read_runs(tmp_path / "longer.csv"), settings(path))["new"] == 1


@pytest.mark.slow
def test_the_next_life_begins_better(world, tmp_path):
    """The first task of a life: moves save steps, and the prior saves collisions."""
    learn_from([driven_run(world, number) for number in range(60)], settings(tmp_path / "taught.db"))

    def first_task(path) -> dict:
        life = live(LifeSettings(OFFICE, memory=MemorySettings(str(path)), tasks=1))
        return life.report["tasks"][0]["agents"]["lore"]

    taught, fresh = first_task(tmp_path / "taught.db"), first_task(tmp_path / "fresh.db")
    assert taught["steps_to_80"] < 0.85 * fresh["steps_to_80"]
    assert taught["collisions"] < 0.2 * fresh["collisions"]


def test_a_bump_closes_a_move_until_it_is_made_again(world, tmp_path):
    state = int(np.flatnonzero((world.neighbour >= 0).all(axis=1))[0])
    east = int(world.neighbour[state, 2])
    here, there = world.positions(np.array([state, east]))
    bumped = Run(
        "b", np.array([0.0, 1.0]), np.array([here, here + 0.2 * (there - here)]), np.full(2, np.nan), ["", "bump"]
    )
    report = learn_from([bumped], settings(tmp_path / "m.db"))
    assert (report["bumps"], report["moves"]) == (1, 0)
    assert report["new_obstacles"] == [[*(round(float(x), 3) for x in here), "east"]]
    assert "no run ended with the outcome goal" in report["warnings"][-1]
    assert known(world, tmp_path / "m.db").model.target[state, 2] == state
    driven = Run("d", np.array([0.0, 1.0]), np.array([here, there]), np.full(2, np.nan), ["", ""])
    learn_from([driven], settings(tmp_path / "m.db"))
    assert known(world, tmp_path / "m.db").model.target[state, 2] == east


def test_a_log_in_another_frame_is_refused_or_warned_of(world, runs, tmp_path):
    path = tmp_path / "m.db"
    far = [replace(run, points=run.points + 100.0) for run in runs]
    with pytest.raises(InputError, match=r"poses lie on no place of this map; record x and y in metres"):
        learn_from(far, settings(path))
    with open_memory(path) as memory:
        assert memory.tasks("rosie") == 0
    turned = [replace(run, points=run.points + np.array([0.6, 0.6])) for run in runs]
    assert learn_from(turned, settings(path))["warnings"]


def test_a_map_is_needed():
    with pytest.raises(InputError, match="map must be given"):
        LearnFromSettings(WorldSettings("building"))


def test_without_outcomes_runs_may_be_declared_to_reach_their_goal(world, tmp_path):
    run = driven_run(world, 1, outcome="")
    assert learn_from([run], settings(tmp_path / "a.db"))["to_goal"] == 0
    declared = replace(settings(tmp_path / "b.db"), reached_goal=True)
    assert learn_from([run], declared)["to_goal"] == 1
