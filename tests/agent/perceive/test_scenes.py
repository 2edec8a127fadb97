"""The verb: files on disk and a report that agrees with them."""

import csv

import pytest

from lifelore.agent.perceive.scenes import make_scenes
from lifelore.core.errors import InputError

pytest.importorskip("mujoco", reason="needs the extra sim")
pytestmark = pytest.mark.sim


@pytest.mark.slow
def test_the_report_counts_what_is_in_the_files(tmp_path):
    seen = []
    mix = {"on": 1, "both": 1}
    report = make_scenes(
        4, tmp_path / "out", 2, mix=mix, arrangement="pair", progress=lambda *told: seen.append(told)
    )
    with open(tmp_path / "out" / "relations.csv", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert report["pairs"] == {"on": 2, "adjacent": 0, "both": 2, "none": 0}
    assert report["mix"] == {"on": 0.5, "adjacent": 0.0, "both": 0.5, "none": 0.0}
    assert sum(row["b"] != "1" for row in rows) == 4
    assert sum(row["b"] == "1" for row in rows) == sum(report["with_table"].values()) == 8
    assert sorted(path.name for path in (tmp_path / "out").glob("*.pcd")) == [f"sim{i:05d}.pcd" for i in range(4)]
    assert [done for done, _, _ in seen] == [1, 2, 3, 4]


def test_a_mistake_leaves_no_folder(tmp_path):
    for mistake in ({"arrangement": "ring"}, {"camera": "eye"}, {"jobs": 0}, {"mix": {"under": 1}}):
        with pytest.raises(InputError):
            make_scenes(1, tmp_path / "out", **mistake)
    assert not (tmp_path / "out").exists()
