"""C4.16 in a tiny run: every decision alike, and the measures see one that is not."""

import copy

import pytest

from reproduction.chapter4.c4_16_beat_is_reuse.measure import measure, rows
from reproduction.chapter4.c4_16_beat_is_reuse.run import EPSILONS, cells, run_cell
from reproduction.engine.registry import claim_of

CLAIM = claim_of("C4.16")

SETTINGS = CLAIM.settings("quick", {"training": 4})
RESULTS = [run_cell(SETTINGS, cell, 0) for cell in cells(SETTINGS)[1:3]]


def test_every_decision_is_alike():
    found = measure(SETTINGS, RESULTS)
    assert found["decisions_alike"].value == 1
    assert found["decisions_alike"].n > 1000
    assert found["beliefs_apart"].value <= 1e-12
    assert [cell["epsilon"] for cell in cells(SETTINGS)] == list(EPSILONS)
    assert {row["kind"] for row in rows(SETTINGS, RESULTS)} == set(range(6))


def test_a_decision_that_differs_is_seen():
    changed = copy.deepcopy(RESULTS)
    changed[0]["sessions"][2]["alike"] -= 1
    changed[1]["sessions"][0]["apart"] = 0.25
    found = measure(SETTINGS, changed)
    assert found["decisions_alike"].value < 1
    assert found["beliefs_apart"].value == 0.25
    assert CLAIM.predicate.verdict({k: v.to_dict() for k, v in found.items()}) == "does not hold"


def test_products_vanish_where_five_episodes_are_long():
    sessions = RESULTS[0]["sessions"]
    for session in sessions:
        assert session["vanished"] <= session["decisions"]
    longest = max(sessions, key=lambda s: s["decisions"])
    assert longest["vanished"] > 100
    assert longest["spread"] == pytest.approx(max(s["spread"] for s in sessions), rel=1)
