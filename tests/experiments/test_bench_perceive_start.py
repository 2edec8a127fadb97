"""`perceive` from the shell as a benchmark: its contract, its arithmetic, and one real process."""

import json
from pathlib import Path

import pytest

from lifelore.core.errors import LifeloreError
from lifelore.experiments.bench import perceive_start as bench
from lifelore.experiments.bench.perceive_start import Cost, installed_environment, perceive_cost, start_clouds


def test_a_further_cloud_is_the_difference_by_the_number_of_clouds(monkeypatch):
    asked, told = [], []

    def cost(clouds, environment):
        asked.append(len(clouds))
        return Cost(2.0 + 0.5 * len(clouds), 1.0 + 0.25 * len(clouds))

    monkeypatch.setattr(bench, "perceive_cost", cost)
    monkeypatch.setattr(bench, "start_clouds", lambda folder: ([Path(f"{k}.pcd") for k in range(4)], "a cloud"))
    found = bench.perceive_start(2, lambda *at: told.append(at))
    assert asked == [4, 1, 4, 1, 4]
    assert [line["value"] for line in found["rows"]] == pytest.approx([2.5, 1.25, 0.5, 0.25])
    assert [goal["met"] for goal in found["goals"]] == [True, True]
    assert told == [(1, 2, "round"), (2, 2, "round")]
    assert json.loads(json.dumps(found)) == found


def test_without_real_scenes_simulated_ones_are_written_and_perceived(monkeypatch, tmp_path):
    pytest.importorskip("mujoco")
    monkeypatch.delenv("LIFELORE_DATA", raising=False)
    monkeypatch.setattr(bench, "SIMULATED", (2,))
    sources, what = start_clouds(tmp_path)
    assert what == "a simulated camera's PCD"
    assert all(source.is_file() for source in sources)
    cost = perceive_cost(sources, installed_environment(tmp_path))
    assert 0 < cost.cpu < 600
    assert cost.wall > 0
    assert any((tmp_path / "bytecode").rglob("perceive*.pyc"))


def test_a_process_that_fails_is_told(tmp_path):
    with pytest.raises(LifeloreError, match="no such file"):
        perceive_cost([tmp_path / "none.pcd"], installed_environment(tmp_path))
