"""`bench views` in miniature, and the distance to a contact by hand."""

import numpy as np
import pytest

from benchmarks.perception import views
from benchmarks.perception.views import bench_views, contacts_found, distance_to_hull
from lifelore.core.labelled_cloud import LabelledCloud
from lifelore.perception.scene import Scene

SQUARE = np.array([[0, 0, 0], [0.1, 0, 0], [0.1, 0.1, 0], [0, 0.1, 0]])


@pytest.mark.parametrize(
    ("point", "distance"),
    [((0.05, 0.05, 0.03), 0.03), ((0.2, 0.05, 0), 0.1), ((-0.03, -0.04, 0), 0.05), ((0.02, 0.07, 0), 0.0)],
)
def test_distance_to_a_square(point: tuple, distance: float) -> None:
    assert distance_to_hull(np.array(point), SQUARE) == pytest.approx(distance, abs=1e-6)


def test_a_pair_without_contact_points_has_no_contact_found() -> None:
    scene = Scene(LabelledCloud(np.zeros((2, 3)), np.array([2, 3])))
    assert contacts_found(scene, {frozenset((2, 3)): SQUARE}) == [False]


def test_all_numbers_of_views_are_judged_on_the_same_pairs(tmp_path, monkeypatch) -> None:
    pytest.importorskip("mujoco")
    monkeypatch.setattr(views, "SCENES", 2)
    result = bench_views(1, lambda *at: None, tmp_path / "views.png")
    rows = {line["name"]: line for line in result["rows"]}
    assert (tmp_path / "views.png").is_file()
    for name in ("exact", "on", "contacts found"):
        counts = {rows[f"{name}, {n} view{'s' if n > 1 else ''}"]["n"] for n in (1, 2, 3)}
        assert len(counts) == 1
        assert counts.pop() > 0
    gain = rows["exact, 2 views"]["value"] - rows["exact, 1 view"]["value"]
    assert rows["exact, 2 views less 1 view, the same pairs"]["value"] == pytest.approx(gain)
