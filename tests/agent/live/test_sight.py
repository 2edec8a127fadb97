"""Lives with a lidar: every task ends, the seen map is true and remembered; lives by touch are as before."""

import numpy as np
import pytest

from lifelore.agent.live.life import live
from lifelore.agent.live.life_settings import DEFAULT_RANGE
from lifelore.core.errors import InputError
from lifelore.core.learning.known_world import UNKNOWN

from .flat_settings import flat_settings


def office(tmp_path, **changes):
    defaults = {"domain": "building", "tasks": 4, "memory": str(tmp_path / "life.db"), "seed": 4}
    return live(flat_settings(**defaults | changes))


def results(life, agent):
    return [task["agents"][agent] for task in life.report["tasks"]]


@pytest.fixture(scope="module")
def seeing(tmp_path_factory):
    """A life with a lidar, to be read only."""
    return office(tmp_path_factory.mktemp("life"), sensor="lidar", agent="all", tasks=9)


def test_a_lidar_life_ends_every_task_without_collision(seeing):
    assert seeing.report["settings"]["sensor"] == "lidar"
    assert seeing.report["settings"]["range"] == DEFAULT_RANGE
    for agent in seeing.report["tasks"][0]["agents"]:
        assert all(result["reached"] for result in results(seeing, agent))
        assert all(0 <= r["steps_to_goal"] <= r["steps_to_80"] for r in results(seeing, agent))
        if agent != "undirected":
            assert not any(result["collisions"] for result in results(seeing, agent))


def test_the_robot_drives_to_the_goal_that_it_saw(seeing):
    for own in results(seeing, "lore")[2:]:
        # Memory knows the way as soon as the goal is seen; the episode still ends at the goal.
        assert own["steps_to_80"] - own["steps_to_goal"] <= 20
        assert own["first_return"] > 0


def test_memory_shortens_the_search_and_the_prior_adds_nothing(seeing):
    for one, other in (("lore", "model"), ("prior", "scratch"), ("frontier", "scratch")):
        assert results(seeing, one) == results(seeing, other)
    lore, scratch = (
        sum(result["steps_to_80"] for result in results(seeing, agent)[3:]) for agent in ("lore", "scratch")
    )
    assert lore < 0.75 * scratch


def test_the_seen_map_is_true_and_remembered(tmp_path):
    life = office(tmp_path, sensor="lidar", tasks=1)
    model, world = life.lore.model, life.world
    seen = model.percept != UNKNOWN
    true = np.where(world.neighbour < 0, np.arange(world.n_states)[:, None], world.neighbour)
    assert np.array_equal(model.target[seen], true[seen])
    assert np.array_equal(model.percept[seen], world.percepts[seen])
    # Far more places are seen than could be entered in so many steps, and the robot of another process knows them.
    assert seen.sum() > results(life, "lore")[0]["steps_to_80"]
    again = office(tmp_path, sensor="lidar", tasks=1, robot="other", agent="model")
    known = again.lore.model.percept != UNKNOWN
    assert (known & seen).sum() == seen.sum()
    # Most of what a lidar saw saves a robot that only touches the collisions.
    touching = office(tmp_path, tasks=1, robot="third", agent="model")
    assert results(touching, "model")[0]["collisions"] < results(touching, "scratch")[0]["collisions"] / 5


def test_a_longer_range_finds_sooner(tmp_path):
    def steps(reach: float) -> int:
        changes = {"range": reach, "tasks": 6, "agent": "scratch", "memory": str(tmp_path / f"{reach}.db")}
        return sum(r["steps_to_goal"] for r in results(office(tmp_path, sensor="lidar", **changes), "scratch"))

    assert steps(8.0) < steps(0.5) / 2


def test_touch_is_as_it_was(tmp_path):
    """Numbers of the release before there was a lidar."""
    life = office(tmp_path, agent="all", tasks=2)
    assert life.report["settings"]["sensor"] == "touch"
    assert life.report["settings"]["range"] is None
    assert {
        agent: [(r["steps_to_80"], r["collisions"], round(r["first_return"], 6)) for r in results(life, agent)]
        for agent in ("lore", "scratch", "frontier")
    } == TOUCH


TOUCH = {
    "lore": [(6300, 757, -172.615949), (500, 0, 1.468188)],
    "scratch": [(6300, 757, -172.615949), (6400, 766, -107.390132)],
    "frontier": [(2100, 0, 11.639428), (1700, 0, 7.330787)],
}


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        ({"sensor": "sonar"}, "sensor must be one of touch, lidar"),
        ({"range": 3.0}, "range applies to sensor lidar"),
        ({"sensor": "lidar", "range": 0.0}, "range must lie in"),
        ({"sensor": "lidar", "range": float("nan")}, "range must lie in"),
        ({"sensor": "lidar", "domain": "lattice"}, "sensor lidar needs a building"),
    ],
)
def test_settings_without_meaning_are_refused(tmp_path, wrong, message):
    with pytest.raises(InputError, match=message):
        office(tmp_path, **wrong)
