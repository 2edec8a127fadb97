"""A map that changes during a life: read again between tasks, and never half."""

import os
from pathlib import Path

import numpy as np
import pytest

from lifelore.agent.live.buildings.map_watch import MapWatch
from lifelore.agent.live.life import Life, live
from lifelore.agent.live.lore import Lore, prior_scope
from lifelore.agent.live.output.report import FILES, write_portfolio
from lifelore.core.errors import InputError
from lifelore.domains.buildings.occupancy_map import OccupancyMap, write_occupancy_map
from lifelore.domains.worlds import WorldSettings, make_world
from lifelore.memory import open_memory

from ..flat_settings import flat_settings


def two_rooms(doors: tuple[int, ...] = (2,)) -> OccupancyMap:
    """Two rooms of 6 x 6 m side by side, joined by doors 1 m wide from these rows on."""
    state = np.zeros((62, 121), np.uint8)
    state[[0, -1], :] = state[:, [0, -1]] = state[:, 60] = 1
    for door in doors:
        state[door : door + 10, 60] = 0
    return OccupancyMap(state, 0.1)


@pytest.fixture
def watched(tmp_path: Path) -> Path:
    path = tmp_path / "map.yaml"
    write_occupancy_map(path, two_rooms())
    return path


def save(path: Path, doors: tuple[int, ...]) -> None:
    write_occupancy_map(path, two_rooms(doors))


def test_a_look_at_the_same_map_is_no_change(watched):
    watch = MapWatch(WorldSettings(map=str(watched)))
    assert watch.changed() is None
    save(watched, (2,))
    os.utime(watched, (1, 1))  # saved again, the same content
    assert watch.changed() is None


def test_a_changed_image_or_yaml_is_read_once(watched):
    watch = MapWatch(WorldSettings(map=str(watched)))
    save(watched, (2, 40))
    changed = watch.changed()
    assert changed is not None
    assert np.array_equal(changed.state, two_rooms((2, 40)).state)
    assert watch.changed() is None
    watched.write_text(watched.read_text().replace("resolution: 0.1", "resolution: 0.2"))
    changed = watch.changed()
    assert changed is not None
    assert changed.resolution == 0.2


@pytest.mark.parametrize("which", ["map.yaml", "map.pgm"])
@pytest.mark.parametrize("how", ["half", "empty", "gone"])
def test_a_bad_map_is_an_error_and_a_good_one_later_a_change(watched, which, how):
    watch = MapWatch(WorldSettings(map=str(watched)))
    file = watched.with_name(which)
    whole = file.read_bytes()
    file.write_bytes(whole[: len(whole) // 2 if how == "half" else 0])
    if how == "gone":
        file.unlink()
    with pytest.raises(InputError, match="map"):
        watch.changed()
    assert watch.changed() is None  # reported once
    save(watched, (2, 40))
    assert watch.changed() is not None


def test_the_map_as_it_was_before_the_bad_one_is_no_change(watched):
    watch = MapWatch(WorldSettings(map=str(watched)))
    whole = watched.read_bytes()
    watched.write_bytes(b"")
    with pytest.raises(InputError):
        watch.changed()
    watched.write_bytes(whole)
    assert watch.changed() is None


def life_with(watched: Path, edits: dict[int, object], **changes) -> tuple[Life, list[str]]:
    """A life in which `edits[n]` is called after n finished tasks; and the lines that it said."""
    said: list[str] = []

    def edit(done: int, total: int, label: str) -> None:
        if done in edits:
            edits[done]()  # type: ignore[operator]

    settings = flat_settings(
        domain="building", map=str(watched), watch=True,
        **{"tasks": 4, "robot_radius": 0.0, "memory": str(watched.with_name("life.db"))} | changes,
    )  # fmt: skip
    return live(settings, progress=edit, notify=said.append), said


def test_a_life_goes_on_in_the_changed_building(watched, tmp_path):
    life, said = life_with(watched, {3: lambda: save(watched, (40,))}, tasks=5)
    (change,) = life.report["map_changes"]
    assert (change["before_task"], change["used"]) == (3, True)
    assert change["agreement"] > 0.8
    assert len(said) == 1
    assert f"map {watched} changed before task 3" in said[0]
    tasks = life.report["tasks"]
    assert len(tasks) == 5
    # It still knows most of the building, and learns the new door.
    first = tasks[3]["agents"]
    assert first["lore"]["reached"]
    assert first["lore"]["steps_to_80"] < first["scratch"]["steps_to_80"]
    assert life.first_here == 3
    written = write_portfolio(life, str(tmp_path / "out"))
    assert {Path(path).name for path in written} == set(FILES)
    paths = (tmp_path / "out" / "paths.csv").read_text().splitlines()[1:]
    assert {line.split(",")[0] for line in paths} <= {"3", "4"}


def test_a_half_written_map_leaves_the_last_good_one(watched):
    image = watched.with_suffix(".pgm")
    whole = image.read_bytes()
    edits = {1: lambda: image.write_bytes(whole[:100]), 2: lambda: image.write_bytes(whole)}
    life, said = life_with(watched, edits, tasks=3)
    (change,) = life.report["map_changes"]
    assert (change["before_task"], change["used"]) == (1, False)
    assert "truncated" in change["reason"] or "damaged" in change["reason"]
    assert len(said) == 1
    assert said[0].endswith("the last good map stays")
    still, _ = life_with(watched, {}, tasks=3, robot="other", memory=str(watched.with_name("still.db")))
    assert life.report["tasks"] == still.report["tasks"]
    assert still.report["map_changes"] == []


def test_a_map_in_which_the_goal_is_no_place_is_not_used(watched):
    def wall_in() -> None:
        changed = two_rooms()
        changed.state[30:50, 90:110] = 1
        write_occupancy_map(watched, changed)

    life, _ = life_with(watched, {1: wall_in}, goal=(10.05, 2.05), tasks=2)
    (change,) = life.report["map_changes"]
    assert not change["used"]
    assert "goal must be a free place" in change["reason"]
    assert len(life.report["tasks"]) == 2


def test_nothing_is_carried_to_another_building(watched):
    life, _ = life_with(watched, {}, tasks=2)
    world = make_world("building", seed=4)
    with open_memory(watched.with_name("life.db")) as memory:
        lore = Lore.recalled(world, prior_scope(world, "observation"), 0.1, memory)
        assert lore.carry(life.lore, memory) == 0
    assert (lore.model.target < 0).all()


def test_what_agrees_is_carried_and_the_rest_forgotten_until_the_map_changes_back(watched):
    """Every carried transition of a place whose surroundings are unchanged is true in the new map."""
    edits: dict[int, object] = {2: lambda: save(watched, (40,)), 3: lambda: save(watched, (2,))}
    life, _ = life_with(watched, edits, tasks=4, agent="model", compare=False)
    assert [change["used"] for change in life.report["map_changes"]] == [True, True]
    model, world = life.lore.model, life.world
    true = np.where(world.neighbour < 0, np.arange(world.n_states)[:, None], world.neighbour)
    known = model.target >= 0
    assert (model.target == true)[known].all()
    assert (model.percept[model.percept >= 0] == world.percepts[model.percept >= 0]).all()
    again, _ = life_with(watched, {}, tasks=1, agent="model", compare=False)
    assert (again.lore.model.target >= 0)[known].all()  # nothing is unknown after the change and back
