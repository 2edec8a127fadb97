"""Conformance of every claim that is built, and that the registry is complete."""

import json
import pickle
import re
from functools import cache
from itertools import pairwise
from pathlib import Path

import pytest

import reproduction
from lifelore.core.errors import NotFoundError
from lifelore.figures.style import MAX_BYTES as MAX_FIGURE_BYTES
from reproduction.engine import registry
from reproduction.engine.ledger import entries
from reproduction.engine.predicate import VERDICTS, Predicate
from reproduction.engine.registry import built_ids, claim_folders, claim_of, list_claims
from reproduction.engine.reproduce import MAX_BYTES, RESULT_KEYS, reproduce
from reproduction.engine.second_reading import SECOND_VERDICTS

IDS = built_ids()
FILED = Path(__file__).with_name("filed_predicates")
ERRATA = set(re.findall(r"^## (E\d+) ", (Path(__file__).parents[2] / "docs" / "errata.md").read_text(), re.M))
READINGS = Path(__file__).with_name("filed_readings")
"""The conditions and rules of every claim as they were committed before its first full run."""


FAMILIES = ("C2.10", "C3.16", "C4.8", "C5.2")
"""A cheap claim of each chapter: on these the whole path shows that threads do not matter and seeds do."""


@pytest.fixture(scope="session")
def quick(tmp_path_factory):
    """The quick run of a claim, run once a session, and the folder it was written to."""
    out = tmp_path_factory.mktemp("results")

    @cache
    def run(claim_id: str) -> dict:
        return reproduce([claim_id], "quick", jobs=1, out=out)[0]

    return run, out


def test_registry_is_complete():
    names = {folder.name for folder in Path(reproduction.__file__).parent.glob("chapter*/c[0-9]_*")}
    assert names == {folder.name for folder in claim_folders().values()}
    assert {path.stem for path in FILED.glob("*.json")} == set(IDS)


def test_list_names_all_claims_built_or_not():
    listed = list_claims()
    assert [row["claim"] for row in listed] == [entry.id for entry in entries()]
    assert {row["claim"] for row in listed if row["built"]} == set(IDS)
    assert set(listed[0]) == {"claim", "where", "reports", "built"}


def test_claims_that_cannot_be_run(monkeypatch):
    with pytest.raises(NotFoundError, match=r"'C9\.9' is not in the ledger"):
        claim_of("C9.9")
    folders = {claim_id: folder for claim_id, folder in claim_folders().items() if claim_id != "C4.14"}
    monkeypatch.setattr(registry, "claim_folders", lambda: folders)
    with pytest.raises(NotFoundError, match=r"'C4\.14' is not built yet; built are C2\.1, "):
        claim_of.__wrapped__("C4.14")  # without the cache


