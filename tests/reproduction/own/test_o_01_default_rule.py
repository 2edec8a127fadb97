"""O1: worlds by hand, measures of made-up results, the decision, and a tiny run."""

import numpy as np
import pytest

from reproduction.chapter4.reuse.many_tasks import EXACT, LEARNT, UNCERTAIN
from reproduction.own.o_01_default_rule.run import (
    CANDIDATES,
    RULES,
    _largest_excess,
    decided_rule,
    key_of,
    measure,
    readings,
)
from reproduction.own.o_01_default_rule.worlds import CALLS, TABLES, world_of


def test_pays_have_the_means_and_deviations_of_the_models():
    for name, noise in ((TABLES, "by pair"), (CALLS, "equal")):
        world = world_of(name, noise, 3, 1)
        library = world.library(EXACT, 0, np.random.default_rng(0))
        assert np.allclose(library.performance.mean, world.mean)
        assert np.allclose(library.performance.deviation, world.deviation, atol=1e-9)
        types, policies = np.full(20_000, 2), np.full(20_000, 1)
        luck = np.random.default_rng(0).random((20_000, 1))
        paid = world.pays(types, luck)(0, policies)
        assert paid.mean() == pytest.approx(world.mean[2, 1], abs=5 * world.deviation[2, 1] / 20_000**0.5)
        assert paid.std() == pytest.approx(world.deviation[2, 1], rel=0.05)
        learnt = world.library(LEARNT, 2000, np.random.default_rng(1)).performance.mean
        assert np.abs(learnt - world.mean).max() < 5 * world.deviation.max() / 2000**0.5


def made_up(regret, stuck, **cell):
    """A result of two groups."""
    own = {name: {"regret": regret[name], "stuck": [stuck[name]] * 2} for name in RULES}
    cell = {"world": "golf", "noise": "equal", "model": EXACT, **cell}
    return cell | {"rules": own} | ({UNCERTAIN: own} if cell["model"] == LEARNT else {})


def test_measures_by_hand():
    two = {name: [2.0, 4.0] for name in RULES}
    first = made_up(two | {"IDS": [1.0, 2.0]}, dict.fromkeys(RULES, 0.1) | {"IDS": 0.02})
    second = made_up(two | {"greedy": [1.0, 1.0]}, dict.fromkeys(RULES, 0.0), noise="by pair", model=LEARNT)
    found = measure({}, [first, second])
    # The best mean regret is 1.5 in the first world and 1 in the second.
    assert found["regret_IDS"].value == pytest.approx((1.0 + 3.0) / 2)
    assert found["regret_greedy"].value == pytest.approx((2.0 + 1.0) / 2)
    assert found["regret_IDS_minus_best_other"].value == pytest.approx(0.5)
    assert found["regret_EI_outcome_over_greedy_unequal"].value == pytest.approx(3.0)
    assert found["stuck_above_least_KG"].value == pytest.approx(0.08)
    read = {(cell["models"], cell["noise"]): numbers for cell, numbers in readings({}, [first, second])}
    assert list(read) == [("all", "all"), (EXACT, "equal"), (LEARNT, "by pair")]
    assert read[EXACT, "equal"]["regret_IDS_minus_best_other"].value == pytest.approx(1.0 - 2.0)
    assert read[LEARNT, "by pair"]["stuck_above_least_IDS"].value == 0


def stuck_by_group(shares):
    return {"rules": {name: {"stuck": shares.get(name, [0.5, 0.5, 0.5])} for name in RULES}, "model": EXACT}


def test_the_largest_excess_of_stuck_tasks_by_hand():
    ids, least = [0.3, 0.2, 0.4], [0.2, 0.1, 0.1]
    small = stuck_by_group({"IDS": [0.2, 0.1, 0.1], "KG": [0.2, 0.0, 0.1]})
    found = _largest_excess([small, stuck_by_group({"IDS": ids, "greedy": least})], "IDS")
    # Above greedy selection by 0.1, 0.1 and 0.3 in the second world.
    assert found.value == pytest.approx(0.5 / 3)
    assert 0.1 - 1e-9 <= found.ci95[0] < found.ci95[1] <= 0.3 + 1e-9
    assert _largest_excess([small], "KG").ci95 == (0.0, 0.0)


def measured_of(regret, excess):
    return {
        f"{word}_{key_of(name)}": {"value": value}
        for word, values in (("regret", regret), ("stuck_above_least", excess))
        for name, value in zip(RULES, values, strict=True)
    }


def test_the_decision():
    regret = [1.0, 1.1, 1.2, 1.3, 1.4, 1.5]
    assert decided_rule(measured_of(regret, [0.06, 0.05, 0.0, 0.0, 0.0, 0.0])) == "EI, pay"
    assert decided_rule(measured_of(regret, [0.06, 0.06, 0.07, 0.055, 0.2, 0.3])) == "KG"
    assert decided_rule(measured_of(regret, [0.0, 0.2, 0.1, 0.0, 0.0, 0.0]), CANDIDATES) == "IDS"
