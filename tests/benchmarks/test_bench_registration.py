"""`bench registration` in miniature, and its counts by hand."""

import numpy as np
import pytest

from benchmarks.perception import registration
from benchmarks.perception.registration import (
    ANGLES,
    RegisteredPair,
    bench_registration,
    registration_rows,
)


def test_all_ways_to_join_views_are_judged_on_the_same_pairs(monkeypatch) -> None:
    pytest.importorskip("mujoco")
    monkeypatch.setattr(registration, "SCENES", 2)
    rows = {line["name"]: line for line in bench_registration(1, lambda *at: None)["rows"]}
    for name in ("exact", "on", "contacts found"):
        counts = {rows[f"{name}, {how}"]["n"] for how in ("1 view", "2 views, true poses", "2 views, registered")}
        assert len(counts) == 1
        assert counts.pop() > 0
    assert rows["registration wrong, all angles"]["n"] == 2 * len(ANGLES)
    gain = rows["exact, 2 views, registered"]["value"] - rows["exact, 1 view"]["value"]
    assert rows["exact less 1 view, 2 views, registered"]["value"] == pytest.approx(gain)


def test_registrations_are_counted_by_angle() -> None:
    right, wrong = RegisteredPair(20, np.eye(4), 1.0, 0.004), RegisteredPair(45, np.eye(4), 1.0, 0.03)
    turned, refused = RegisteredPair(90, np.eye(4), 7.0, 0.0), RegisteredPair(90, None, np.nan, np.nan)
    assert [pair.is_wrong for pair in (right, wrong, turned, refused)] == [False, True, True, False]
    rows = {line["name"]: line for line in registration_rows([[right, wrong, turned], [right, right, refused]])}
    assert rows["registration refused, cameras 90° apart"]["value"] == 0.5
    assert rows["registration wrong, cameras 20° apart"]["value"] == 0.0
    assert rows["registration wrong, all angles"]["value"] == pytest.approx(2 / 6)
    assert rows["registration error of shift, median, cameras 20° apart"]["value"] == pytest.approx(4.0)
    assert rows["registration error of turn, 95th percentile, cameras 90° apart"]["n"] == 1
