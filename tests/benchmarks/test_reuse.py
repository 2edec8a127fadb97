"""The benchmark of policy reuse: like work by all, and its contract without the outside programs."""

import numpy as np
import pytest

from benchmarks import reuse, reuse_users
from benchmarks.peers.bandits import PEERS, installed
from benchmarks.reuse import bench_reuse
from tests.benchmarks.contract import checked


@pytest.fixture
def short(monkeypatch):
    """Sizes at which the whole benchmark takes seconds, and no outside program."""
    monkeypatch.setattr(reuse, "SIGNALS", 6)
    monkeypatch.setattr(reuse, "SIZES", (12, 68))
    monkeypatch.setattr(reuse, "TASKS", 1)
    monkeypatch.setattr(reuse_users, "USERS", 3000)
    monkeypatch.setattr(reuse_users, "AT_ONCE", 1000)
    monkeypatch.setattr(reuse, "installed", lambda name: False)


def test_the_answer_keeps_its_contract_without_the_outside_programs(short):
    told = []
    result = bench_reuse(2, lambda *at: told.append(at))
    checked(result, told)
    empty = {line["name"] for line in result["rows"] if line["value"] is None}
    assert empty == {f"an episode, {name}" for name in PEERS}
    undecided = {goal["name"] for goal in result["goals"] if goal["met"] is None}
    assert undecided == {f"{name} / {reuse.SAMPLING}" for name in PEERS}
    goals = {goal["name"]: goal["measured"] for goal in result["goals"]}
    values = {line["name"]: line["value"] for line in result["rows"]}
    assert len(goals) == 2 + 3 + 2 + 3 + 2
    assert goals["belief entropy, 68 x 68 x 6, us"] == values["belief entropy, 68 x 68 x 6"]
    assert goals["users, sampling, uncertain models, M/s"] == values["users, sampling, uncertain models"]
    # A belief of 68 types in single precision, and whether an episode has begun.
    assert values["memory a user, exact models"] >= 68 * 4 + 1
    assert goals["README's example in a fresh process: imports of Numba and SciPy"] == 0


@pytest.mark.parametrize("name", PEERS)
def test_a_peer_learns(name):
    package, make = PEERS[name]
    if not installed(package):
        pytest.skip(f"{package} is not installed")
    select, update = make(np.zeros(3), 0)
    chosen = []
    for _ in range(300):
        policy = select()
        update(policy, [-1.0, 1.0, -1.0][policy])
        chosen.append(policy)
    assert chosen[-100:].count(1) > 60
