"""New clouds of a folder, with a clock of the test's own: when each is read, and what is left alone."""

import os
from pathlib import Path

import numpy as np
import pytest

from lifelore.agent.perceive.cloud_folder import LOOK_EVERY, RETRY_AFTER, SETTLED, new_clouds
from lifelore.core.errors import InputError
from lifelore.perception.clouds.cloud_file import read_cloud

CUBE = np.stack(np.meshgrid(*[np.arange(0, 0.06, 0.02)] * 3, indexing="ij"), axis=-1).reshape(-1, 3)


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


def save(path: Path, n: int = len(CUBE)):
    np.save(path, CUBE[:n])


def watched(folder, script, read=read_cloud):
    """(time, name, number of points or the error) of all that came."""
    arrivals = new_clouds(folder, read, script, clock=lambda: script.now)  # pyright: ignore[reportArgumentType]
    return [
        (script.now, Path(path).name, str(cloud) if isinstance(cloud, InputError) else len(cloud.points))
        for path, cloud in arrivals
    ]


def test_each_new_file_comes_once_when_it_has_settled(tmp_path):
    script = Script(5, (1, lambda: save(tmp_path / "b.npy")), (1, lambda: save(tmp_path / "a.npy", 9)))
    found = watched(tmp_path, script)
    assert [(name, n) for _, name, n in found] == [("a.npy", 9), ("b.npy", 27)]
    assert all(1 + SETTLED <= at <= 1 + SETTLED + 2.5 * LOOK_EVERY for at, *_ in found)


def test_what_is_there_already_is_left_alone_until_it_changes(tmp_path):
    save(tmp_path / "old.npy")
    assert watched(tmp_path, Script(5)) == []
    assert [n for *_, n in watched(tmp_path, Script(5, (2, lambda: save(tmp_path / "old.npy", 5))))] == [5]


def test_a_new_version_comes_again_even_if_it_is_as_long_and_as_old(tmp_path):
    def replaced():
        age = os.stat(tmp_path / "a.npy").st_mtime_ns
        save(tmp_path / "next.tmp.npy")
        os.utime(tmp_path / "next.tmp.npy", ns=(age, age))
        os.replace(tmp_path / "next.tmp.npy", tmp_path / "a.npy")

    found = watched(tmp_path, Script(6, (1, lambda: save(tmp_path / "a.npy")), (3, replaced)))
    assert [(name, n) for _, name, n in found] == [("a.npy", 27), ("a.npy", 27)]


def test_a_file_that_grows_is_not_read_before_it_is_whole(tmp_path):
    save(tmp_path / "whole")
    content = (tmp_path / "whole.npy").read_bytes()
    growing = tmp_path / "a.npy"
    parts = [(1 + k * 0.8 * SETTLED, lambda k=k: growing.write_bytes(content[: 100 * (k + 1)])) for k in range(8)]
    reads = []

    def read(path):
        reads.append(Path(path).stat().st_size)
        return read_cloud(path)

    found = watched(tmp_path, Script(10, *parts), read)
    assert [(name, n) for _, name, n in found] == [("a.npy", 27)]
    assert reads == [len(content)]


def test_a_writer_that_pauses_is_waited_for(tmp_path):
    save(tmp_path / "whole")
    content, late = (tmp_path / "whole.npy").read_bytes(), tmp_path / "a.npy"
    half = (1, lambda: late.write_bytes(content[:300]))
    rest = (1 + RETRY_AFTER / 2, lambda: late.write_bytes(content))
    found = watched(tmp_path, Script(3 * RETRY_AFTER, half, rest))
    assert [(name, n) for _, name, n in found] == [("a.npy", 27)]


def test_a_cloud_of_a_file_that_changed_while_it_was_read_does_not_count(tmp_path):
    def read(path):
        cloud = read_cloud(path)
        if len(cloud.points) == 9:
            save(Path(path), 18)
        return cloud

    found = watched(tmp_path, Script(5, (1, lambda: save(tmp_path / "a.npy", 9))), read)
    assert [n for *_, n in found] == [18]


def test_what_stays_unreadable_is_given_up_once(tmp_path):
    found = watched(tmp_path, Script(4 * RETRY_AFTER, (1, lambda: (tmp_path / "a.pcd").write_text("no cloud"))))
    assert [name for _, name, _ in found] == ["a.pcd"]
    at, _, error = found[0]
    assert 1 + RETRY_AFTER <= at <= 1 + RETRY_AFTER + 3 * LOOK_EVERY
    assert "a.pcd" in str(error)


def test_a_file_that_goes_away_is_forgotten(tmp_path):
    deeds = ((1, lambda: save(tmp_path / "a.npy")), (1.2, lambda: (tmp_path / "a.npy").unlink()))
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
            new_clouds(tmp_path / name, read_cloud, Script(1))  # pyright: ignore[reportArgumentType]


def test_a_folder_that_goes_away_ends_the_watch(tmp_path):
    folder = tmp_path / "clouds"
    folder.mkdir()
    with pytest.raises(InputError, match="watch must name a folder"):
        watched(folder, Script(5, (1, folder.rmdir)))
