"""The benchmark of perceiving: its contract at a small size, its stages, and points that are made up."""

from types import SimpleNamespace

import numpy as np
import pytest

from benchmarks import perceive
from benchmarks.perceive import AGAIN, PARTS, bench_perceive
from benchmarks.perception_stages import STAGES
from benchmarks.process import Cost
from lifelore.core.labelled_cloud import TABLE, LabelledCloud
from tests.benchmarks.contract import checked


@pytest.fixture
def cloud() -> LabelledCloud:
    """Three slabs in a pile on a table."""
    x, y = (axis.ravel() for axis in np.meshgrid(np.arange(0, 0.1, 0.004), np.arange(0, 0.1, 0.004)))
    layers = [np.stack([x, y, np.full(len(x), z)], axis=1) for z in (0.02, 0.04, 0.06)]
    floor = np.stack([3 * x - 0.1, 3 * y - 0.1, 0 * x], axis=1)
    labels = np.repeat([TABLE, 2, 3, 4], len(x))
    return LabelledCloud(np.concatenate([floor, *layers]), labels, None, np.array([0.0, -1, 1]))


@pytest.fixture
def small(monkeypatch, cloud, tmp_path):
    cloud_file = tmp_path / "cloud.npz"
    np.savez(cloud_file, points=cloud.points, labels=cloud.labels)
    monkeypatch.setattr(perceive, "_crowded_scene", lambda: SimpleNamespace(cloud=cloud))
    monkeypatch.setattr(perceive, "POINTS", 2000)
    monkeypatch.setattr(perceive, "_shell_sources", lambda folder, scene: {"a cloud": cloud_file})
    monkeypatch.setattr(
        perceive, "process_cost", lambda arguments, environment, status=0: Cost(9.0, 5.0 / (1 + status))
    )
    parts = dict.fromkeys(PARTS, 0.1) | {AGAIN: 0.3}
    monkeypatch.setattr(perceive, "process_parts", lambda source, environment: parts)


def test_the_answer_keeps_its_contract(small):
    told = []
    result = bench_perceive(2, lambda *at: told.append(at))
    assert len(checked(result, told)) == 2 * (1 + len(STAGES)) + (3 + len(PARTS) + 1) + 2 + 1
    shares = [line["ratio"] for line in result["rows"][1 : 1 + len(STAGES)]]
    assert all(0 < part < 1 for part in shares)
    goals = {goal["name"]: goal for goal in result["goals"]}
    assert goals["a cloud, in a program, s"]["met"] is True
    assert goals["a cloud, from the shell, s"]["met"] is False  # 5 s
    assert goals["a PCD that is cut off, from the shell, s"]["measured"] == pytest.approx(5 / 3)
    assert next(line["ratio"] for line in result["rows"] if line["name"].endswith(": imports")) == pytest.approx(
        1 / 9
    )
