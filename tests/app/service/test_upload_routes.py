"""Perception and memory over HTTP: as the functions themselves, and no upload stops or crashes the service."""

import base64
import io
import json
import random
import sqlite3
import struct

import numpy as np
import pytest
from PIL import Image

from lifelore.agent.perceive.perceive import perceive
from lifelore.core import Record
from lifelore.memory import open_memory

FILE = {"Content-Type": "application/octet-stream"}
SQUARE = np.stack(np.meshgrid(np.arange(40), np.arange(40)), -1).reshape(-1, 2)


def box(low, size, label):
    """Points on the top and the four sides of a box, 2.5 mm apart, (n, 4)."""
    plane = SQUARE / 39
    faces = [np.column_stack([plane, np.ones(len(plane))])]
    for axis in (0, 1):
        for side in (0.0, 1.0):
            face = np.empty((len(plane), 3))
            face[:, axis], face[:, 1 - axis], face[:, 2] = side, plane[:, 0], plane[:, 1]
            faces.append(face)
    points = np.concatenate(faces) * size + low
    return np.column_stack([points, np.full(len(points), label)])


@pytest.fixture(scope="module")
def cloud():
    """A box on a box on a table, labelled, as the bytes of an npy file."""
    table = np.column_stack([SQUARE * 0.02 - 0.4, np.zeros(len(SQUARE)), np.ones(len(SQUARE))])
    scene = np.concatenate([table, box([0, 0, 0], [0.1, 0.1, 0.1], 2), box([0.01, 0, 0.1], [0.08, 0.08, 0.06], 3)])
    file = io.BytesIO()
    np.save(file, scene)
    return file.getvalue()


def ask(client, content, **options):
    return client.post(
        "/v1/perceive/cloud", content=content, params={"up": "z"} | options,
        headers=FILE,
    )  # fmt: skip


def test_a_cloud_becomes_a_scene_with_pddl(shared, cloud, tmp_path):
    answer = ask(shared, cloud, format="npy")
    assert answer.status_code == 200, answer.text
    document = answer.json()
    (tmp_path / "cloud.npy").write_bytes(cloud)
    from lifelore.agent.perceive.perceive import PerceiveSettings

    own = perceive(str(tmp_path / "cloud.npy"), PerceiveSettings(up="z"))
    masked = ask(shared, cloud, format="npy", with_masks=True).json()
    assert all(len(one["points"]) == one["n_points"] for one in masked["objects"])
    for key in own.keys() - {"seconds", "source"}:
        assert document[key] == own[key], key
    assert "(define (problem" in document["pddl"]["problem"]
    assert "(define (domain" in document["pddl"]["domain"]
    assert document["dot"].startswith("digraph")


@pytest.mark.planning
def test_a_goal_is_planned_for(shared, cloud):
    plan = ask(shared, cloud, format="npy", goal="holding(o2)", plan=True).json()["plan"]
    named = [(step["action"], step["objects"][0]["id"]) for step in plan["steps"]]
    assert (named[0], named[-1], len(named)) == (("pick-up", 3), ("pick-up", 2), 3)
    assert plan["reason"] is None
    refused = ask(shared, cloud, format="npy", plan=True)
    assert refused.status_code == 422
    assert "plan (--plan) needs a goal" in refused.text


def test_up_is_a_direction(shared, cloud):
    stated = {
        up: {(r["relation"], r["a"], r["b"]) for r in ask(shared, cloud, format="npy", up=up).json()["relations"]}
        for up in ("z", "0,0,2")
    }
    assert stated["z"] == stated["0,0,2"] >= {("on", 3, 2)}
    for wrong in ("0,0", "a,b,c", "sideways"):
        refused = ask(shared, cloud, format="npy", up=wrong)
        assert refused.status_code == 422
        assert "up must be" in refused.text


def test_a_region_is_cut_out(shared, cloud):
    (only,) = ask(shared, cloud, format="npy", roi="-1,1,-1,1,-1,0.09").json()["objects"]
    assert only["id"] == 2
    refused = ask(shared, cloud, format="npy", roi="1,2")
    assert refused.status_code == 422
    assert "roi must be six numbers" in refused.text
    assert "max_range must be a positive number" in ask(shared, cloud, format="npy", max_range=-1).text


@pytest.fixture(scope="module")
def depth():
    """A block on a table seen from above, as the body of a question."""
    image = np.full((120, 160), 1000, np.uint16)
    image[40:80, 60:100] = 900
    return {
        "depth": encoded(image), "depth_scale": 0.001,
        "intrinsics": {"fx": 130.0, "fy": 130.0, "cx": 79.5, "cy": 59.5, "width": 160, "height": 120},
    }  # fmt: skip


def encoded(image):
    file = io.BytesIO()
    Image.fromarray(image).save(file, "PNG")
    return base64.b64encode(file.getvalue()).decode()


def test_a_depth_image_becomes_a_scene(shared, depth):
    answer = shared.post("/v1/perceive/depth", json=depth)
    assert answer.status_code == 200, answer.text
    assert len(answer.json()["objects"]) == 1
    for wrong in (
        {"depth": "no base64!"},
        {"masks": "?"},
        {"intrinsics": "no camera"},
        {"intrinsics": "/etc/passwd"},
    ):
        refused = shared.post("/v1/perceive/depth", json=depth | wrong)
        assert refused.status_code == 422, wrong
        assert "/tmp" not in refused.text


