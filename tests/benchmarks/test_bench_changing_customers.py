"""`bench changing_customers`, small: who is told, which episodes count, and the rows."""

import numpy as np
import pytest

from benchmarks import BENCHES
from benchmarks.agent import changing_customers as case


def test_spans_count_every_later_episode_once():
    since = np.array([case.since_change(list(types)) for types in ("aaab", "aaaa", "abca", "abbb")])
    assert since.tolist() == [[-3, -2, -1, 0], [case.NEVER] * 4, [-1, 0, 0, 0], [-1, 0, 1, 2]]
    episode = np.broadcast_to(np.arange(4), since.shape)
    parts = [chosen(since, episode) for name, chosen in case.SPANS.items() if name != "all episodes"]
    np.testing.assert_array_equal(np.sum(parts, axis=0), 1)


@pytest.mark.slow
def test_rows_and_goals(monkeypatch, tmp_path):
    for name, value in {"N_TASKS": 3, "N_EPISODES": 3, "KNOWING": 1, "CHANGE": 0.6, "LEAST_REPEATS": 1}.items():
        monkeypatch.setattr(case, name, value)
    steps = []
    document = case.bench_changing_customers(1, lambda *at: steps.append(at[:2]), tmp_path)
    assert BENCHES["changing_customers"] == "agent"
    assert steps == [(1, 2), (2, 2)]
    rows = {row["name"]: row["value"] for row in document["rows"]}
    assert len(rows) == len(document["rows"])
    own, static = (rows[f"customers change, all episodes: {name}"] for name in (case.FOLLOWING, case.STATIC))
    assert rows["customers change, all episodes: static, more than following"] == pytest.approx(static - own)
    assert min(value for name, value in rows.items() if "more than" not in name) > -1e-9
    # Told of changes, and answered surely: the second episode of a span is right, unless it is spent on trying.
    told = "customers change, first episodes: told of changes"
    assert rows[told] >= 0
    assert 0 <= rows["changes that were found in their episode, of those that came"] <= 1
    assert [goal["goal"] for goal in document["goals"]] == [">= 0.0", ">= 0.0", "<= 0.1"]
    assert (tmp_path / "bench_changing_customers.png").stat().st_size > 5000
