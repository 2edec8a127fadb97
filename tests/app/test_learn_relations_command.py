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
        "scene,a,b,relation,confidence\non,3,2,on,3\non,2,1,on,3\noff,2,1,on,3\noff,3,1,none,3\noff,3,2,apart,2\n"
    )
    return tmp_path


def test_it_learns_and_says_what_and_where(ask, folder):
    options = ("learn-relations", folder, "--truth", folder / "truth.csv", "--memory", folder / "m.db")
    answer = ask(*options, "--name", "kitchen", "--json")
    assert answer.status == 0
    report = json.loads(answer.out)
    assert report["name"] == "kitchen"
    assert report["pairs"] == {"none": 1, "on": 3}
    assert report["not_near"] == {"apart": 1}
    told = ask(*options, "--out", folder / "m.npz")
    assert "2 scenes" in told.out
    assert "1 labels are of objects too far apart" in told.out
    assert str(folder / "m.npz") in told.out


def test_labels_units_and_up_as_perceive_has_them(ask, folder):
    for path in folder.glob("*.npz"):
        with np.load(path) as held:
            labels, points = held["labels"], held["points"]
        np.savez(path, points=1000 * points[:, [2, 0, 1]], labels=np.where(labels > 1, 10 * labels, labels))
    options = ("learn-relations", folder, "--truth", folder / "truth.csv", "--out", folder / "m.npz")
    answer = ask(*options, "--units", "mm", "--up", "1,0,0", "--json")
    assert answer.status == 0
    assert answer.document["scenes"] == 2
    assert "the labels of 2 of 2 clouds were taken as parts" in answer.err
    one_word = ask(*options, "--units", "mm", "--up", "1,0,0", "--labels", "parts").err
    assert one_word.startswith("lifelore: every labelled pair of objects is 'on'")
    assert (answer.err.count("\n"), one_word.count("\n")) == (2, 1)
    assert "units" in ask(*options).refusal
    assert "names an object" in ask(*options, "--units", "mm", "--labels", "plain").refusal
    assert "X,Y,Z" in ask(*options, "--units", "mm", "--up", "1,0,x").refusal


def test_mistakes_are_one_line(ask, folder):
    truth = ("--truth", folder / "truth.csv")
    for options in (
        ("--truth", folder / "none.csv"),
        (*truth, "--method", "magic"),
        (*truth, "--out", folder / "m.foo"),
        (*truth, "--name", "m.npz"),
        (*truth, "--labels", "odd"),
        (*truth, "--units", "feet"),
        (*truth, "--up", "down"),
    ):
        answer = ask("learn-relations", folder, *options, "--memory", folder / "m.db")
        assert answer.status == 2
        assert answer.err.count("\n") == 1


def test_words_of_a_user_are_added_to_the_core(ask, folder):
    """A model of *carries* and *clear of* gives these words beside on(3, 2), and a planning problem with both."""
    rows = [f"{scene},{label},3" for scene in ("on", "off") for label in ("2,3,carries", "2,1,clear of")]
    (folder / "words.csv").write_text("scene,a,b,relation,confidence\n" + "\n".join(rows) + "\n")
    learn = ("learn-relations", folder, "--truth", folder / "words.csv", "--out", folder / "m.npz")
    assert "(carries, clear of), got nothing" in ask(*learn, "--symmetric", "nothing").refusal
    told = ask(*learn, "--symmetric", "clear of")
    assert "words with a direction: carries; symmetric: clear of" in told.out
    assert "from the shipped model" in told.out
    look = ("perceive", folder / "on.npz", "--model", folder / "m.npz", "--json", "--pddl", folder / "s.pddl")
    answer = ask(*look, "--goal", "carries(o3, o2)")
    stated = {(r["relation"], r["a"], r["b"]) for r in answer.document["relations"]}
    assert {("on", 3, 2), ("carries", 2, 3), ("clear of", 2, "table")} <= stated
    assert {"carries(2, 3)", "clear(3)"} <= set(answer.document["facts"])
    problem, domain = ((folder / name).read_text() for name in ("s.pddl", "s-domain.pddl"))
    assert "(carries o2 o3)" in problem
    assert "(carries o3 o2)" not in problem.split("(:goal")[0]
    assert "(clear_of-table o2)" in problem
    assert "(on o3 o2)" in problem
    assert "(carries ?a ?b - thing)" in domain


@pytest.mark.slow
def test_lessons_of_two_robots_are_learnt_together_and_perceive_says_when_they_were_not(ask, folder):
    (folder / "one.csv").write_text("scene,a,b,relation,confidence\non,3,2,on,3\non,2,1,on,3\n")
    (folder / "two.csv").write_text("scene,a,b,relation,confidence\noff,2,1,on,3\noff,3,1,none,3\n")
    for robot, truth in (("karl", "one"), ("rosie", "two")):
        assert (
            ask("learn-relations", folder, "--truth", folder / f"{truth}.csv", "--memory", folder / robot).status
            == 0
        )
    assert ask("memory", "merge", folder / "rosie", "--memory", folder / "karl").status == 0
    look = "perceive", folder / "on.npz", "--model", "default", "--memory", folder / "karl", "--up", "z"
    told = ask(*look).err
    assert "the model 'default' has not learnt from 1 of the labelled scenes in memory yet" in told
    assert f"learn-relations --name default --memory {folder / 'karl'}" in told
    assert "2 scenes, 2 of them remembered" in ask("learn-relations", "--memory", folder / "karl").out
    assert "has not learnt from" not in ask(*look).err
