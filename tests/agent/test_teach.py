"""`lifelore teach`: a pupil of pictures walks by what is shown; keys as text; what is written and what is not."""

import json
from collections import deque

import numpy as np
import pytest

from lifelore.action.demonstrations.demonstrations import read_demonstrations
from lifelore.action.priors.prior_file import load_prior
from lifelore.agent.live.lore import PERCEPT_KEY
from lifelore.agent.teach import COLUMNS, ROWS, grid_text, teach
from lifelore.core.errors import InputError, NotFoundError
from lifelore.domains.grids.grid_world import GridWorld
from lifelore.domains.worlds import WorldSettings, make_world

NOISE = WorldSettings("noise", size=9, density=0.3, seed=4)
STEPS = {"w": (-1, 0), "s": (1, 0), "d": (0, 1), "a": (0, -1)}
ARROWS = {"w": "\x1b[A", "s": "\x1b[B", "d": "\x1b[C", "a": "\x1bOD"}


def shortest_way(picture: list[str]) -> str:
    """Keys from @ to G through what is not #."""
    at = {mark: (r, c) for r, row in enumerate(picture) for c, mark in enumerate(row) if mark in "@G"}
    waiting, seen = deque([(at["@"], "")]), {at["@"]}
    while waiting:
        (row, column), keys = waiting.popleft()
        if (row, column) == at["G"]:
            return keys
        for key, (d_row, d_column) in STEPS.items():
            there = (row + d_row, column + d_column)
            if there not in seen and picture[there[0]][there[1]] != "#":
                seen.add(there)
                waiting.append((there, keys + key))
    raise AssertionError("no way")


class Watcher:
    """Somebody at a terminal: keeps what is shown, and types what `reply` makes of the way."""

    def __init__(self, reply=lambda way: way):
        self.shown, self.reply = [], reply

    def __call__(self, text: str) -> None:
        self.shown.append(text)

    def __iter__(self):
        return self

    def __next__(self) -> str:
        picture = [line for line in self.shown[-1].split("\n") if set(line) <= set("#.@G")]
        return self.reply(shortest_way(picture)) + "\n"


def lesson(watcher, out, **told):
    return teach(NOISE, watcher, watcher, out=out, **told)


def test_whoever_walks_by_the_picture_is_an_expert(tmp_path):
    watcher, out = Watcher(), tmp_path / "shown.jsonl"
    report = lesson(watcher, out, person="ann", tasks=3, prior=tmp_path / "prior.npz")
    told = read_demonstrations(out)
    assert report == {
        "out": str(out),
        "person": "ann",
        "shown": 3,
        "given_up": 0,
        "steps": sum(len(one.states) for one in told),
        "competence": 1.0,
        "prior": str(tmp_path / "prior.npz"),
    }
    assert len({one.task for one in told}) == 3
    world = make_world("noise", size=9, density=0.3, seed=4)
    for one in told:
        goal = int(one.task.split("goal ")[1].split("/")[0])
        after = world.neighbour[one.states, one.actions]
        assert one.agent == "ann"
        assert np.array_equal(after[:-1], one.states[1:])
        assert after[-1] == goal
    prior = load_prior(tmp_path / "prior.npz")
    assert prior.key == PERCEPT_KEY
    assert prior.counts(np.unique(world.percepts)).sum() == report["steps"]
    with np.load(tmp_path / "prior.npz") as file:
        about = json.loads(file["about"].tobytes())["about"]
    assert about["actions"] == ["north", "south", "east", "west"]


@pytest.mark.parametrize(
    "reply",
    [
        lambda way: way[0],  # a key a line
        lambda way: "".join(ARROWS[key] for key in way),
        lambda way: way.upper(),
        lambda way: " ".join(way),
    ],
)
def test_however_keys_come_they_are_the_same_steps(tmp_path, reply):
    one, other = tmp_path / "one", tmp_path / "other"
    lesson(Watcher(), one, tasks=2)
    lesson(Watcher(reply), other, tasks=2)
    assert one.read_bytes() == other.read_bytes()


def test_walls_are_told_and_counted_as_steps(tmp_path):
    keys = iter(["wwwwwwww"])  # eight steps north meet a wall in a world of nine rows
    watcher = Watcher(lambda way: next(keys, way))
    report = lesson(watcher, tmp_path / "bumped", tasks=1)
    assert any(text.startswith("north: a wall\n") for text in watcher.shown)
    assert report["shown"] == 1
    assert report["steps"] > 8
    assert 0 <= report["competence"] < 1


def test_only_reached_goals_are_written(tmp_path):
    out = tmp_path / "shown.jsonl"
    report = lesson(iterated(["w\n", "a\n", "n\n", "n", "dq", "www"]), out, tasks=5)
    # The first is given up after two steps, the second without any, the third is left; two never begin.
    assert (report["shown"], report["given_up"], report["steps"], report["competence"]) == (0, 2, 0, None)
    assert read_demonstrations(out) == []
    assert lesson(iterated([]), out)["given_up"] == 0
    assert lesson(iterated(["w"]), out)["given_up"] == 1  # the input ended


def iterated(lines):
    watcher = Watcher()
    watcher.__class__ = type("Lines", (Watcher,), {"__iter__": lambda self: iter(lines)})
    return watcher


def test_lessons_add_up_and_stay_apart(tmp_path):
    out = tmp_path / "shown.jsonl"
    lesson(Watcher(), out, tasks=1)
    lesson(Watcher(), out, tasks=1)
    first, second = read_demonstrations(out)
    assert first.task == second.task
    assert np.array_equal(first.states, second.states)


def test_the_picture_by_hand():
    world = GridWorld.from_free("t", np.array([[1, 1, 0], [0, 1, 1]], bool))
    assert grid_text(world, 0, 3) == "@.#\n#.G"


def test_a_large_world_is_shown_around_the_agent():
    free = np.ones((100, 200), bool)
    world = GridWorld.from_free("t", free)
    *rows, where = grid_text(world, 0, world.n_states - 1).split("\n")
    assert (len(rows), {len(row) for row in rows}, rows[0][0]) == (ROWS, {COLUMNS}, "@")
    assert where == "goal: 99 down, 199 right"
    *rows, where = grid_text(world, world.n_states - 1, 0).split("\n")
    assert (len(rows), rows[-1][-1], where) == (ROWS, "@", "goal: 99 up, 199 left")
    inside = grid_text(world, 50 * 200 + 100, 51 * 200 + 100).split("\n")
    assert (len(inside), sum(row.count("G") for row in inside)) == (ROWS, 1)


def test_broken_rules(tmp_path):
    out = tmp_path / "shown"
    for told, message in [
        ({"tasks": 0}, "tasks must be at least 1, got 0"),
        ({"person": " "}, "name must not be empty"),
        ({"prior": tmp_path}, "must be files in a folder that exists"),
        ({"prior": out}, "out and prior must be two files, got"),
        ({"prior": ""}, "must be files in a folder that exists, got ''"),
    ]:
        with pytest.raises(InputError, match=message):
            lesson(Watcher(), out, **told)
    with pytest.raises(InputError, match="must be files in a folder that exists"):
        lesson(Watcher(), tmp_path / "no" / "where")
    with pytest.raises(NotFoundError, match="domain must be one of"):
        teach(WorldSettings("moon"), [], print, out=out)
    assert not out.exists()
