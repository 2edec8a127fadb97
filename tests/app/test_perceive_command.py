"""`lifelore perceive` as a person meets it: tables, one JSON document, and one line for whatever is wrong."""

import json
import shutil
import signal
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

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


def test_rare_settings_are_listed(ask):
    keys = [row["key"] for row in ask("perceive", "--settings", "--json").document["settings"]]
    assert keys == ["segment", "colours", "index", "depth_scale", "table_mask", "masks_out", "with_masks"]


def two_cubes(shift):
    return np.concatenate([CUBE, CUBE + shift]), np.repeat([2, 3], len(CUBE))


def test_one_cube_on_another_as_json(ask, cloud):
    answer = ask("perceive", cloud(*two_cubes([0, 0, 0.06])), "--up", "z", "--json")
    assert answer.status == 0
    found = {(r["relation"], r["a"], r["b"]) for r in answer.document["relations"]}
    assert ("on", 3, 2) in found
    assert {"objects", "relations", "facts", "holes", "warnings", "seconds"} <= set(answer.document)


def test_objects_have_their_pixels_in_a_label_image_and_in_json(ask, tmp_path):
    """A wall of two blocks, seen straight from above as an image of 40 × 60 pixels."""
    heights = np.zeros((40, 60))
    labels = np.ones((40, 60), int)
    for number, columns, height in ((2, slice(10, 25), 0.05), (3, slice(25, 50), 0.08)):
        heights[10:30, columns], labels[10:30, columns] = height, number
    rows, columns = np.indices(heights.shape)
    points = np.stack([0.004 * columns, -0.004 * rows, heights], axis=-1)
    points[0, :5] = np.nan
    np.savez(tmp_path / "wall.npz", points=points, labels=labels, camera=[0.1, -0.1, 1.0])
    image = tmp_path / "numbers.png"
    rare = ("--set", f"masks_out={image}", "--set", "with_masks=true")
    answer = ask("perceive", tmp_path / "wall.npz", "--up", "z", *rare, "--json")
    assert answer.status == 0
    with Image.open(image) as opened:
        assert opened.mode.startswith("I;16")
        assert (np.asarray(opened) == np.where(np.isnan(points[..., 0]), 0, labels)).all()
    first, second = answer.document["objects"]
    # From column 10 on: 10 pixels above, 20 of the block, 10 below and 10 above the next.
    assert first["mask"] == {"size": [40, 60], "counts": [410, *[20] * 29, 1410]}
    assert sum(second["mask"]["counts"][1::2]) == second["n_points"] == 20 * 25


def test_a_scene_is_logged_for_each_cloud(ask, cloud, tmp_path):
    answer = ask("perceive", cloud(*two_cubes([0, 0, 0.06])), "--up", "z", "--log", tmp_path / "{name}-log.mcap")
    assert answer.status == 0
    assert (tmp_path / "cloud-log.mcap").read_bytes().startswith(b"\x89MCAP0")
    assert "cloud-log.mcap" in answer.out


def test_a_cloud_without_an_image_has_no_label_image(ask, cloud, tmp_path):
    options = ("perceive", cloud(*two_cubes([0, 0, 0.06])), "--up", "z")
    refused = ask(*options, "--set", f"masks_out={tmp_path / 'numbers.png'}", "--dot", tmp_path / "s.dot")
    assert refused.status == 2
    assert "is not organised" in refused.err
    assert "with_masks=true" in refused.err
    assert not (tmp_path / "s.dot").exists()
    answer = ask(*options, "--set", "with_masks=true", "--json")
    assert answer.document["objects"][1]["points"] == list(range(len(CUBE), 2 * len(CUBE)))


def test_a_goal_and_a_least_confidence(ask, cloud, tmp_path):
    problem = tmp_path / "s.pddl"
    options = ("perceive", cloud(*two_cubes([0, 0, 0.06])), "--up", "z", "--json", "--pddl", problem)
    assert ask(*options, "--goal", "on(o2, o3) and not on(o3, table)").status == 0
    assert "(:goal (and (on o2 o3) (not (on-table o3))))" in problem.read_text()
    answer = ask(*options, "--min-confidence", "1")
    doubtful = [r for r in answer.document["relations"] if r["relation"] == "on" and not r["stated"]]
    assert {(r["a"], r["b"]) for r in doubtful} >= {(3, 2)}
    assert "on(3, 2)" in [one["fact"] for one in answer.document["unknown"]]
    assert "(on o3 o2)" not in problem.read_text().split(":init")[1]
    assert "(may-cover o3 o2)" in problem.read_text()


