"""Spoilt scenes: cells, what each way of spoiling is given, rows of both readings, and a scene made by hand."""

from types import SimpleNamespace

import numpy as np
import pytest

from lifelore.core.labelled_cloud import TABLE, LabelledCloud
from lifelore.core.relations import PairLabel
from reproduction.chapter2.c2_05_discarded_points import run as spoilt_scenes
from reproduction.chapter2.c2_05_discarded_points.run import (
    BORDER,
    DISCARDED,
    MASKS,
    NOISE,
    WAYS,
    cells,
    key_of,
    literal_rows,
    run_cell,
    strong_places,
)
from reproduction.chapter2.scenes import scene_lots
from reproduction.chapter2.scenes.skeletons import shipped_model_digest


def row_of_points() -> LabelledCloud:
    """Things 2 and 3, three points each 1 mm apart, 4.5 mm between them, seen from above."""
    x = np.array([0.0, 1, 2, 6.5, 7.5, 8.5]) * 1e-3
    cloud = np.stack([x, 0 * x, 0 * x], axis=1)
    return LabelledCloud(cloud, np.array([2, 2, 2, 3, 3, 3]), None, np.array([0.0, 0, 1]))


@pytest.mark.parametrize(
    ("way", "level", "labels"),
    [
        # Only the two ends lie within 5 mm of the other thing.
        (BORDER, 1.0, [{(2, 2, 3, 2, 3, 3)}]),
        (BORDER, 0.0, [{(2, 2, 2, 3, 3, 3)}]),
        # Whoever grows first takes what lies within 6 mm: two points.
        (MASKS, 0.006, [{(2, 2, 2, 2, 2, 3), (2, 3, 3, 3, 3, 3)}]),
        (MASKS, 0.004, [{(2, 2, 2, 3, 3, 3)}]),
    ],
)
def test_levels_of_labels_mean_what_they_say(way, level, labels):
    found = {
        tuple(WAYS[way](row_of_points(), level, np.random.default_rng(seed)).labels.tolist()) for seed in range(9)
    }
    assert [found] == labels


def test_levels_of_points_mean_what_they_say():
    cloud, rng = row_of_points(), np.random.default_rng(0)
    assert (WAYS[DISCARDED](cloud, 0.0, rng).points == cloud.points).all()
    many = LabelledCloud(np.tile(cloud.points, (500, 1)), np.tile(cloud.labels, 500), None, cloud.camera)
    # 3,000 points, each kept with 0.3: 900 ± 25; four standard deviations.
    assert 800 <= len(WAYS[DISCARDED](many, 0.7, rng).points) <= 1000
    # The camera is straight above, near enough, so that noise is in height: 2 mm ± 0.03.
    moved = WAYS[NOISE](many, 0.002, rng).points - many.points
    assert moved[:, 2].std() == pytest.approx(0.002, rel=0.06)
    assert set(WAYS) == {DISCARDED, NOISE, BORDER, MASKS}


def test_names_of_views():
    assert [key_of(DISCARDED, 0.7), key_of(NOISE, 0.001)] == ["discarded 0.7", "noise 0.001"]


def test_cells_are_lots_of_lessons_scenes_and_real_scenes(monkeypatch):
    settings = {"lessons": 25, "scenes": 9, "real": False}
    model = shipped_model_digest()
    assert len(model) == 16
    wanted = [{"lessons": k} for k in (0, 10, 20)] + [{"first": k, "model": model} for k in (0, 4, 8)]
    assert cells(settings) == wanted
    monkeypatch.setattr(scene_lots, "real_scenes_folder", lambda: None)
    assert cells({**settings, "real": True}) == wanted
    monkeypatch.setattr(scene_lots, "real_scenes_folder", lambda: "somewhere")
    monkeypatch.setattr(scene_lots, "real_scenes", lambda: [SimpleNamespace(name=name) for name in "abc"])
    assert cells({**settings, "real": True})[6:] == [
        {"real": ["a", "b"], "model": model},
        {"real": ["c"], "model": model},
    ]


def test_contacts_of_seven_are_kept_and_are_weighted_centroids():
    seven = np.array([[0.001 * k, 0, 0] for k in range(7)])
    six = np.array([[0.1 + 0.001 * k, 0, 0] for k in range(6)])
    points, alpha = np.concatenate([seven, six]), np.array([1.0] * 6 + [3.0] + [9.0] * 6)
    # (0 + 1 + … + 5 + 3 · 6) / 9 = 33 / 9 mm; the six, though stronger by far, are too few.
    assert strong_places(points, alpha, 0.025) == pytest.approx(np.array([[33e-4 / 9 * 10, 0, 0]]), abs=1e-9)
    both = strong_places(points, alpha, 0.025, least=6)
    assert both[:, 0] == pytest.approx([0.1025, 33e-3 / 9])
    assert strong_places(points[7:], alpha[7:], 0.025).shape == (0, 3)


def plate(n: int, *corner: float, step: float = 0.004) -> np.ndarray:
    x, y = np.meshgrid(np.arange(n) * step, np.arange(n) * step)
    return np.stack([x.ravel(), y.ravel(), 0 * x.ravel()], axis=1) + np.array(corner)


