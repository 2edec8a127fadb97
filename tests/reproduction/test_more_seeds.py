"""Several seeds of a claim, pooled. A small claim of our own counts what is run."""

import json
from dataclasses import replace

import pytest

from lifelore.core.errors import InputError
from reproduction.engine import more_seeds, reproduce
from reproduction.engine.claim_section import claim_section, verdict_now, visible_words
from reproduction.engine.folded_part import folded_part
from reproduction.engine.more_seeds import deciding_conditions, pooled, run_seeds
from reproduction.engine.predicate import Predicate
from reproduction.engine.second_reading import SecondReading
from tests.reproduction.toy_claim import toy_claim

RAN = []
FIRST = Predicate.from_data(
    {
        "conditions": [
            {"name": "up", "measure": "x", "part": "value", "op": ">", "bound": 0, "words": "x is positive"}
        ],
        "rules": [{"verdict": "holds", "all": ["up"]}],
    }
)
SECOND = SecondReading.from_data(
    {
        "why": "by the interval",
        "conditions": [
            {"role": "headline", "first": "up"},
            {
                "role": "detail", "name": "other", "measure": "y", "op": ">", "bound": 0,
                "words": "y is positive",
            },
        ],
    },
    FIRST,
)  # fmt: skip


def run_cell(settings, cell, seed):
    RAN.append((seed, cell["i"]))
    return {"x": settings["shift"] + (cell["i"] % 2) + 0.1 * seed}


@pytest.fixture
def toy(monkeypatch):
    settings = {"n": 6, "shift": -0.4}
    claim = toy_claim(settings, run_cell, FIRST, second=SECOND, ran="ran")
    for module in (reproduce, more_seeds):
        monkeypatch.setattr(module, "claim_of", lambda claim_id: claim)
    monkeypatch.setattr(reproduce, "source_key", lambda name: "code")
    monkeypatch.setattr(reproduce, "provenance", lambda name, data: {"source": "code", "cores": 1})
    monkeypatch.setattr(reproduce, "versions", lambda name: {})
    RAN.clear()
    return claim


def test_the_pool_is_a_mean_of_independent_numbers():
    ones = [{"value": 1.0, "ci95": [0.0, 3.0], "n": 5}, {"value": 3.0, "ci95": [1.0, 5.0], "n": 7}]
    pool = pooled(ones)
    assert (pool["value"], pool["n"]) == (2.0, 12)
    assert pool["ci95"] == pytest.approx([2 - (1**2 + 2**2) ** 0.5 / 2, 2 + (2**2 + 2**2) ** 0.5 / 2])
    assert pooled([ones[0]] * 4)["ci95"] == pytest.approx([1 - 1 / 2, 1 + 2 / 2])


def test_a_number_that_a_seed_has_not_measured_is_missing():
    one = {"value": 1.0, "ci95": [0.0, 3.0], "n": 5}
    assert pooled([one, {"value": None, "ci95": None, "n": 0}]) == {"value": None, "ci95": None, "n": 5}
    assert pooled([one, {"value": 2.0, "ci95": None, "n": 1}])["ci95"] is None


def test_seeds_decide_what_one_leaves_open(toy, tmp_path):
    reproduce.reproduce(["C3.1"], "full", jobs=1, out=tmp_path)
    alone = json.loads((tmp_path / "C3.1" / "result.json").read_text())
    assert alone["second"]["verdict"] == "undecided"
    assert deciding_conditions(toy, alone["measured"]) == ["up"]
    calls = []
    (pool,) = run_seeds(["C3.1"], 4, "full", jobs=1, out=tmp_path, progress=lambda *call: calls.append(call))
    assert pool["verdict"] == "holds"
    assert [one["seed"] for one in pool["by_seed"]] == pool["seeds"] == [0, 1, 2, 3]
    assert sorted(RAN) == [(seed, i) for seed in range(4) for i in range(6)]  # seed 0 once
    assert calls[-1][:2] == (24, 24)
    assert json.loads((tmp_path / "C3.1" / "seeds.json").read_text()) == pool
    assert set(pool["pooled"]) == {"x"}, "only what the verdict counts"
    # Finished cells are taken up.
    assert run_seeds(["C3.1"], 4, "full", jobs=1, out=tmp_path) == [pool]
    assert len(RAN) == 24


def test_a_stored_result_without_a_counted_measure_is_run_again(toy, tmp_path):
    reproduce.reproduce(["C3.1"], "full", jobs=1, out=tmp_path)
    path = tmp_path / "C3.1" / "result.json"
    stored = json.loads(path.read_text())
    stored["measured"]["before"] = stored["measured"].pop("x")
    path.write_text(json.dumps(stored))
    (pool,) = run_seeds(["C3.1"], 2, "full", jobs=1, out=tmp_path)
    assert [one["measured"]["x"]["n"] for one in pool["by_seed"]] == [6, 6]


