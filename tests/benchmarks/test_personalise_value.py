"""The benchmark of the value of choices: worlds, LinUCB beside its formula, and the contract of its answer."""

import numpy as np
import pytest

from benchmarks import personalise_value
from benchmarks.personalise_value import CLICKS, LinUCB, Log, World, bench_personalise_value, paired
from tests.benchmarks.contract import checked

SMALL = {"small": World(CLICKS, 2, 3, 2, 0.9)}


def test_linucb_is_ridge_regression_with_an_upper_bound():
    log = Log(np.array([0, 0, 1]), np.array([0, 1, 0]), np.array([1.0, 0.0, 0.5]), np.array([0, 1]), 2)
    player = LinUCB(log, 2)
    scale, middle = np.std([1.0, 0.0, 0.5]), 0.5
    # User 0 had message 0 before message 1; the history of message 0 is one outcome, 0.5 above the middle.
    rows = {0: [[1, 1, 0, 0, 0, 0, 0], [1, 0, 1, 0, 0, 0, 0]], 1: [[1, 1, 0, 0.5 / scale / 4, 0, np.log(2), 0]]}
    paid = {0: [(1.0 - middle) / scale, 0.0], 1: [(0.0 - middle) / scale]}
    stranger, bounds = np.array([1.0, 1, 0, 0, 0, 0, 0]), []
    for message in (0, 1):
        x, y = np.array(rows[message], float), np.array(paid[message])
        inverse = np.linalg.inv(np.eye(7) + x.T @ x)
        bounds.append(stranger @ inverse @ x.T @ y + LinUCB.ALPHA * np.sqrt(stranger @ inverse @ stranger))
        assert player.a[message] == pytest.approx(np.eye(7) + x.T @ x)
        assert player.b[message] == pytest.approx(x.T @ y)
    first = player.play(np.array([0]), lambda turn, messages: np.zeros(1))[0, 0]
    assert first == int(np.argmax(bounds))


def test_intervals_of_differences():
    # Deviation √2 of two, by 12.71 / √2.
    assert paired(np.array([1.0, 3.0])) == pytest.approx((2.0, 12.71))


def test_the_answer_keeps_its_contract(monkeypatch):
    monkeypatch.setattr(personalise_value, "DEVELOPED", SMALL)
    monkeypatch.setattr(personalise_value, "JUDGED", {})
    monkeypatch.setattr(personalise_value, "USERS", 200)
    monkeypatch.setattr(personalise_value, "ROWS", 1500)
    monkeypatch.setattr(personalise_value, "STRANGERS", 60)
    told = []
    result = bench_personalise_value(1, lambda *at: told.append(at))
    rows = checked(result, told)
    assert len(rows) == 5 + 2 * 3
    assert len(result["goals"]) == 3
    known = rows["small: own best message, known"]["value"]
    assert all(rows[f"small: {name}"]["value"] <= known for name in personalise_value.CONTENDERS)
    over = rows["small: default over best single message"]["value"]
    assert over == pytest.approx(rows["small: default"]["value"] - rows["small: best single message"]["value"])
