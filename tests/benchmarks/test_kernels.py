"""The benchmark of kernels: its contract, like work by all, and what happens without gcc."""

import numpy as np
import pytest

from benchmarks import kernels
from benchmarks.kernels import bench_kernels
from benchmarks.lattice import new_case, run_kernel
from benchmarks.peers import c_loop
from benchmarks.peers.gymnasium_loop import short_textbook_rate, textbook_rate
from benchmarks.peers.list_loop import short_tuned_rate, tuned_rate
from tests.benchmarks.contract import checked


@pytest.fixture
def small(monkeypatch):
    """The whole benchmark at a size for tests."""
    monkeypatch.setattr(kernels, "textbook_rate", lambda: textbook_rate(2000))
    monkeypatch.setattr(kernels, "short_textbook_rate", lambda: short_textbook_rate(2000))
    monkeypatch.setattr(kernels, "tuned_rate", lambda: tuned_rate(2000))
    monkeypatch.setattr(kernels, "short_tuned_rate", lambda: short_tuned_rate(2000))


def test_the_answer_keeps_its_contract(small):
    told = []
    result = bench_kernels(1, lambda *at: told.append(at))
    rows = checked(result, told)
    for goal in result["goals"]:
        if goal["name"].startswith("kernel / ") and goal["measured"] is not None:
            expected = rows["kernel"]["value"] / rows[goal["name"].removeprefix("kernel / ")]["value"]
            assert goal["measured"] == pytest.approx(expected)
            assert goal["met"] == (expected >= float(goal["goal"].removeprefix(">= ")))


@pytest.mark.skipif(c_loop.shutil.which("gcc") is None, reason="gcc is not installed")
def test_the_c_twin_learns_the_same_bits():
    loop = c_loop.built_c_loop()
    ours, theirs = new_case(300, seed=4), new_case(300, seed=4)
    assert run_kernel(ours) == loop.run(theirs) > 3000
    for a, b in zip((*ours.learner[:4], *ours.curve), (*theirs.learner[:4], *theirs.curve), strict=True):
        assert np.array_equal(a, b)
    assert theirs.learner.q.any()
    assert theirs.curve.collisions.any()
