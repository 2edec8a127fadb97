"""`lifelore learn-relations` on two clouds of points: what it prints, what it refuses."""

import json

import numpy as np
import pytest


@pytest.fixture
def folder(tmp_path):
    rng = np.random.default_rng(0)
    for name, lift in (("on", 0.05), ("off", 0.3)):
        below, above = rng.random((400, 3)) * 0.05, rng.random((400, 3)) * 0.05 + [0, 0, lift]
        table = rng.random((900, 3)) * [0.4, 0.4, 0.0] - [0.1, 0.1, 0.0]
        np.savez(
            tmp_path / f"{name}.npz",
            points=np.vstack([below, above, table]),
            labels=np.repeat([2, 3, 1], [400, 400, 900]),
        )
    (tmp_path / "truth.csv").write_text(
        "scene,a,b,relation,confidence\non,3,2,on,3\non,2,1,on,3\noff,2,1,on,3\noff,3,1,none,3\n"
    )
    return tmp_path


def test_it_learns_and_says_what_and_where(ask, folder):
    options = ("learn-relations", folder, "--truth", folder / "truth.csv", "--memory", folder / "m.db")
    answer = ask(*options, "--name", "kitchen", "--json")
    assert answer.status == 0
    report = json.loads(answer.out)
    assert report["name"] == "kitchen"
    assert report["pairs"] == {"none": 1, "on": 3}
    told = ask(*options, "--out", folder / "m.npz")
    assert "2 scenes" in told.out
    assert str(folder / "m.npz") in told.out


def test_mistakes_are_one_line(ask, folder):
    for options in (("--truth", folder / "none.csv"), ("--truth", folder / "truth.csv", "--method", "magic")):
        answer = ask("learn-relations", folder, *options, "--memory", folder / "m.db")
        assert answer.status == 2
        assert answer.err.count("\n") == 1
