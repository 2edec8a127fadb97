"""`lifelore perceive` as a person meets it: tables, one JSON document, and one line for whatever is wrong."""

import json

import numpy as np
import pytest

CUBE = np.stack(np.meshgrid(*[np.arange(0, 0.06, 0.004)] * 3, indexing="ij"), axis=-1).reshape(-1, 3)


@pytest.fixture
def cloud(tmp_path):
    """``cloud(points, labels=None)`` writes an npz and names it."""

    def write(points, labels=None):
        path = tmp_path / "cloud.npz"
        named = {} if labels is None else {"labels": np.asarray(labels)}
        np.savez(path, points=np.asarray(points, float), **named)
        return path

    return write


def two_cubes(shift):
    return np.concatenate([CUBE, CUBE + shift]), np.repeat([2, 3], len(CUBE))


def test_one_cube_on_another_as_json(ask, cloud):
    answer = ask("perceive", cloud(*two_cubes([0, 0, 0.06])), "--up", "z", "--json")
    assert answer.status == 0
    found = {(r["relation"], r["a"], r["b"]) for r in answer.document["relations"]}
    assert ("on", 3, 2) in found
    assert {"objects", "relations", "facts", "holes", "seconds"} <= set(answer.document)


def test_a_person_sees_a_table_and_what_was_written(ask, cloud, tmp_path):
    answer = ask("perceive", cloud(*two_cubes([0, 0, 0.06])), "--up", "0,0,1", "--dot", tmp_path / "s.dot")
    assert answer.status == 0
    assert "2 objects" in answer.out
    assert "written:" in answer.out
    assert (tmp_path / "s.dot").is_file()


@pytest.mark.parametrize(
    ("points", "labels", "objects"),
    [
        (CUBE, np.full(len(CUBE), 2), 1),  # one object
        (*two_cubes([0.02, 0.01, 0.01]), 2),  # interpenetrating
        (*two_cubes([0, 0, 0]), 2),  # the same points twice
        (np.zeros((500, 3)), np.repeat([2, 3], 250), 2),  # all in one place
        (np.concatenate([CUBE, [[np.nan] * 3]]), np.append(np.full(len(CUBE), 2), 3), 1),
    ],
)
def test_odd_scenes_are_answered(ask, cloud, points, labels, objects):
    answer = ask("perceive", cloud(points, labels), "--up", "z", "--json")
    assert answer.status == 0, answer.err
    assert len(answer.document["objects"]) == objects
    json.dumps(answer.document, allow_nan=False)


BAD_CLOUDS = {
    "empty": (np.empty((0, 3)), None, "point"),
    "all NaN": (np.full((100, 3), np.nan), None, "no finite point"),
    "millimetres": (CUBE * 1000 * 10, np.full(len(CUBE), 2), "units"),
    "three columns too few": (np.zeros((10, 2)), None, "points"),
}


@pytest.mark.parametrize("case", BAD_CLOUDS)
def test_bad_clouds_are_one_line(ask, cloud, case):
    points, labels, word = BAD_CLOUDS[case]
    assert word in ask("perceive", cloud(points, labels)).refusal


@pytest.mark.parametrize(
    ("options", "word"),
    [
        (["--up", "1,2"], "up must be"),
        (["--up", "a,b,c"], "X,Y,Z"),
        (["--up", "0,0,0"], "up must be"),
        (["--up", "sideways"], "up must be"),
        (["--units", "inch"], "units"),
        (["--labels", "odd"], "labels"),
        (["--segment", "magic"], "method must be"),
        (["--model", "nobody", "--memory", "m.db"], "no relation model 'nobody'"),
        (["--model", "missing.npz"], "missing.npz"),
        (["--plot", "no/such/folder.png"], "folder"),
        (["--pddl", ""], "must be a file"),
    ],
)
def test_bad_options_are_one_line(ask, cloud, options, word):
    assert word in ask("perceive", cloud(CUBE, np.full(len(CUBE), 2)), *options).refusal


@pytest.mark.parametrize("name", ["missing.pcd", ".", "", "text.txt"])
def test_what_is_no_cloud_is_one_line(ask, tmp_path, name):
    (tmp_path / "text.txt").write_text("no cloud at all")
    assert ask("perceive", name).refusal


def test_a_cloud_cut_short_is_one_line(ask, cloud):
    path = cloud(*two_cubes([0, 0, 0.06]))
    path.write_bytes(path.read_bytes()[:1000])
    assert "cloud.npz" in ask("perceive", path).refusal