@pytest.mark.planning
def test_a_goal_is_planned_for_with_places(ask, cloud):
    options = ("perceive", cloud(*two_cubes([0, 0, 0.06])), "--up", "z", "--goal", "holding(o2)", "--plan")
    document = ask(*options, "--json").document
    plan, centroids = document["plan"], {one["id"]: one["centroid"] for one in document["objects"]}
    first, last = plan["steps"][0], plan["steps"][-1]
    assert (plan["reason"], len(plan["steps"])) == (None, 3)
    assert (first["action"], first["objects"][0]["id"]) == ("pick-up", 3)
    assert (last["action"], last["objects"][0]["id"]) == ("pick-up", 2)
    assert first["objects"][0]["centroid"] == centroids[3]
    assert [one["moved"] for step in plan["steps"][:2] for one in step["objects"][:1]] == [False, True]
    assert 0 < plan["confidence"] <= first["confidence"] <= 1
    shown = ask(*options).out
    assert "1. pick-up 3 at (0.028, 0.028, " in shown
    assert "3. pick-up 2 at " in shown


@pytest.mark.planning
def test_no_plan_is_a_result_with_its_reason(ask, cloud):
    path = cloud(*two_cubes([0, 0, 0.06]))
    answer = ask("perceive", path, "--up", "z", "--goal", "on(o2, o3) and on(o3, o2)", "--plan", "--json")
    assert answer.status == 0
    assert (answer.document["plan"]["steps"], answer.document["plan"]["confidence"]) == ([], None)
    assert "no order of picking up and putting down" in answer.document["plan"]["reason"]
    held = ask("perceive", path, "--up", "z", "--goal", "on(o3, o2)", "--plan")
    assert "the goal holds already" in held.out
    assert (
        "objects of the scene (o2, o3), got 'o7'"
        in ask("perceive", path, "--up", "z", "--goal", "clear(o7)", "--plan").refusal
    )


def test_without_the_extra_a_plan_is_refused_in_one_line(ask, cloud, monkeypatch):
    monkeypatch.setitem(sys.modules, "unified_planning", None)
    options = ("--up", "z", "--goal", "clear(o2)", "--plan")
    assert "pip install 'lifelore[planning]'" in ask("perceive", cloud(CUBE), *options).refusal


def visible(points, labels, camera):
    """The points that no other point hides by more than 2 cm, in cells of 12 mrad, and their labels."""
    rays = points - camera
    ranges = np.linalg.norm(rays, axis=1)
    _, cells = np.unique(np.floor(rays / ranges[:, None] / 0.012), axis=0, return_inverse=True)
    nearest = np.full(cells.max() + 1, np.inf)
    np.minimum.at(nearest, cells.reshape(-1), ranges)
    free = ranges < nearest[cells.reshape(-1)] + 0.02
    return points[free], labels[free]


@pytest.fixture
def hidden_top(tmp_path):
    """A tall block, 3, hides the middle of a low one, 2."""
    low = np.concatenate([CUBE + np.array([x, 0.12, 0]) for x in (-0.05, 0.05)])
    tall = np.concatenate([CUBE + np.array([0, 0, 0.06 * floor]) for floor in range(3)])
    camera = np.array([0.03, -0.8, 0.3])
    points, labels = visible(np.concatenate([low, tall]), np.repeat([2, 3], [len(low), len(tall)]), camera)
    np.savez(tmp_path / "c.npz", points=points, labels=labels, camera=camera)
    return tmp_path / "c.npz"


def test_a_hidden_top_is_named_beside_the_planning_problem(ask, hidden_top, tmp_path):
    options = ("perceive", hidden_top, "--up", "z", "--pddl", tmp_path / "p.pddl")
    shown = ask(*options, "--goal", "holding(o2)").out
    assert "unknown, since other objects hide a part of the top: clear(2)" in shown
    assert "no plan" not in shown
    assert "(may-cover o3 o2)" in (tmp_path / "p.pddl").read_text()


@pytest.mark.planning
def test_a_plan_takes_away_what_hides_a_top_and_looks(ask, hidden_top):
    options = ("perceive", hidden_top, "--up", "z", "--goal", "holding(o2)", "--plan")
    steps = ask(*options, "--json").document["plan"]["steps"]
    assert [(step["objects"][0]["id"], step["look"]) for step in steps] == [(3, []), (3, []), (2, [2])]
    (line,) = [line for line in ask(*options).out.splitlines() if "look first" in line]
    assert line.startswith("3. pick-up 2 at ")
    assert line.endswith("; look first whether anything rests on 2")


