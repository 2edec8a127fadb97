"""A folder of scenes reads back as what was written."""

import csv

import numpy as np
import pytest

from lifelore.core.errors import InputError
from lifelore.domains.tabletop.scene_folder import SceneFolder
from lifelore.domains.tabletop.settings import TabletopSettings
from lifelore.domains.tabletop.tabletop import tabletop_scenes

pytest.importorskip("mujoco", reason="needs the extra sim")
pytestmark = pytest.mark.sim


@pytest.fixture(scope="module")
def written(tmp_path_factory):
    folder = tmp_path_factory.mktemp("scenes") / "new"
    drawn = list(tabletop_scenes(2, 1, TabletopSettings(n_objects=(2, 3))))
    writer = SceneFolder(folder)
    for scene in drawn:
        writer.write(scene)
    return folder, drawn


def rows(folder, name):
    with open(folder / f"{name}.csv", encoding="utf-8") as file:
        return list(csv.DictReader(file))


@pytest.mark.slow
def test_the_cloud_comes_back_in_the_tables_frame(written):
    from pypcd4.pypcd4 import PointCloud

    folder, drawn = written
    planes = {row["scene"]: row for row in rows(folder, "planes")}
    for scene in drawn:
        data = PointCloud.from_path(folder / f"{scene.name}.pcd").pc_data
        points = np.stack([data["x"], data["y"], data["z"]], axis=1).astype(float)
        normal = np.array([float(planes[scene.name][key]) for key in ("nx", "ny", "nz")])
        heights = points @ normal + float(planes[scene.name]["d"])
        assert heights == pytest.approx(scene.cloud.points[:, 2], abs=1e-5)
        assert np.array_equal(np.where(data["label"] > 9, data["label"] // 10, 1), scene.cloud.labels)
        back = points @ scene.view.rotation.T + scene.view.position
        assert back == pytest.approx(scene.cloud.points, abs=1e-6)
        red = (np.asarray(data["rgba"]) >> 16) & 255
        assert np.array_equal(red, scene.cloud.colours[:, 0])


def test_truth_and_gaps_come_back(written):
    folder, drawn = written
    told = [
        (r["scene"], int(r["a"]), int(r["b"]), r["relation"], int(r["confidence"]))
        for r in rows(folder, "relations")
    ]
    assert told == [(s.name, t.a, t.b, t.relation, t.confidence) for s in drawn for t in s.truth]
    gaps = [(r["scene"], float(r["visible_gap"])) for r in rows(folder, "gaps")]
    assert gaps == [(s.name, pytest.approx(g.visible, abs=1e-5)) for s in drawn for g in s.gaps]


def test_a_folder_with_scenes_or_a_file_is_refused(written, tmp_path):
    with pytest.raises(InputError, match=r"relations\.csv"):
        SceneFolder(written[0])
    for name in ("planes.csv", "gaps.csv", "sim00041.pcd"):
        folder = tmp_path / name.replace(".", "-")
        folder.mkdir()
        (folder / name).write_text("somebody's own")
        with pytest.raises(InputError, match="must hold no scenes yet"):
            SceneFolder(folder)
        (folder / name).rename(folder / f"{name}.txt")
        SceneFolder(folder)
    (tmp_path / "file").write_text("")
    with pytest.raises(InputError, match="must be a folder"):
        SceneFolder(tmp_path / "file")
