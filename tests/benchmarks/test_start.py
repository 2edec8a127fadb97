"""The benchmark of starting: its contract and arithmetic on stand-ins, and real processes."""

import os
from pathlib import Path

import pytest

from benchmarks import start
from benchmarks.process import Cost, installed_environment, process_cost
from benchmarks.start import bench_start, clouds_to_perceive, fitted_study, open_decisions
from lifelore.core.errors import LifeloreError
from tests.benchmarks.contract import checked


@pytest.fixture
def stand_ins(monkeypatch):
    """Processes that cost what their arguments say: 8 s with nothing compiled, 1 s and a half a cloud else."""
    asked = []

    def cost(arguments, environment):
        asked.append((list(arguments), environment))
        empty = "empty" in environment["NUMBA_CACHE_DIR"]
        clouds = sum(str(part).endswith(".pcd") for part in arguments)
        seconds = 8.0 if empty else 0.2 if "--help" in arguments else 0.75 + 0.5 * clouds
        return Cost(2 * seconds, seconds)

    monkeypatch.setattr(start, "process_cost", cost)
    monkeypatch.setattr(start, "cold_and_warm", lambda source: (4.0, 0.1))
    monkeypatch.setattr(
        start, "clouds_to_perceive", lambda folder: ([Path(f"{k}.pcd") for k in range(4)], "a cloud")
    )
    monkeypatch.setattr(start, "fitted_study", lambda folder: folder / "study.db")
    monkeypatch.setattr(start, "open_decisions", lambda place, n: [f"{place}-{k}" for k in range(n)])
    return asked


def test_start_times_every_state_and_judges_it(stand_ins):
    told = []
    result = bench_start(2, lambda *at: told.append(at))
    checked(result, told)
    goals = {goal["name"]: goal for goal in result["goals"]}
    met = {name: goal["met"] for name, goal in goals.items()}
    assert met == {
        "first result of learner q, cold, s": False,  # 4 s
        "first result of learner q, warm, s": True,
        "first result of learner model, cold, s": False,
        "first result of learner model, warm, s": True,
        "lifelore --help, warm, s": True,
        "lifelore live, first after setup, s": True,
        "lifelore perceive of a cloud, first after setup, s": True,
        "lifelore perceive of a cloud, warm, s": True,  # 1.25 s
        "lifelore reuse choose, first after setup, s": True,
        "lifelore reuse choose, warm, s": False,  # 0.75 s
        "lifelore reuse update, first after setup, s": True,
        "lifelore reuse update, warm, s": False,
        "each further cloud in one process, s": True,
    }
    assert goals["each further cloud in one process, s"]["measured"] == pytest.approx(0.5)
    # What is measured after setup reads the kernels that the warm-up left; what is first ever finds none.
    warmed = [environment["NUMBA_CACHE_DIR"] for arguments, environment in stand_ins if "--warm" in arguments]
    used = {environment["NUMBA_CACHE_DIR"] for arguments, environment in stand_ins}
    assert used - set(warmed) == {environment["NUMBA_CACHE_DIR"] for _, environment in stand_ins[-5:]}
    # Each outcome is of another decision, so that none is a repetition.
    ended = [arguments[3] for arguments, _ in stand_ins if "update" in arguments]
    assert len(ended) == len(set(ended)) == 4


def test_what_the_verbs_are_given_can_be_used(monkeypatch, tmp_path):
    pytest.importorskip("mujoco")
    monkeypatch.delenv("LIFELORE_DATA", raising=False)
    monkeypatch.setattr(start, "SIMULATED", (2,))
    clouds, what = clouds_to_perceive(tmp_path)
    assert what == "a simulated camera's PCD"
    environment = installed_environment(tmp_path)
    study = fitted_study(tmp_path)
    (decision,) = open_decisions(study, 1)
    for arguments in (
        ["perceive", *clouds, "--json"],
        ["reuse", "choose", "--user", "ann", "--memory", study],
        ["reuse", "update", "--decision", decision, "--outcome", 1, "--memory", study],
    ):
        cost = process_cost(arguments, environment)
        assert cost.cpu > 0
        assert cost.wall > 0
    assert any((tmp_path / "bytecode").rglob("perceive*.pyc"))


def test_a_process_that_fails_is_no_measurement(tmp_path):
    with pytest.raises(LifeloreError, match="no such file"):
        process_cost(["perceive", tmp_path / "none.pcd"], dict(os.environ))