def test_objects_that_may_rest_on_each_other_are_a_reason_for_no_plan(ask, cloud, tmp_path):
    options = ("perceive", cloud(*two_cubes([0.07, 0, 0])), "--up", "z", "--pddl", tmp_path / "p.pddl")
    sure = ask(*options, "--goal", "holding(o2)").out
    assert "no plan" not in sure
    doubtful = ask(*options, "--goal", "holding(o2)", "--min-confidence", "1").out
    assert (
        "warning: no plan reaches the goal: o2 may rest on o3, and o2 cannot be taken away before o3" in doubtful
    )


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


@pytest.mark.parametrize(
    ("options", "word"),
    [
        (["--up", "sideways"], "up must be"),
        (["--units", "feet"], "units must be m, cm, mm or inch"),
        (["--labels", "odd"], "labels"),
        (["--set", "segment=magic"], "method must be"),
        (["--set", "segment=clusters"], "needs a cloud without labels"),
        (["--set", "segment=colour", "--set", "colours=1"], "colours must be at least 2"),
        (["--set", "colours=3"], "colours belongs to segment=colour"),
        (["--topic", "/camera"], "is no rosbag: leave them out"),
        (["--set", "index=0"], "is no rosbag: leave them out"),
        (["--memory", "m.db"], "no model is named: leave memory out"),
        (["--model", "mine.npz", "--memory", "m.db"], "mine.npz is a file: leave memory out"),
        (["--model", "nobody"], "no relation model 'nobody': there is no memory at"),
        (["--plot", "scene.svg"], "plot must name a PNG file"),
        (["--log", "scene.bag"], "log must name a file that ends with .mcap or .rrd"),
        (["--set", "masks_out=numbers.jpg"], "masks_out must name a PNG file"),
        (["--dot", "cloud.npz"], "'cloud.npz' would be overwritten"),
        (["--pddl", ""], "must be a file"),
        (["--goal", "clear(o2)"], "goal needs a plan (--plan), or a planning problem"),
        (["--pddl", "s.pddl", "--plan"], "plan (--plan) needs a goal"),
        (["--pddl", "s.pddl", "--goal", "clear o2"], "goal must be statements, got 'clear o2'"),
        (["--pddl", "s.pddl", "--goal", "on(o2, o7)"], "objects of the scene (o2), got 'o7'"),
        (["--min-confidence", "1.5"], "min_confidence must be a probability from 0 to 1, got 1.5"),
    ],
)
def test_bad_options_are_one_line(ask, cloud, tmp_path, options, word):
    path = cloud(CUBE, np.full(len(CUBE), 2))
    assert word in ask("perceive", path, "--up", "z", *options).refusal
    assert list(tmp_path.iterdir()) == [path]


def test_a_guess_of_parts_is_one_line_beside_the_document(ask, cloud):
    points, labels = two_cubes([0, 0, 0.06])
    path = cloud(points, 10 * labels)
    guessed = ask("perceive", path, "--up", "z", "--json")
    assert [entry["id"] for entry in guessed.document["objects"]] == [2, 3]
    assert guessed.err.startswith("lifelore: the labels were taken as parts of objects")
    assert guessed.err.count("\n") == 1


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


@pytest.fixture
def three(tmp_path) -> list[Path]:
    """A cube on another, a cube alone, and no cloud at all."""
    points, labels = two_cubes([0, 0, 0.06])
    np.savez(tmp_path / "pair.npz", points=points, labels=labels)
    np.savez(tmp_path / "alone.npz", points=CUBE, labels=np.full(len(CUBE), 2))
    (tmp_path / "bad.npz").write_bytes(b"PK\x03\x04 and no more")
    return [tmp_path / f"{name}.npz" for name in ("pair", "bad", "alone")]


def test_a_bad_cloud_among_many_is_one_line_and_the_others_go_on(ask, three):
    answer = ask("perceive", *three, "--up", "z", "--json")
    assert answer.status == 2
    assert answer.err.startswith(f"lifelore: {three[1]}: is damaged")
    assert answer.err.count("\n") == 1
    assert [scene["source"] for scene in answer.document["scenes"]] == [str(three[0]), str(three[2])]
    assert [failed["source"] for failed in answer.document["failed"]] == [str(three[1])]


