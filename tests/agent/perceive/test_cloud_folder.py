"""New clouds of a folder, with a clock of the test's own: when each comes, and what is left alone."""

import os
from pathlib import Path

import pytest

from lifelore.agent.perceive.cloud_folder import LOOK_EVERY, new_clouds
from lifelore.core.errors import InputError


class Script:
    """Stands for the stop event and the clock: each wait passes `LOOK_EVERY` and does what is due by then."""

    def __init__(self, until: float, *deeds):
        self.now, self.until, self.deeds = 0.0, until, sorted(deeds, key=lambda deed: deed[0])

    def is_set(self) -> bool:
        return self.now > self.until

    def wait(self, seconds: float) -> bool:
        self.now += seconds
        while self.deeds and self.deeds[0][0] <= self.now:
            self.deeds.pop(0)[1]()
        return self.is_set()


def watched(folder, script):
    """(time, name, size in bytes) of all that came."""
    arrivals = new_clouds(folder, script)  # pyright: ignore[reportArgumentType]
    return [(script.now, Path(path).name, os.stat(path).st_size) for path in arrivals]


def saving(path: Path, size: int = 27):
    return lambda: path.write_bytes(bytes(size))


def test_each_new_file_comes_once_when_it_has_settled(tmp_path):
    script = Script(5, (1, saving(tmp_path / "b.npy")), (1, saving(tmp_path / "a.npy", 9)))
    found = watched(tmp_path, script)
    assert [(name, n) for _, name, n in found] == [("a.npy", 9), ("b.npy", 27)]
    assert all(1 + LOOK_EVERY <= at <= 1 + 2.5 * LOOK_EVERY for at, *_ in found)


def test_what_is_there_already_is_left_alone_until_it_changes(tmp_path):
    saving(tmp_path / "old.npy")()
    assert watched(tmp_path, Script(5)) == []
    assert [n for *_, n in watched(tmp_path, Script(5, (2, saving(tmp_path / "old.npy", 5))))] == [5]


def test_a_new_version_comes_again_even_if_it_is_as_long_and_as_old(tmp_path):
    def replaced():
        age = os.stat(tmp_path / "a.npy").st_mtime_ns
        saving(tmp_path / "next.tmp.npy")()
        os.utime(tmp_path / "next.tmp.npy", ns=(age, age))
        os.replace(tmp_path / "next.tmp.npy", tmp_path / "a.npy")

    found = watched(tmp_path, Script(6, (1, saving(tmp_path / "a.npy")), (3, replaced)))
    assert [(name, n) for _, name, n in found] == [("a.npy", 27), ("a.npy", 27)]


def test_a_file_that_grows_comes_when_it_is_whole(tmp_path):
    parts = [(1 + k * 0.8 * LOOK_EVERY, saving(tmp_path / "a.npy", 100 * (k + 1))) for k in range(8)]
    assert [n for *_, n in watched(tmp_path, Script(10, *parts))] == [800]


def test_a_file_that_grows_on_after_a_pause_comes_again(tmp_path):
    halves = (1, saving(tmp_path / "a.npy", 300)), (3, saving(tmp_path / "a.npy", 600))
    assert [n for *_, n in watched(tmp_path, Script(6, *halves))] == [300, 600]


def test_a_file_that_changes_while_another_is_perceived_waits_until_it_has_settled(tmp_path):
    script = Script(5, (1, saving(tmp_path / "a.npy")), (1, saving(tmp_path / "b.npy", 300)))
    found = []
    for path in new_clouds(tmp_path, script):  # pyright: ignore[reportArgumentType]
        found.append((Path(path).name, os.stat(path).st_size))
        if len(found) == 1:
            saving(tmp_path / "b.npy", 600)()
    assert found == [("a.npy", 27), ("b.npy", 600)]


def test_a_file_that_goes_away_is_forgotten(tmp_path):
    deeds = ((1, saving(tmp_path / "a.npy")), (1.2, lambda: (tmp_path / "a.npy").unlink()))
    assert watched(tmp_path, Script(5, *deeds)) == []


def test_other_files_and_hidden_ones_are_no_clouds(tmp_path):
    def write():
        for name in (".a.npy", "a.png", "a.pcd.part", "pcd"):
            (tmp_path / name).write_bytes(b"1")

    assert watched(tmp_path, Script(5, (1, write))) == []


def test_a_folder_that_is_none_is_refused_at_once(tmp_path):
    (tmp_path / "file").touch()
    for name in ("missing", "file"):
        with pytest.raises(InputError, match="watch must name a folder"):
            new_clouds(tmp_path / name, Script(1))  # pyright: ignore[reportArgumentType]


def test_a_folder_that_goes_away_ends_the_watch(tmp_path):
    folder = tmp_path / "clouds"
    folder.mkdir()
    with pytest.raises(InputError, match="watch must name a folder"):
        watched(folder, Script(5, (1, folder.rmdir)))
