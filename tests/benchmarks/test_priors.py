"""The benchmark of priors: like work by all, and the contract of its answer."""

import numpy as np
import pytest

from benchmarks import priors
from benchmarks.priors import ACTIONS, ALPHA0, DENSE, DICT, OURS, SCATTERED, STATES, Case, bench_priors
from lifelore.core.errors import InputError
from tests.benchmarks.contract import checked


@pytest.mark.parametrize("name", [STATES, SCATTERED])
def test_all_count_the_same_and_sample_the_same_law(name):
    case = Case(name, 5_000)
    case.prepare()
    counts = case.update().counts(case.codes)
    assert counts.sum() == case.best.sum()
    dictionary = case.update_dict()
    assert counts.tolist() == [dictionary[code] for code in case.code_list]
    ways = {OURS: case.sample(), DICT: np.array(case.sample_dict())}
    if name == STATES:
        assert counts.tolist() == case.update_dense()
        ways[DENSE] = np.array(case.sample_dense())
    # The share of samples that fall on counted actions: one minus the mean of what α⁰ gives the others. Its
    # deviation is at most ½ / √5000 = 0.007; four of them.
    alpha = counts + ALPHA0
    expected = np.mean((alpha * (counts > 0)).sum(axis=1) / alpha.sum(axis=1))
    for drawn in ways.values():
        assert set(drawn.tolist()) == set(range(ACTIONS))
        assert np.mean(counts[np.arange(len(drawn)), drawn] > 0) == pytest.approx(expected, abs=0.03)


def test_the_answer_keeps_its_contract(monkeypatch):
    monkeypatch.setattr(priors, "CONTEXTS", 5_000)
    monkeypatch.setattr(priors, "COMPONENTS", 2)
    told = []
    result = bench_priors(2, lambda *at: told.append(at))
    rows = checked(result, told)
    assert len(rows) == 10 + 4
    for line in rows.values():
        ours = line["name"].endswith((OURS, priors.TABLES, priors.SOLVE))
        assert (line["ratio"] is None) == (line["ratio_to"] is None) == ours
    measured = {goal["name"]: goal["measured"] for goal in result["goals"]}
    for name, line in rows.items():
        if str(line["ratio_to"]).endswith(OURS):
            assert measured[f"{name} / {OURS}"] == line["ratio"]
    assert measured[f"{priors.TABLES}, ms"] == rows[priors.TABLES]["value"]
    assert len(measured) == 6 + 2 + 2


def test_unlike_work_is_refused(monkeypatch):
    case = Case(STATES, 100)
    monkeypatch.setattr(Case, "update_dict", lambda self: {code: [0.0] * ACTIONS for code in self.code_list})
    with pytest.raises(InputError, match="must hold the prior's counts, got others"):
        case.prepare()
