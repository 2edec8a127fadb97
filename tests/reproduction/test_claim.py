"""Settings of a claim and what may override them."""

import importlib
import sys
from dataclasses import replace
from pathlib import Path

import pytest

from lifelore.core.errors import InputError
from reproduction.engine import registry
from reproduction.engine.claim import Claim, no_readings
from reproduction.engine.statement import Statement


def claim(check=None):
    settings = {"runs": 5, "rate": 0.5, "name": "all", "sizes": [1, 2], "deep": {"a": 1}, "fast": True}
    nothing = dict.fromkeys(("cells", "run_cell", "measure", "rows", "draw"), lambda *_: None)
    words = dict.fromkeys(("title", "sentence", "thesis", "here", "decides"), "w")
    statements = (Statement.parsed("x is positive", "x > 0", central=True),)
    sizes = {"quick": {**settings, "runs": 1}, "full": settings}
    return Claim("C0.0", **words, statements=statements, sizes=sizes, check=check, **nothing)  # type: ignore[arg-type]


def test_modes():
    assert claim().settings("quick")["runs"] == 1
    assert claim().settings("full")["runs"] == 5
    with pytest.raises(InputError, match="mode must be one of quick, full, got 'fast'"):
        claim().settings("fast")


@pytest.mark.parametrize(
    ("key", "given", "value"),
    [
        ("runs", "7", 7),
        ("runs", 7, 7),
        ("rate", "1", 1.0),
        ("rate", 1, 1.0),
        ("name", "7", "7"),
        ("sizes", "[3]", [3]),
        ("fast", "false", False),
        ("deep", '{"b": 2}', {"b": 2}),
    ],
)
def test_overrides_are_read_as_the_settings_type(key, given, value):
    found = claim().settings("full", {key: given})[key]
    assert found == value
    assert type(found) is type(value)


@pytest.mark.parametrize(
    ("key", "given", "rule"),
    [
        ("runs", "many", "C0.0 setting 'runs' must be of the type of its default 5, got 'many'"),
        ("runs", "1.5", "default 5"),
        ("runs", True, "default 5"),
        ("rate", "NaN", "default 0.5"),
        ("rate", "true", "default 0.5"),
        ("sizes", "3", r"default \[1, 2\]"),
        ("sizes", "[NaN]", r"default \[1, 2\]"),
        ("fast", "1", "default true"),
        ("deep", "[1]", 'default {"a": 1}'),
        ("speed", "1", "C0.0 has no setting 'speed'; it has runs, rate"),
    ],
)
def test_overrides_that_break_their_rule(key, given, rule):
    with pytest.raises(InputError, match=rule) as refused:
        claim().settings("full", {key: given})
    assert "\n" not in str(refused.value)


def test_the_claims_own_check_sees_the_overridden_settings():
    seen = []
    claim(seen.append).settings("full", {"runs": "3"})
    assert seen[0]["runs"] == 3


def test_a_claim_without_a_central_statement_is_refused():
    with pytest.raises(InputError, match="must have a statement with central = true"):
        replace(claim(), statements=(Statement.parsed("x is positive", "x > 0"),))


def test_overriding_leaves_the_claim_as_it_was():
    one = claim()
    one.settings("full", {"runs": 3})
    assert one.settings("full")["runs"] == 5


def test_measured_are_the_first_reading_and_what_measure_adds_to_it_or_replaces():
    first, second = ({"reading": 1}, {"x": 1, "y": 2}), ({"reading": 2}, {"x": 0})
    one = replace(claim(), readings=lambda *_: iter([first, second]), measure=lambda *_: {"y": 3, "z": 4})
    assert one.measured({}, []) == ({"x": 1, "y": 3, "z": 4}, [first, second])
    assert replace(one, readings=no_readings).measured({}, []) == ({"y": 3, "z": 4}, [])


def test_a_claim_is_loaded_from_its_folder(tmp_path, monkeypatch):
    text = (Path(registry.__file__).parents[1] / "chapter3/c3_01_useful_actions/claim.toml").read_text()
    (tmp_path / "small").mkdir()
    (tmp_path / "small/claim.toml").write_text(text)
    (tmp_path / "small/run.py").write_text("cells = run_cell = measure = rows = draw = print")
    monkeypatch.syspath_prepend(tmp_path)
    claim = Claim.load("C3.1", tmp_path / "small", "small")
    assert claim.cells is claim.draw is print
    assert claim.check is None
    for program, words in {
        "run_cell = rows = print": "must define run_cell, and measure or readings",
        "run_cell = readings = draw = print; shared = ('speed',)": r"shared of .* must name settings, got speed",
    }.items():
        (tmp_path / "small/run.py").write_text(program)
        importlib.invalidate_caches()
        monkeypatch.delitem(sys.modules, "small.run")
        with pytest.raises(InputError, match=words):
            Claim.load("C3.1", tmp_path / "small", "small")