def test_a_depth_image_comes_with_the_file_of_its_camera_and_masks(shared, depth):
    camera = "image_width: 160\nimage_height: 120\ncamera_matrix:\n  rows: 3\n  cols: 3\n"
    camera += "  data: [130.0, 0, 79.5, 0, 130.0, 59.5, 0, 0, 1]\n"
    masks = np.zeros((120, 160), np.uint8)
    masks[40:80, 60:80], masks[40:80, 80:100] = 1, 2  # a segmenter that cuts the block in two
    asked = depth | {"intrinsics": camera, "masks": encoded(masks)}
    document = shared.post("/v1/perceive/depth", json=asked).json()
    assert [one["id"] for one in document["objects"]] == [2, 3]
    assert not any("mask" in one for one in document["objects"])
    masked = shared.post("/v1/perceive/depth", json=asked | {"with_masks": True}).json()
    # Column 60 of 120 rows begins at pixel 7200; 40 rows of each of 20 columns are the first half.
    assert masked["objects"][0]["mask"] == {"size": [120, 160], "counts": [7240, *[40, 80] * 19, 40, 9640]}
    # The block lies 0.9 m in front of the camera, to the right of its axis or to the left.
    assert [np.sign(one["centroid_camera"][0]) for one in document["objects"]] == [-1, 1]
    assert all(one["centroid_camera"][2] == pytest.approx(0.9, abs=0.01) for one in document["objects"])
    body = shared.post("/v1/perceive/depth/points", json=asked).content
    (n,) = struct.unpack("<I", body[:4])
    labels = np.frombuffer(body, "<i4", n, 4 + 12 * n)
    assert {1, 2, 3} <= set(labels.tolist())
    behind = json.loads(body[4 + 19 * n :])
    for key in document.keys() - {"seconds", "source"}:
        assert behind[key] == document[key], key


def test_damaged_clouds_are_refused_in_one_line(shared, cloud, tmp_path):
    """Bytes changed, cut and made up at random, in every format: 4xx in the library's words, no path, no crash."""
    draw = random.Random(7)
    for number in range(40):
        damaged = bytearray(cloud[:128] if number % 2 else cloud)
        for _ in range(draw.randrange(1, 20)):
            damaged[draw.randrange(min(len(damaged), 200))] = draw.randrange(256)
        answer = ask(
            shared,
            bytes(damaged[: draw.randrange(len(damaged))]),
            format=draw.choice(["npy", "npz", "pcd", "ply"]),
        )
        assert answer.status_code in (200, 422), answer.text
        assert str(tmp_path.parents[2]) not in answer.text
        assert "/tmp" not in answer.text
    assert ask(shared, cloud, format="npy").status_code == 200


def test_no_parameter_names_a_file(shared, cloud):
    paths = {"format": "/etc/passwd", "up": "../x", "units": "/", "goal": "/etc/passwd", "model": "/etc/passwd"}
    for name, value in paths.items():
        answer = ask(shared, cloud, **({"format": "npy"} | {name: value}))
        assert (answer.status_code, "root:" in answer.text) == (422, False), name


def contribute(memory, robot):
    record = Record("action_prior", "k", 1, "add", slots=np.array([1]), values=np.array([2]))
    memory.contribute(robot, [record], process="p", seq=0, task={})


def test_memories_travel_as_exports(serve, where, tmp_path):
    with open_memory(where) as memory:
        contribute(memory, "rosie")
    first, second = serve(where), serve()
    exported = first.get("/v1/memory/export")
    assert exported.headers["content-type"] == "application/vnd.sqlite3"
    assert second.post("/v1/memory/merge", content=exported.content, headers=FILE).json() == {
        "added": 1, "already_there": 0, "forgotten": 0, "buildings": [],
    }  # fmt: skip
    shown = second.get("/v1/memory").json()
    assert [one["robot"] for one in shown["robots"]] == ["rosie"]
    assert "location" not in shown
    assert second.delete("/v1/memory/robots", params={"robot": "rosie"}).json()["forgotten"] == 1
    assert second.delete("/v1/memory/robots", params={"robot": "rosie"}).status_code == 404
    assert second.post("/v1/memory/merge", content=exported.content, headers=FILE).json()["forgotten"] == 1
    assert first.delete("/v1/memory/buildings", params={"building": "nowhere"}).status_code == 404


def test_uploads_that_are_no_exports_change_nothing(serve, tmp_path):
    client = serve()
    with open_memory(tmp_path / "own.db") as memory:
        contribute(memory, "rosie")
        memory.export_to(tmp_path / "export.db")
    good = (tmp_path / "export.db").read_bytes()
    with sqlite3.connect(tmp_path / "export.db") as conn:
        conn.execute(
            "CREATE VIEW endless AS WITH RECURSIVE c(x) AS (SELECT 1 UNION ALL SELECT x FROM c) SELECT x FROM c"
        )
    conn.close()
    hostile = (tmp_path / "export.db").read_bytes()
    draw = random.Random(11)
    damaged = [good[: draw.randrange(len(good))] for _ in range(10)]
    for content in (b"", b"SQLite format 3\0", b"x" * 5000, hostile, *damaged):
        answer = client.post("/v1/memory/merge", content=content, headers=FILE)
        assert answer.status_code == 422, answer.text
        assert "/tmp" not in answer.text
    assert client.get("/v1/memory").json()["robots"] == []
    assert client.post("/v1/memory/merge", content=good, headers=FILE).json()["added"] == 1