def test_a_verdict_that_no_number_can_turn_by_its_width_needs_no_more_seeds(toy, tmp_path):
    (far,) = reproduce.reproduce(["C3.1"], "full", {"shift": 5.0}, jobs=1, out=tmp_path)
    assert far["second"]["verdict"] == "holds"
    assert deciding_conditions(toy, far["measured"]) == []


@pytest.mark.parametrize(
    ("yes", "deciding"),
    [
        # Of 7 cells: more than half are 4. Of headlines that hold: in part below, holds above.
        (2, []),
        (3, ["most"]),
        (4, ["most"]),
        (5, []),
        (7, []),
    ],
)
def test_a_share_of_a_grid_moves_by_one_cell(yes, deciding):
    share = {
        "name": "most", "measure": "share", "op": ">", "bound": 0.5, "words": "x is positive in most cells",
        "exact": True,
    }  # fmt: skip
    conditions = [{"role": "headline", "first": "up"}, {"role": "grid", **share}]
    second = SecondReading.from_data({"why": "with a grid", "conditions": conditions}, FIRST)
    claim = toy_claim({"n": 6}, run_cell, FIRST, second=second)
    measured = {"x": {"value": 9.0, "ci95": [8.5, 9.5], "n": 6}}
    measured["share"] = {"value": round(yes / 7, 6), "ci95": None, "n": 7}
    assert deciding_conditions(claim, measured) == deciding
    # As our own extra, it decides nothing.
    own = SecondReading.from_data({"why": "", "conditions": [conditions[0], {"role": "own", **share}]}, FIRST)
    assert deciding_conditions(replace(claim, second=own), measured) == []


def test_a_share_of_a_grid_moves_by_one_cell_about_the_minority():
    share = {
        "name": "most", "measure": "share", "op": ">", "bound": 0.5, "words": "x is positive in most cells",
        "exact": True, "role": "grid",
    }  # fmt: skip
    data = {"why": "with a grid", "conditions": [{"role": "headline", "first": "up"}, share], "minority": 0.25}
    claim = toy_claim({"n": 6}, run_cell, FIRST, second=SecondReading.from_data(data, FIRST))
    low = {"value": -9.0, "ci95": [-9.5, -8.5], "n": 6}
    # A headline that fails holds in part above 0.25 of 8 cells, which are 3.
    for yes, deciding in ((0, []), (1, []), (2, ["most"]), (3, ["most"]), (4, [])):
        measured = {"x": low, "share": {"value": yes / 8, "ci95": None, "n": 8}}
        assert deciding_conditions(claim, measured) == deciding


def test_the_page_shows_the_pool_and_that_it_depends_on_the_seed(toy, tmp_path, monkeypatch):
    from reproduction.engine import claim_section as page

    monkeypatch.setattr(page, "claim_of", lambda claim_id: toy)
    reproduce.reproduce(["C3.1"], "full", jobs=1, out=tmp_path)
    (pool,) = run_seeds(["C3.1"], 4, "full", jobs=1, out=tmp_path)
    result = json.loads((tmp_path / "C3.1" / "result.json").read_text()) | {"seeds": pool, "made": None}
    assert verdict_now(result) == "holds"
    section = claim_section(result, "results")
    own = [one["verdict"] for one in pool["by_seed"]]
    assert len(set(own)) > 1
    assert "**Holds** (4 seeds pooled; first reading: holds)." in section
    assert f"The verdict depends on the seed: {', '.join(own)}." in section
    assert visible_words(section) < 120
    assert "**4 seeds: holds.**" in "\n".join(folded_part(toy, result, ()))


def test_what_cannot_be_pooled_is_refused(toy, tmp_path, monkeypatch):
    with pytest.raises(InputError, match="at least 2"):
        run_seeds(["C3.1"], 1, out=tmp_path)
    with pytest.raises(InputError, match="named"):
        run_seeds([], 4, out=tmp_path)
    with pytest.raises(InputError, match="jobs must be at least 1"):
        run_seeds(["C3.1"], 4, jobs=0, out=tmp_path)
    (tmp_path / "C3.1").mkdir()
    (tmp_path / "C3.1" / "result.json").write_text("{")
    with pytest.raises(InputError, match="is not JSON"):
        run_seeds(["C3.1"], 4, "full", jobs=1, out=tmp_path)
    monkeypatch.setattr(more_seeds, "claim_of", lambda claim_id: replace(toy, second=None))
    with pytest.raises(InputError, match=r"C3\.1 has none"):
        run_seeds(["C3.1"], 4, out=tmp_path)
    assert RAN == []
