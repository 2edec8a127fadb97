"""`lifelore perceive` as a person meets it: tables, one JSON document, and one line for whatever is wrong."""

import contextlib
import json
import os
import pty
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

PROGRAM = Path(sys.executable).with_name("lifelore")
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
        (["--segment", "clusters"], "cuts a cloud without labels"),
        (["--segment", "colour", "--colours", "1"], "colours must be at least 2"),
        (["--colours", "3"], "colours belongs to --segment colour"),
        (["--segment", "clusters", "--colours", "3"], "colours belongs to --segment colour"),
        (["--topic", "/camera"], "is none: leave them out"),
        (["--index", "0"], "is none: leave them out"),
        (["--memory", "m.db"], "none is named: leave memory out"),
        (["--model", "mine.npz", "--memory", "m.db"], "mine.npz is a file: leave memory out"),
        (["--model", "nobody"], "no relation model 'nobody': there is no memory at"),
        (["--model", "nobody", "--memory", "no/m.db"], "no relation model 'nobody': there is no memory at"),
        (["--model", "nobody", "--memory", "m" * 300], "there is no memory at"),
        (["--plot", "scene.svg"], "plot must name a PNG file"),
        (["--plot", "p" * 300 + ".png"], "cannot write"),
        (["--dot", "a.png", "--plot", "a.png"], "'a.png' would be written over"),
        (["--pddl", "a.pddl", "--dot", "a-domain.pddl"], "'a-domain.pddl' would be written over"),
        (["--dot", "cloud.npz"], "'cloud.npz' would be written over"),
        (["--model", "missing.npz"], "missing.npz"),
        (["--plot", "no/such/folder.png"], "folder"),
        (["--pddl", ""], "must be a file"),
    ],
)
def test_bad_options_are_one_line(ask, cloud, tmp_path, options, word):
    path = cloud(CUBE, np.full(len(CUBE), 2))
    assert word in ask("perceive", path, "--up", "z", *options).refusal
    assert list(tmp_path.iterdir()) == [path]


@pytest.mark.parametrize("camera", [[np.nan] * 3, [0, 0, np.inf], [0, 0, 1e200], [1, 2]])
def test_a_camera_that_cannot_be_is_one_line(ask, tmp_path, camera):
    points, labels = two_cubes([0, 0, 0.06])
    np.savez(tmp_path / "c.npz", points=points, labels=labels, camera=camera)
    assert "camera must" in ask("perceive", tmp_path / "c.npz", "--up", "z").refusal


def test_a_guess_of_parts_is_one_line_beside_the_document(ask, cloud):
    points, labels = two_cubes([0, 0, 0.06])
    path = cloud(points, 10 * labels)
    guessed = ask("perceive", path, "--up", "z", "--json")
    assert [entry["id"] for entry in guessed.document["objects"]] == [2, 3]
    assert guessed.err.startswith("lifelore: the labels were taken as parts of objects")
    assert guessed.err.count("\n") == 1
    plain = ask("perceive", path, "--up", "z", "--json", "--labels", "plain")
    assert [entry["id"] for entry in plain.document["objects"]] == [20, 30]
    assert plain.err == ""


def test_on_a_terminal_stages_are_shown_and_stdout_stays_pure(start, cloud, tmp_path):
    outer, inner = pty.openpty()
    command = ("perceive", cloud(*two_cubes([0, 0, 0.06])), "--up", "z", "--json")
    with open(tmp_path / "out.json", "wb") as out:
        process = start(*command, stdout=out, stderr=inner, env={**os.environ, "TERM": "xterm", "COLUMNS": "120"})
    os.close(inner)
    shown = b""
    with contextlib.suppress(OSError):  # Linux says so that nobody writes to the terminal any more
        while part := os.read(outer, 65536):
            shown += part
    os.close(outer)
    assert process.wait() == 0
    assert "objects" in json.loads((tmp_path / "out.json").read_text("utf-8"))
    assert b"perceiving: " in shown


LARGE = """
import resource, subprocess, sys
subprocess.run(sys.argv[1:], check=True)
print(resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss)
"""


def large_cloud(path, n: int) -> None:
    """Two blocks, one on the other, on a table; `n` points in all, float32."""
    rng = np.random.default_rng(0)
    points, labels = rng.random((n, 3), np.float32), np.repeat([1, 2, 3, 1], [n // 4] * 3 + [n - 3 * (n // 4)])
    points *= np.array([0.1, 0.1, 0.05], np.float32)
    points[labels == 3, 2] += 0.05
    points[labels == 1] = (points[labels == 1] - 0.05) * np.array([8, 8, 0.0], np.float32)
    np.savez(path, points=points, labels=labels.astype(np.uint8))


def kilobytes_to_perceive(path, *options) -> tuple[list[str], int]:
    """Its objects, and the most memory it held; asked by a small process, whose children are this one alone."""
    command = [sys.executable, "-c", LARGE, str(PROGRAM), "perceive", str(path), "--json", *options]
    out = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    *document, kilobytes = out.splitlines()
    found = json.loads("\n".join(document))["relations"]
    return [f"{r['relation']}({r['a']}, {r['b']})" for r in found], int(kilobytes)


@pytest.mark.soak
def test_ten_million_points_in_bounded_memory(tmp_path):
    large_cloud(tmp_path / "large.npz", 10**7)
    relations, kilobytes = kilobytes_to_perceive(tmp_path / "large.npz")
    assert "on(3, 2)" in relations
    assert kilobytes < 2 * 2**20


@pytest.mark.parametrize("name", ["missing.pcd", ".", "", "text.txt"])
def test_what_is_no_cloud_is_one_line(ask, tmp_path, name):
    (tmp_path / "text.txt").write_text("no cloud at all")
    assert ask("perceive", name).refusal


def test_a_cloud_cut_short_is_one_line(ask, cloud):
    path = cloud(*two_cubes([0, 0, 0.06]))
    path.write_bytes(path.read_bytes()[:1000])
    assert "cloud.npz" in ask("perceive", path).refusal
