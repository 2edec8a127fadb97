"""Runs that stop and go on, and what they refuse. A small claim of our own counts what is run."""

import json
from dataclasses import replace
from pathlib import Path

import pytest

from lifelore.core.errors import InputError, NotFoundError, StoreError
from lifelore.core.metrics import mean_estimate
from reproduction.engine import reproduce as module
from reproduction.engine.reproduce import reproduce
from tests.reproduction.toy_claim import toy_claim

RAN = []


def run_cell(settings, cell, seed):
    RAN.append(cell["i"])
    if settings["fail_at"] == cell["i"]:
        raise InputError("this cell fails")
    return {"x": cell["i"] + seed + 1 / 3}


@pytest.fixture
def toy(monkeypatch):
    settings = {"n": 6, "fail_at": -1}
    claim = toy_claim(settings, run_cell, limits={"fail_at": {"least": -1}})
    monkeypatch.setattr(module, "claim_of", lambda claim_id: claim)
    monkeypatch.setattr(module, "source_key", lambda: "code")
    monkeypatch.setattr(module, "provenance", lambda data: {"source": "code", "cores": 1})
    RAN.clear()
    return claim


def test_finished_cells_are_not_run_again(toy, tmp_path):
    first = reproduce(["C3.1"], out=tmp_path, jobs=2)
    assert sorted(RAN) == [0, 1, 2, 3, 4, 5]
    assert reproduce(["C3.1"], out=tmp_path, jobs=1) == first
    assert len(RAN) == 6
    reproduce(["C3.1"], out=tmp_path, seed=1)
    assert len(RAN) == 12


def test_ctrl_c_keeps_what_is_finished_and_the_next_run_goes_on(toy, tmp_path):
    def stop(done, total, label):
        if done == 2:
            raise KeyboardInterrupt

    # Many cells: these take microseconds, and more are finished before the run has stopped.
    many = {"n": 300}
    with pytest.raises(KeyboardInterrupt):
        reproduce(["C3.1"], overrides=many, out=tmp_path, jobs=1, progress=stop)
    before = len(RAN)
    kept = len(list((tmp_path / "C3.1" / "cells").glob("*.json")))
    assert 2 <= kept == before < 300
    assert not (tmp_path / "C3.1" / "result.json").exists()
    resumed = reproduce(["C3.1"], overrides=many, out=tmp_path, jobs=1)[0]
    assert sorted(RAN) == list(range(300))
    fresh = reproduce(["C3.1"], overrides=many, out=tmp_path / "fresh")[0]
    assert {**resumed, "seconds": 0} == {**fresh, "seconds": 0}


def test_claims_that_share_cells_run_them_once(toy, tmp_path, monkeypatch):
    claims = {name: replace(toy, id=name, shared=("fail_at",)) for name in ("C3.1", "C3.2")}
    monkeypatch.setattr(module, "claim_of", claims.__getitem__)
    one, other = reproduce(["C3.1", "C3.2"], out=tmp_path, jobs=1)
    assert RAN == [0, 1, 2, 3, 4, 5]
    assert (one["rows"], one["seconds"]) == (other["rows"], other["seconds"])
    assert not (tmp_path / "C3.1" / "cells").exists()
    # Of settings that the run of a cell does not read none matters; those that it reads do, and so does the seed.
    longer = reproduce(["C3.2"], out=tmp_path, overrides={"n": 8}, jobs=1)[0]
    assert RAN[6:] == [6, 7]
    assert len(longer["rows"]) == 8
    reproduce(["C3.2"], out=tmp_path, overrides={"n": 1, "fail_at": 5}, jobs=1)
    reproduce(["C3.2"], out=tmp_path, overrides={"n": 1}, seed=1, jobs=1)
    assert RAN[8:] == [0, 0]


def test_a_cell_that_fails_stops_the_run_with_its_own_error(toy, tmp_path):
    with pytest.raises(InputError, match="this cell fails"):
        reproduce(["C3.1"], out=tmp_path, overrides={"fail_at": "3"}, jobs=1)
    assert not (tmp_path / "C3.1" / "result.json").exists()


def test_result_by_hand(toy, tmp_path):
    result = reproduce(["C3.1"], out=tmp_path, overrides={"n": 3})[0]
    assert result["measured"]["x"]["value"] == 1.33333  # mean of 0, 1, 2 and a third, to six digits
    assert result["verdict"] == "reproduced"
    assert result["marks"] == {"x is positive": ["✓", "✓", "✓"]}
    assert result["readings"] == []
    assert result["rows"] == [{"x": 0.333333}, {"x": 1.33333}, {"x": 2.33333}]
    assert result["settings"] == {"n": 3, "fail_at": -1}
    assert {"python", "lifelore", "numpy", "numba", "scipy"} <= set(result["versions"])
    assert result["made"]["cores"] >= 1


def test_results_too_large_to_commit_are_refused(toy, tmp_path, monkeypatch):
    monkeypatch.setattr(module, "MAX_BYTES", 100)
    with pytest.raises(InputError, match="may hold 100 bytes"):
        reproduce(["C3.1"], out=tmp_path)


def test_a_disk_that_refuses_is_one_line(toy, tmp_path):
    (tmp_path / "out").write_text("a file", encoding="utf-8")
    with pytest.raises(StoreError, match="choose another place"):
        reproduce(["C3.1"], out=tmp_path / "out")


def test_what_is_refused_before_anything_runs(tmp_path):
    with pytest.raises(NotFoundError, match=r"no claim 'C1\.1'"):
        reproduce(["C1.1"], out=tmp_path)
    with pytest.raises(InputError, match="jobs must be at least 1, got 0"):
        reproduce(["C3.1"], out=tmp_path, jobs=0)
    with pytest.raises(InputError, match="has no setting 'runs'"):
        reproduce(["C3.1"], out=tmp_path, overrides={"runs": 1})
    assert not list(Path(tmp_path).iterdir())


def test_a_quick_run_never_takes_the_place_of_evidence(toy, tmp_path):
    reproduce(["C3.1"], "full", out=tmp_path, jobs=1)
    evidence = (tmp_path / "C3.1" / "result.json").read_bytes()
    reproduce(["C3.1"], "quick", out=tmp_path)
    assert (tmp_path / "C3.1" / "result.json").read_bytes() == evidence
    assert json.loads((tmp_path / "C3.1" / "quick" / "result.json").read_text())["mode"] == "quick"


def test_readings_are_judged_and_drawn(toy, tmp_path, monkeypatch):
    values = {"low": -1.0, "middle": 1.0, "high": 2.0}
    read = lambda settings, results: [({"choice": k}, {"x": mean_estimate([v])}) for k, v in values.items()]  # noqa: E731
    monkeypatch.setattr(module, "claim_of", lambda claim_id: replace(toy, readings=read))
    result = reproduce(["C3.1"], out=tmp_path, jobs=1)[0]
    assert result["marks"] == {"x is positive": ["✓", "✓", "✓"]}
    assert [reading["cell"]["choice"] for reading in result["readings"]] == ["low", "middle", "high"]
    assert (tmp_path / "C3.1" / "readings.png").read_bytes().startswith(b"\x89PNG")
    values["middle"] = -2.0
    assert reproduce(["C3.1"], out=tmp_path, jobs=1)[0]["marks"] == {"x is positive": ["✓", "✓", "½"]}
