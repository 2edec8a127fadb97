"""The separator's benchmark at a size for tests, and the pairs it is run on."""

import pytest

from benchmarks import separator
from benchmarks.cloud_pairs import DRAWN, cloud_pair
from benchmarks.separator import FINE, WIDE, bench_separator
from tests.benchmarks.contract import checked


@pytest.fixture
def small(monkeypatch):
    monkeypatch.setattr(separator, "names", lambda: [DRAWN])
    monkeypatch.setattr(separator, "GOALS", {(FINE, 1000): 0.0, (WIDE, 1200): 1e9})
    monkeypatch.setattr(separator, "ROUNDS", {1000: 3, 1200: 1})
    monkeypatch.setattr(separator, "EXACT_POINTS", 800)
    monkeypatch.setattr(separator, "small_pairs", lambda: {DRAWN: cloud_pair(DRAWN, 600)})
    monkeypatch.setattr(separator, "cold_and_warm", lambda source: (7.0, 0.1))


def test_the_answer_keeps_its_contract(small):
    told = []
    result = bench_separator(2, lambda *at: told.append(at))
    checked(result, told)
    met = {goal["name"]: goal["met"] for goal in result["goals"]}
    assert met["libsvm / ours, n = 1000, l = 60 mm, C₀ = 10"]
    assert not met["libsvm / ours, n = 1200, l = 120 mm, C₀ = 1"]
    assert met["support vectors that differ at tolerance 1e-5"]
    assert met["greatest difference of f at tolerance 1e-5"]
    assert not met["first separator in a fresh process, cold, s"]
    assert met["first separator in a fresh process, warm, s"]
