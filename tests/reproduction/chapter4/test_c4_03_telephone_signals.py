"""What the service knows, and orders of signals from made-up callers by hand."""

import numpy as np
import pytest

from lifelore.domains.telephone.telephone import STATES, Telephone
from lifelore.figures.style import new_figure
from reproduction.chapter4.c4_03_telephone_signals.run import (
    SIGNAL_OF_PATH,
    compared,
    draw_call_graph,
    exact_library,
    learnt_library,
    run_cell,
)

SMALL = {
    "groups": 3, "learnt_groups": 3, "users": 6, "calls": 15, "models": [4], "samples": [10], "eta": 0.3,
    "pseudo_count": 0.5,
}  # fmt: skip


def test_orders_by_hand():
    settings = {"users": 2, "calls": 20}
    sums = {"(s, a, s′)": [1.0, 3.0, 1.0, 3.0], "(s, a, r)": [2.0, 4.0, 3.0, 5.0], "U": [0.0, 10.0, 0.0, 10.0]}
    ended = {"(s, a, s′)": [1, 11, 5, 2], "(s, a, r)": [1, 12, 5, 2], "U": [1, 21, 12, 2]}
    found = compared(settings, {name: {"sums": sums[name], "ended": ended[name]} for name in sums})
    assert found["regret_sar_minus_sas"].value == pytest.approx(1.5)
    assert found["regret_u_minus_sar"].value == pytest.approx(1.5)
    # Variances 1, 1.25 and 25.
    assert found["variance_sar_minus_sas"].value == pytest.approx(0.25)
    assert found["variance_u_minus_sar"].value == pytest.approx(23.75)
    # The last ten calls are 11 to 20.
    assert [found[f"ended_{name}"].value for name in ("sas", "sar", "u")] == [1.0, 0.75, 0.5]


@pytest.mark.parametrize("signal", SIGNAL_OF_PATH)
def test_libraries_know_the_service(signal):
    phone = Telephone(4)
    exact = exact_library(phone, signal)
    assert exact.performance.mean == pytest.approx(phone.mean)
    learnt = learnt_library(phone, signal, np.random.default_rng(0), 20_000, 0.5)
    assert learnt.performance.mean == pytest.approx(exact.performance.mean, abs=0.15)
    assert learnt.table().probs == pytest.approx(exact.table().probs, abs=0.02)


def test_under_reading_b_states_tell_what_rewards_tell():
    cell = {"system": "B", "models": 4, "samples": None}
    found = {signal: run_cell(SMALL, {**cell, "signal": signal}, 1)["sums"] for signal in SIGNAL_OF_PATH}
    assert found["(s, a, s′)"] == found["(s, a, r)"]
    assert found["(s, a, r)"] != found["U"]


def test_call_graph_is_the_worlds():
    axes = new_figure(7, 4).subplots()
    draw_call_graph(axes)
    written = {text.get_text() for text in axes.texts}
    assert set(STATES) | {"(1−η)ρ\n[10]", "(1−η)(1−ρ)\n[3]", "(1−η)(1−ρ)\n[1]", "η\n[1]"} <= written