def test_several_clouds_for_a_person_and_their_files(ask, three, tmp_path):
    answer = ask("perceive", three[0], three[2], "--up", "z", "--dot", tmp_path / "{name}.dot")
    assert answer.status == 0
    assert f"{three[0]}:" in answer.out
    assert "2 objects" in answer.out
    assert "1 object," in answer.out
    assert f"written: {tmp_path / 'alone.dot'}" in answer.out
    assert (tmp_path / "pair.dot").is_file()


@pytest.mark.parametrize(
    ("arguments", "word"),
    [
        ([], "give one or more clouds"),
        (["pair.npz", "--watch", "."], "leave the clouds out"),
        (["--watch", "no"], "watch must name a folder"),
        (["--watch", ".", "--set", "index=0"], "is no rosbag: leave them out"),
        (["--watch", ".", "--plot", "a.png"], "plot names one file for many clouds"),
        (["--watch", ".", "--register"], "leave --poses and --register out"),
        (["pair.npz", "alone.npz", "--register", "--poses", "p.json"], "leave one of them out"),
        (["pair.npz", "--register"], "joins two or more clouds, got 1"),
        (["pair.npz", "alone.npz", "--plot", "a.png"], "plot names one file for many clouds"),
        (["pair.npz", "sub/pair.npz", "--dot", "{name}.dot"], "rename clouds of one name"),
    ],
)
@pytest.mark.usefixtures("three")
def test_what_is_ambiguous_is_one_line(ask, arguments, word):
    assert word in ask("perceive", *arguments).refusal


def test_ctrl_c_among_several_keeps_what_is_finished(start, answer, three):
    child = start("perceive", *[three[0]] * 2000, three[1], "--up", "z", "--dot", "no.dot")
    assert answer(child).status == 2
    child = start("perceive", *[three[1]] * 3, *[three[0]] * 2000, "--up", "z", "--json")
    assert "is damaged" in child.stderr.readline()
    child.send_signal(signal.SIGINT)
    said = answer(child)
    assert said.status == 130
    assert "stopping: " in said.err
    assert len(said.document["scenes"]) < 2000
    assert 1 <= len(said.document["failed"]) <= 3


def test_a_folder_is_watched_until_ctrl_c(start, answer, three, tmp_path):
    folder = tmp_path / "in"
    folder.mkdir()
    shutil.copy(three[0], folder / "old.npz")
    child = start("perceive", "--watch", folder, "--up", "z", "--json")
    assert child.stderr.readline() == f"lifelore: watching {folder} for new clouds; Ctrl-C stops\n"
    shutil.copy(three[2], folder / "new.npz")
    entry = json.loads(child.stdout.readline())
    assert entry["source"] == str(folder / "new.npz")
    assert [thing["id"] for thing in entry["objects"]] == [2]
    shutil.copy(three[0], folder / "old.npz")
    assert json.loads(child.stdout.readline())["source"] == str(folder / "old.npz")
    child.send_signal(signal.SIGINT)
    said = answer(child)
    assert (said.status, said.out) == (130, "")
    assert said.err.startswith("stopping: ")


@pytest.mark.parametrize(
    ("option", "objects"),
    [("--roi=-1,1,-1,1,-1,0.055", [2]), ("--roi=-1,inf,-1,1,-1,1", [2, 3]), ("--max-range=0.1", [2])],
)
def test_a_box_and_a_range_crop_the_cloud(ask, cloud, option, objects):
    answer = ask("perceive", cloud(*two_cubes([0, 0, 0.2])), "--up", "z", option, "--json")
    assert [entry["id"] for entry in answer.document["objects"]] == objects


def test_warnings_are_printed_and_stand_in_the_document(ask, cloud):
    path = cloud(CUBE)
    document = ask("perceive", path, "--up", "z", "--json").document
    codes = [warning["code"] for warning in document["warnings"]]
    assert codes == ["units", "up_not_level", "no_table", "automatic_objects"]
    shown = ask("perceive", path, "--up", "z").out
    assert all(f"warning: {warning['message']}" in shown for warning in document["warnings"])


def test_a_cloud_without_a_table_is_one_line(ask, cloud):
    line = ask("perceive", cloud(CUBE)).refusal
    assert "no table was found" in line
    assert "--up X,Y,Z" in line
