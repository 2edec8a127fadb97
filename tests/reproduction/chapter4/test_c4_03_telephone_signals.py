"""C4.3: orders of signals from made-up callers by hand, and a tiny run."""

import json

import numpy as np
import pytest

from lifelore.core.errors import InputError
from lifelore.domains.telephone.telephone import Telephone
from reproduction.chapter4.c4_03_telephone_signals.measure import measure, orders, rows
from reproduction.chapter4.c4_03_telephone_signals.run import (
    SIGNAL_OF_PATH,
    exact_library,
    learnt_library,
    run_cell,
)
from reproduction.engine.registry import claim_of

CLAIM = claim_of("C4.3")
QUICK = dict(claim_of("C4.3").sizes["quick"])

SMALL = {
    **QUICK, "groups": 4, "users": 8, "calls": 30, "by_call": 20, "models": [3, 4], "default_models": 4,
    "more_samples": 40,
}  # fmt: skip


@pytest.fixture(scope="module")
def cells():
    return json.loads(json.dumps([run_cell(SMALL, cell, 1) for cell in CLAIM.cells(SMALL)]))


def test_orders_by_hand():
    sums = {
        "(s, a, s′)": np.array([[1.0, 3.0], [1.0, 3.0]]),
        "(s, a, r)": np.array([[2.0, 4.0], [3.0, 5.0]]),
        "U": np.array([[0.0, 10.0], [0.0, 10.0]]),
    }
    found = orders(sums)
    assert found["regret_sar_minus_sas"].value == pytest.approx(1.5)
    assert found["regret_u_minus_sar"].value == pytest.approx(1.5)
    # Variances 1, 1.25 and 25.
    assert found["variance_sar_minus_sas"].value == pytest.approx(0.25)
    assert found["variance_u_minus_sar"].value == pytest.approx(23.75)


@pytest.mark.parametrize("signal", SIGNAL_OF_PATH)
def test_libraries_know_the_service(signal):
    phone = Telephone(4)
    exact = exact_library(phone, signal)
    assert exact.performance.mean == pytest.approx(phone.mean)
    learnt = learnt_library(phone, signal, np.random.default_rng(0), 20_000, 0.5)
    assert learnt.performance.mean == pytest.approx(exact.performance.mean, abs=0.15)
    assert learnt.table().probs == pytest.approx(exact.table().probs, abs=0.02)


def test_a_tiny_run(cells):
    found = measure(SMALL, cells)
    assert {c.measure for c in CLAIM.predicate.conditions} <= set(found)
    assert found["zero_at_end_sas_exact"].value == 1
    assert found["regret_u_minus_sar_exact"].n == 32
    # Two numbers of language models by three numbers of calls and exact models, and three kinds in doubt.
    assert found["grid_sentence"].n == 2 * 4 + 3
    again = run_cell(SMALL, CLAIM.cells(SMALL)[0], 1)
    assert json.loads(json.dumps(again)) == cells[0]
    assert {tuple(c) for c in map(dict.keys, cells)} == {tuple(cells[0])}


def test_under_reading_b_states_tell_what_rewards_tell(cells):
    found = {c["signal"]: c["sums"] for c in cells if c["reading"] == "B" and c["model"] == "exact"}
    assert found["(s, a, s′)"] == found["(s, a, r)"]
    assert found["(s, a, r)"] != found["U"]


def test_the_figure_is_drawn_from_rows_alone(cells):
    kept = json.loads(json.dumps(rows(SMALL, cells)))
    figure = CLAIM.draw({"settings": SMALL, "rows": kept})
    assert figure.axes[2].get_title("left") == "4 language models, exact models"
    assert len(figure.axes[2].lines) == 6


@pytest.mark.parametrize(
    ("overrides", "rule"),
    [
        ({"default_models": 7}, "models must include default_models"),
        ({"more_samples": 10}, "must have 30 between them, got 10 and 10"),
    ],
)
def test_settings_that_limits_cannot_describe(overrides, rule):
    with pytest.raises(InputError, match=rule):
        CLAIM.settings("quick", overrides)