# Tests of one claim go to one worker (see the scheduler in tests/conftest.py), so that its quick run is run once.
@pytest.mark.parametrize("claim_id", IDS)
class TestEveryClaim:
    def test_names_itself(self, claim_id):
        assert claim_of(claim_id).id == claim_id

    def test_predicates_are_those_filed(self, claim_id):
        filed = json.loads((FILED / f"{claim_id}.json").read_text(encoding="utf-8"))
        assert claim_of(claim_id).predicate == Predicate.from_data(filed)

    def test_second_readings_are_those_filed(self, claim_id):
        second, path = claim_of(claim_id).second, READINGS / f"{claim_id}.json"
        filed = json.loads(path.read_text(encoding="utf-8")) if path.exists() else None
        assert (second and second.to_data()) == filed

    def test_modes_have_the_same_settings_of_the_same_types(self, claim_id):
        sizes = claim_of(claim_id).sizes
        assert set(sizes) == {"quick", "full"}
        types = [{key: type(value) for key, value in settings.items()} for settings in sizes.values()]
        assert types[0] == types[1]
        assert json.loads(json.dumps(sizes["full"])) == sizes["full"]

    def test_cells_are_different_plain_data(self, claim_id):
        claim = claim_of(claim_id)
        texts = [json.dumps(cell) for cell in claim.cells(claim.settings("full"))]
        assert len(set(texts)) == len(texts) > 1

    def test_run_of_a_cell_can_be_sent_to_another_process(self, claim_id):
        claim = claim_of(claim_id)
        assert pickle.loads(pickle.dumps(claim.run_cell)) is claim.run_cell

    def test_outside_data_are_named(self, claim_id):
        claim = claim_of(claim_id)
        assert claim.data == (("osd",) if claim.sizes["full"].get("real") else ())

    def test_causes_belong_to_conditions(self, claim_id):
        claim = claim_of(claim_id)
        second = [one.condition for one in claim.second.conditions] if claim.second else []
        assert set(claim.causes) <= {c.name for c in (*claim.predicate.conditions, *second)}
        assert set(claim.shown_by) <= set(claim.causes)
        assert set(claim.shown_by.values()) <= ERRATA

    def test_predicate_can_return_every_verdict(self, claim_id):
        assert set(reachable_verdicts(claim_of(claim_id).predicate)) == set(VERDICTS)

    def test_quick_run_writes_what_it_returns(self, claim_id, quick):
        run, out = quick
        result, path = run(claim_id), out / claim_id / "result.json"
        assert json.loads(path.read_text(encoding="utf-8")) == result
        assert path.stat().st_size <= MAX_BYTES
        picture = (out / claim_id / "figure.png").read_bytes()
        assert picture.startswith(b"\x89PNG")
        assert 10_000 < len(picture) <= MAX_FIGURE_BYTES

    def test_result_has_exactly_its_keys(self, claim_id, quick):
        result = quick[0](claim_id)
        assert tuple(result) == RESULT_KEYS
        assert result["verdict"] in VERDICTS
        assert result["mode"] == "quick"
        assert all(set(number) == {"value", "median", "ci95", "n"} for number in result["measured"].values())
        assert result["settings"] == claim_of(claim_id).settings("quick")
        assert (result["second"] is None) == (claim_of(claim_id).second is None)
        assert result["second"] is None or result["second"]["verdict"] in SECOND_VERDICTS

    def test_predicate_asks_only_what_is_measured(self, claim_id, quick):
        claim = claim_of(claim_id)
        asked = {c.measure for c in claim.predicate.conditions} | (
            claim.second.measures if claim.second else set()
        )
        assert asked <= set(quick[0](claim_id)["measured"])


@pytest.mark.parametrize("claim_id", FAMILIES)
def test_result_does_not_depend_on_threads_and_does_on_the_seed(claim_id, quick, tmp_path):
    alone = quick[0](claim_id)
    threads = reproduce([claim_id], "quick", jobs=3, out=tmp_path)[0]
    assert {key for key in RESULT_KEYS if threads[key] != alone[key]} <= {"seconds", "made"}  # the day may change
    other = reproduce([claim_id], "quick", jobs=3, out=tmp_path, seed=1)[0]
    assert (other["measured"], other["rows"]) != (alone["measured"], alone["rows"])


def reachable_verdicts(predicate):
    """Verdicts where nothing is met, and for each rule where just what it asks for is; and without any number."""
    asked = [
        set(),
        *({*rule.all_of, *one} for rule in predicate.rules for one in ([(name,) for name in rule.any_of] or [()])),
    ]
    measures = {c.measure for c in predicate.conditions}
    for met in asked:
        yield predicate.verdict({name: sure(likest(predicate, name, met)) for name in measures})
    yield predicate.verdict({})


def likest(predicate, measure, met):
    """Of numbers at, around and between the bounds asked of a measure, one that meets what is to be met.

    Where two conditions on it are at odds, meeting counts more than failing.
    """
    here = [c for c in predicate.conditions if c.measure == measure]
    points = sorted({x for c in here for x in (c.bound if isinstance(c.bound, tuple) else (c.bound,))})
    between = [(low + high) / 2 for low, high in pairwise(points)]
    tried = [points[0] - 1, *points, *between, points[-1] + 1]
    return max(
        tried,
        key=lambda x: sum((c.met({measure: sure(x)}) == (c.name in met)) * (1 + (c.name in met)) for c in here),
    )


def sure(x):
    return {"value": x, "median": x, "ci95": [x, x], "n": 10}
