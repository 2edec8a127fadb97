"""`bench start` and `bench buildings`: their contract and arithmetic on stand-ins, and real processes."""

import json
from pathlib import Path

import pytest

from benchmarks import bench
from benchmarks.lives import buildings
from benchmarks.startup import start, start_cases
from benchmarks.startup.process_cost import Cost, installed_environment, process_cost
from benchmarks.startup.start_cases import clouds_to_perceive, fitted_study, open_decisions
from lifelore.core.errors import LifeloreError


def checked(result: dict, told: list) -> dict:
    """The contract of every benchmark's answer; goals by name."""
    assert json.loads(json.dumps(result, allow_nan=False)) == result
    names = [line["name"] for line in result["rows"]]
    assert len(set(names)) == len(names)
    assert all(line["ratio_to"] in [*names, None] for line in result["rows"])
    assert [(done, of) for done, of, _ in told] == [(i + 1, told[0][1]) for i in range(told[0][1])]
    return {goal["name"]: goal for goal in result["goals"]}


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
    monkeypatch.setattr(start, "first_result_seconds", lambda learner: (4.0, 0.1))
    monkeypatch.setattr(
        start, "clouds_to_perceive", lambda folder: ([Path(f"{k}.pcd") for k in range(4)], "a cloud")
    )
    monkeypatch.setattr(start, "fitted_study", lambda folder: folder / "study.db")
    monkeypatch.setattr(start, "open_decisions", lambda place, n: [f"{place}-{k}" for k in range(n)])
    return asked


def test_start_times_every_state_and_judges_it(stand_ins):
    told = []
    result = bench("start", repeats=2, progress=lambda *at: told.append(at))
    goals = checked(result, told)
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
    monkeypatch.setattr(start_cases, "SIMULATED", (2,))
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
        process_cost(["perceive", tmp_path / "none.pcd"], installed_environment(tmp_path))


def test_buildings_are_lived_in_and_drawn(monkeypatch, tmp_path):
    monkeypatch.setattr(buildings, "SIZES", ((14.0, 12.0, 0.6), (16.0, 14.0, 0.5)))
    monkeypatch.setattr(buildings, "TASKS", 2)
    monkeypatch.setattr(buildings, "OUT", tmp_path)
    told = []
    result = buildings.bench_buildings(1, lambda *at: told.append(at), tmp_path)
    goals = checked(result, told)
    assert goals["memory of the process, MB"]["measured"] > 20
    places = [int(label.split()[0].replace(",", "")) for _, _, label in told]
    assert 20 < places[0] < places[1]
    assert not list(tmp_path.iterdir())  # three repeats or more draw
    lives = [buildings._life(buildings.SIZES[0]) | {"first": 1.0, "later": 0.5, "places": n} for n in (100, 1000)]
    buildings._draw(lives, tmp_path)
    assert (tmp_path / "bench_buildings.png").stat().st_size > 5000


def test_a_life_that_fails_is_no_measurement(monkeypatch):
    with pytest.raises(LifeloreError, match="a timed life must end well"):
        buildings._life((1.0, 1.0, 0.5))
