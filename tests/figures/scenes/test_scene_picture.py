"""The picture of a scene draws what the document says, whatever the scene lacks."""

import numpy as np
import pytest
from matplotlib.patches import FancyArrowPatch, Polygon

from docs.pictures.scene_layers import draw_layers, predicate
from lifelore.core.labelled_cloud import LabelledCloud
from lifelore.figures.scenes import scene_picture
from lifelore.figures.scenes.scene_document import Bond
from lifelore.figures.scenes.scene_picture import draw_scene
from lifelore.figures.style import MAX_BYTES, save_figure


@pytest.fixture(autouse=True)
def coarse(monkeypatch):
    """Fewer pixels an inch: the pictures say the same, sooner."""
    monkeypatch.setattr(scene_picture, "_RESOLUTION", 60)


def box(corner, size, n, rng):
    points = rng.uniform(0, 1, (n, 3))
    face = rng.integers(0, 3, n)
    points[np.arange(n), face] = face != 1
    return np.asarray(corner) + points * size


def cloud_of(n_objects=2, n=400, *, table=True, colours=True, camera=True):
    rng = np.random.default_rng(0)
    places = [(0.15 * (k % 5), 0.15 * (k // 5), 0) for k in range(n_objects)]
    parts = [box(place, 0.1, n, rng) for place in places]
    labels = [np.full(n, 2 + k) for k in range(n_objects)]
    if table:
        parts.append(rng.uniform(-0.5, 1.5, (2000, 3)) * [1, 1, 0])
        labels.append(np.ones(2000, np.int64))
    points = np.vstack([np.empty((0, 3)), *parts])
    return LabelledCloud(
        points,
        np.concatenate([np.empty(0, np.int64), *labels]),
        rng.integers(0, 255, (len(points), 3)).astype(np.uint8) if colours else None,
        np.array([0.3, -1.0, 0.9]) if camera else None,
    )


def relation(a, b, name, confidence=0.9, gap=0.004):
    return {"a": a, "b": b, "relation": name, "confidence": confidence, "gap": gap}


def document_of(cloud, relations=()):
    objects = [
        {
            "id": number, "n_points": 1, "centroid": [0, 0, 0], "edges": [[0, 1]], "grasp_seeds": [],
            "contact_points": [{"xyz": cloud.of(number)[k].tolist()} for k in (0, 1)],
        }
        for number in cloud.objects
    ]  # fmt: skip
    return {"objects": objects, "relations": list(relations), "facts": [], "holes": [], "seconds": 0.1}


def texts(figure):
    return [text.get_text() for axes in figure.axes for text in axes.texts]


def arrows(axes):
    return [p for p in axes.patches if isinstance(p, FancyArrowPatch)]


def test_objects_are_labelled_and_relations_listed():
    cloud = cloud_of(3)
    bonds = [relation(3, 2, "on", 0.83, 0.0041), relation(2, "table", "on"), relation(2, 4, "none")]
    figure = draw_scene(cloud, document_of(cloud, bonds))
    picture, listing = figure.axes
    assert sorted(t.get_text() for t in picture.texts) == ["2", "3", "4"]
    listed = [t.get_text() for t in listing.texts]
    assert {"3 objects, 2 relations", "on", "83 %", "4 mm", "on the table"} <= set(listed)
    assert "none" not in listed


def test_an_arrow_leads_from_a_to_b():
    cloud = cloud_of(2)
    figure = draw_scene(cloud, document_of(cloud, [relation(3, 2, "on")]))
    picture = figure.axes[0]
    at = {t.get_text(): t.get_position() for t in picture.texts}
    head = next(p for p in arrows(picture) if type(p.get_arrowstyle()).__name__ == "CurveFilledB")
    np.testing.assert_allclose(head._posA_posB, [at["3"], at["2"]])  # pyright: ignore[reportAttributeAccessIssue]


@pytest.mark.parametrize(
    ("name", "heads", "bands"), [("on", 1, 0), ("adjacent", 0, 2), ("both", 1, 2), ("left_of", 1, 0)]
)
def test_each_relation_has_its_sign(name, heads, bands):
    cloud = cloud_of(2)
    picture = draw_scene(cloud, document_of(cloud, [relation(2, 3, name)])).axes[0]
    styles = [type(p.get_arrowstyle()).__name__ for p in arrows(picture)]
    assert styles.count("CurveFilledB") == heads
    # Paper below, paper within: what makes two dashes of one line.
    assert sum(p.get_edgecolor()[:3] == (1, 1, 1) for p in arrows(picture)) == bands


def test_relations_with_the_table_are_listed_not_drawn():
    cloud = cloud_of(2)
    picture, listing = draw_scene(cloud, document_of(cloud, [relation(2, "table", "on")])).axes
    assert not arrows(picture)
    assert "no relations between objects" in [t.get_text() for t in listing.texts]


def test_surer_is_darker_and_thicker():
    cloud = cloud_of(2)
    strokes = []
    for confidence in (0.2, 1.0):
        picture = draw_scene(cloud, document_of(cloud, [relation(2, 3, "on", confidence)])).axes[0]
        patch = arrows(picture)[-1]
        strokes.append((patch.get_linewidth(), -sum(patch.get_edgecolor()[:3])))
    assert strokes[0][0] < strokes[1][0]
    assert strokes[0][1] < strokes[1][1]


def test_networks_are_drawn_where_the_contacts_are():
    cloud = cloud_of(2)
    document = document_of(cloud) | {"contact_edges": [[[2, 0], [3, 1]]]}
    picture = draw_scene(cloud, document).axes[0]
    circles = [line for line in picture.lines if line.get_marker() == "o" and line.get_markerfacecolor() == "none"]
    assert [len(line.get_xdata()) for line in circles] == [2, 2]
    dashed = [line for line in picture.lines if line.is_dashed()]
    np.testing.assert_allclose(
        dashed[0].get_xydata(), [circles[0].get_xydata()[0], circles[1].get_xydata()[1]]
    )  # fmt: skip


def test_holes_are_shaded():
    cloud = cloud_of(2)
    document = document_of(cloud) | {"holes": [{"nodes": [[2, 0], [2, 1], [3, 0]]}]}
    picture = draw_scene(cloud, document).axes[0]
    assert sum(isinstance(patch, Polygon) for patch in picture.patches) == 2


@pytest.mark.parametrize("n_objects", [0, 1, 15])
@pytest.mark.parametrize("part", ["table", "colours", "camera", "none"])
def test_whatever_lacks_it_is_drawn_and_small(n_objects, part, tmp_path):
    cloud = cloud_of(n_objects, **{part: False} if part != "none" else {})
    bonds = [relation(a, a + 1, "adjacent", 0.5) for a in cloud.objects[:-1]]
    bonds += [relation(a, "table", "on") for a in cloud.objects]
    figure = draw_scene(cloud, document_of(cloud, bonds))
    assert sum(text.isdigit() for text in [t.get_text() for t in figure.axes[0].texts]) == n_objects
    path = save_figure(figure, tmp_path / "scene.png")
    assert path.stat().st_size <= MAX_BYTES


def test_a_long_list_keeps_the_surest():
    cloud = cloud_of(15, 60)
    rng = np.random.default_rng(1)
    bonds = [relation(a, b, "on", rng.uniform(0.3, 0.8)) for a in range(2, 17) for b in range(2, 17) if a < b]
    bonds[7]["confidence"] = 0.99
    listed = texts(draw_scene(cloud, document_of(cloud, bonds)))
    assert "99 %" in listed
    left_off = next(text for text in listed if "less sure" in text)
    assert int(left_off.split()[1]) == len(bonds) - listed.count("on")


def test_a_pair_with_two_relations_bows_its_arrows():
    cloud = cloud_of(2)
    bonds = [relation(2, 3, "left_of"), relation(3, 2, "right_of")]
    picture = draw_scene(cloud, document_of(cloud, bonds)).axes[0]
    middles = {tuple(np.round(np.asarray(p.get_path().vertices)[1], 1)) for p in arrows(picture)}
    assert len(middles) > 1


def test_the_same_scene_gives_the_same_bytes(tmp_path):
    cloud = cloud_of(4)
    document = document_of(cloud, [relation(2, 3, "both")])
    one, two = (save_figure(draw_scene(cloud, document), tmp_path / f"{k}.png").read_bytes() for k in (1, 2))
    assert one == two


def test_the_layers_are_cloud_networks_predicates():
    cloud = cloud_of(2)
    figure = draw_layers(cloud, document_of(cloud, [relation(2, 3, "on"), relation(3, "table", "on")]))
    clouds, networks, predicates = figure.axes
    assert (len(clouds.lines), len(networks.lines) > 0, len(predicates.lines)) == (0, True, 0)
    assert (len(arrows(networks)), len(arrows(predicates)) > 0) == (0, True)
    assert {"on(2, 3)", "on(3, table)"} <= {text.get_text() for text in predicates.texts}
    assert clouds.texts[0].get_text() == "2,800 points of 2 objects"


def test_a_predicate_names_the_table():
    assert predicate(Bond(4, 1, "on", 1.0, None)) == "on(4, table)"