def test_the_literal_reading_of_two_plates():
    points = np.concatenate([plate(31, 0, 0, 0, step=0.002), plate(31, 0, 0, 0.006, step=0.002)])
    cloud = LabelledCloud(points, np.repeat([2, 3], 961))
    (found,) = literal_rows(cloud)
    assert found[:3] == [2, 3, 0.006]
    moved = np.array(found[3])
    # Contact points lie in their plates: 2 less 3 is 6 mm down.
    assert moved[:, 2] == pytest.approx(-0.006)
    # One pair of them faces one another, whatever the number of contacts.
    assert np.hypot(*moved[:, :2].T).min() < 0.003


def test_the_literal_reading_has_nothing_to_say_of_few_points():
    # Four points a plate cannot be seven support vectors; thinned in the same way, no pair has a row.
    points = np.concatenate([plate(2, 0, 0, 0), plate(2, 0, 0, 0.01)])
    assert literal_rows(LabelledCloud(points, np.repeat([2, 3], 4))) == []


def box(low, size, step=0.006) -> np.ndarray:
    axes = [np.arange(0, side + step / 2, step) for side in size]
    grid = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)
    last = np.array([axis[-1] for axis in axes])
    return grid[((grid == 0) | (grid == last)).any(axis=1)] + np.array(low)


@pytest.fixture
def made(monkeypatch) -> SimpleNamespace:
    """A block on a block on a table, as the tabletop would give it."""
    parts = [plate(40, -0.05, -0.05, 0), box((0, 0, 0), (0.09, 0.09, 0.06)), box((0.01, 0.01, 0.063), (0.06,) * 3)]
    labels = np.repeat([TABLE, 2, 3], [len(part) for part in parts])
    cloud = LabelledCloud(np.concatenate(parts), labels, None, np.array([0.0, -1, 1]))
    truth = (PairLabel(3, 2, "on", 2), PairLabel(2, TABLE, "on"))
    gaps = (SimpleNamespace(a=2, b=3, visible=0.003),)
    scene = SimpleNamespace(name="made", cloud=cloud, truth=truth, gaps=gaps)
    monkeypatch.setattr(spoilt_scenes, "sample_scene", lambda seed, number, settings: scene)
    return scene


def test_a_scene_with_nothing_thrown_away_is_the_scene(made):
    levels = {DISCARDED: [0.0, 0.999], NOISE: [0.0]}
    settings = {"lessons": 1, "scenes": 1, "levels": levels, "camera": "kinect", "real": False}
    found = run_cell(settings, {"first": 0, "model": ""}, 0)
    assert found["kind"] == "simulated"
    (scene,) = found["scenes"]
    # The table has no part in truth, gaps and views.
    assert (scene["name"], scene["truth"], scene["gaps"]) == ("made", [[3, 2, "on", 2]], [[2, 3, 0.003]])
    views = scene["views"]
    assert set(views) == {"whole", "discarded 0", "discarded 0.999", "noise 0"}
    assert views["discarded 0"] == views["whole"]
    # Clouds as they come are read where points are thrown away, and nowhere else.
    assert views["noise 0"] == {name: views["whole"][name] for name in ("lifelore", "thesis")}
    assert [(row[0], row[1], row[2]) for row in views["whole"]["lifelore"]] == [(3, 2, "on")]
    ((a, b, gap, moved),) = views["whole"]["thesis"]
    assert (a, b) == (2, 3)
    # 3 mm up, and 2 mm aside along both axes: of the two grids of 6 mm one starts 10 mm further on.
    assert gap == pytest.approx(np.sqrt(3**2 + 2**2 + 2**2) / 1000, abs=1e-5)
    assert all(rise < 0 for _, _, rise in moved)
    # Both networks have as many nodes as before, and no node has moved.
    same = scene["networks"]["discarded 0"]
    assert same["same"] == [1, 1]
    assert set(same["shifts"]) == {0}
    # Of some 1,500 points one or two are left: no pair, no network.
    assert views["discarded 0.999"] == {"lifelore": [], "thesis": [], "literal": []}
    assert scene["networks"]["discarded 0.999"] == {"same": [0, 0], "shifts": []}


def test_lessons_hold_both_readings_of_the_whole_scene(made):
    settings = {"lessons": 11, "scenes": 1, "levels": {}, "camera": "kinect", "real": False}
    found = run_cell(settings, {"lessons": 10}, 0)
    assert (found["kind"], len(found["scenes"])) == ("lesson", 1)
    (scene,) = found["scenes"]
    assert set(scene["view"]) == {"thesis", "literal"}
    assert [row[:2] for row in scene["view"]["thesis"]] == [[2, 3]]


def test_real_scenes_are_asked_by_name_and_without_known_gaps(made, monkeypatch):
    others = SimpleNamespace(name="other", cloud=made.cloud, truth=made.truth)
    monkeypatch.setattr(spoilt_scenes, "real_scenes", lambda: [made, others])
    found = run_cell({"levels": {}}, {"real": ["other"], "model": ""}, 0)
    assert found["kind"] == "real"
    assert [(scene["name"], scene["gaps"]) for scene in found["scenes"]] == [("other", [])]
