"""Stored results are run again and compared to the last digit."""

import json

import pytest

from lifelore.core.errors import InputError, NotFoundError
from reproduction.engine.reproduce import reproduce
from reproduction.engine.verify import compared, verify


@pytest.fixture(scope="module")
def stored(tmp_path_factory):
    """A folder with a small result."""
    out = tmp_path_factory.mktemp("results")
    reproduce(["C3.1"], "quick", {"mazes": 20}, out=out, seed=3)
    return out


def spoiled(stored, tmp_path, change):
    result = json.loads((stored / "C3.1" / "result.json").read_text(encoding="utf-8"))
    change(result)
    (tmp_path / "C3.1").mkdir()
    (tmp_path / "C3.1" / "result.json").write_text(json.dumps(result), encoding="utf-8")
    return tmp_path


def test_a_result_is_equal_to_its_repetition_and_stays_as_it_is(stored):
    before = sorted((path, path.stat().st_mtime_ns) for path in stored.rglob("*"))
    (found,) = verify([], out=stored, jobs=2)
    assert [one["claim"] for one in verify(["C3.1", "C3.1"], out=stored)] == ["C3.1"], "named twice, run once"
    assert (found["claim"], found["equal"], found["differences"], found["changed"]) == ("C3.1", True, [], [])
    assert sorted((path, path.stat().st_mtime_ns) for path in stored.rglob("*")) == before


def test_another_digit_is_found(stored, tmp_path):
    def change(result):
        name = next(iter(result["measured"]))
        result["measured"][name]["value"] += 1e-6

    (found,) = verify(["C3.1"], out=spoiled(stored, tmp_path, change))
    assert not found["equal"]
    assert found["n_differences"] == 1
    assert found["differences"][0]["where"].endswith(".value")


def test_another_mark_and_another_reading_are_found(stored, tmp_path):
    def change(result):
        next(iter(result["marks"].values()))[0] = "½"
        result["readings"][0]["cell"]["generator"] = "another"

    (found,) = verify(["C3.1"], out=spoiled(stored, tmp_path, change))
    assert found["n_differences"] == 2
    assert [one["where"].partition(".")[0] for one in found["differences"]] == ["marks", "readings[0]"]


def test_a_result_whose_outside_data_are_not_here_is_not_run(stored, tmp_path, monkeypatch):
    def change(result):
        result["made"]["data"] = {"osd": "0123456789abcdef"}

    folder = spoiled(stored, tmp_path, change)
    monkeypatch.delenv("LIFELORE_DATA", raising=False)
    (found,) = verify(["C3.1"], out=folder)
    assert (found["equal"], found["missing"], found["seconds"]) == (None, ["osd"], 0.0)
    (tmp_path / "data" / "osd").mkdir(parents=True)
    monkeypatch.setenv("LIFELORE_DATA", str(tmp_path / "data"))
    (found,) = verify(["C3.1"], out=folder)
    assert (found["equal"], found["missing"]) == (True, [])
    assert {"where": "data.osd", "stored": "0123456789abcdef", "now": "nothing"} in found["changed"]


def test_where_and_what_differs():
    made = {"source": "k", "processor": "p", "simd": "s", "data": {}}
    one = {
        "claim": "C3.1", "verdict": "reproduced", "marks": {}, "versions": {"numpy": "1"}, "readings": [],
        "rows": [{"x": 1}, {"x": 2}], "made": made,
        "measured": {"a": {"value": 1.0, "ci95": None}, "seconds": {"value": 5.0}},
    }  # fmt: skip
    other = {
        **one, "verdict": "not reproduced", "versions": {"numpy": "2"}, "rows": [{"x": 1}],
        "measured": {"a": {"value": 1.0, "ci95": [1.0, 1.0]}, "b": {"value": 3}, "seconds": {"value": 6.0}},
        "made": {**made, "source": "l"}, "seconds": 7.0,
    }  # fmt: skip
    found = compared(one, other)
    places = ["verdict", "measured.a.ci95", "measured.b", "rows[1]"]
    assert [difference["where"] for difference in found["differences"]] == places
    assert found["changed"] == [
        {"where": "versions.numpy", "stored": "1", "now": "2"},
        {"where": "source", "stored": "k", "now": "l"},
    ]


def test_what_is_refused(tmp_path):
    with pytest.raises(NotFoundError, match="no result in"):
        verify([], out=tmp_path)
    with pytest.raises(NotFoundError, match=r"no result of C3\.1 in .*run `lifelore reproduce C3\.1` first"):
        verify(["C3.1"], out=tmp_path)
    (tmp_path / "C3.1").mkdir()
    (tmp_path / "C3.1" / "result.json").write_text("{", encoding="utf-8")
    with pytest.raises(InputError, match="is not JSON"):
        verify(["C3.1"], out=tmp_path)
