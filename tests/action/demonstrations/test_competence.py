"""Competence of demonstrators: by hand, and simulated people of known skill."""

import numpy as np
import pytest

from lifelore.action.demonstrations.competence import competence_by_steps
from lifelore.action.demonstrations.demonstrations import Demonstration
from lifelore.core import TERMINAL, Tables, stream
from reproduction.chapter3.c3_12_demonstrated_priors.run import person_policy, simulated_demonstration


def demonstration(agent, done, task="t") -> Demonstration:
    states, actions = np.array(done, np.int64).T
    return Demonstration(task, agent, states, actions)


def grid(side: int) -> tuple[Tables, np.ndarray]:
    """An open square with the goal in the far corner, and its best actions: every step down or right."""
    s = np.arange(side * side)
    row, column = s // side, s % side
    follow = np.stack([
        np.where(row > 0, s - side, s), np.where(row < side - 1, s + side, s),
        np.where(column < side - 1, s + 1, s), np.where(column > 0, s - 1, s),
    ], axis=1)  # fmt: skip
    best = np.stack([np.zeros(len(s), bool), row < side - 1, column < side - 1, np.zeros(len(s), bool)], axis=1)
    event = np.where(follow == len(s) - 1, TERMINAL, 0).astype(np.uint8)
    tables = Tables(
        follow[:, :, None].astype(np.int32), np.zeros((*follow.shape, 1)), event[:, :, None], np.ones(1),
        np.zeros(1, np.int32),
    )  # fmt: skip
    return tables, best


# ---- w(π) by steps -------------------------------------------------------------------------------------------


def test_by_steps_by_hand():
    # One of four actions is best in states 0 and 1; all are in state 2, none in state 3: those tell nothing.
    best = np.array([[1, 0, 0, 0], [0, 1, 0, 0], [1, 1, 1, 1], [0, 0, 0, 0]], bool)
    ann = demonstration("ann", [(0, 0), (1, 1), (2, 3), (3, 0)])
    bob = demonstration("bob", [(0, 0), (1, 0), (0, 1), (1, 1), (2, 0)])
    cat = demonstration("cat", [(0, 3), (1, 3)])
    dan = demonstration("dan", [(2, 0), (3, 1)])
    found = competence_by_steps([ann, bob, cat, dan], {"t": best}.__getitem__)
    # bob: (2 - 1) / (4 - 1); cat is worse than blind.
    assert found == pytest.approx({"ann": 1.0, "bob": 1 / 3, "cat": 0.0, "dan": 0.0})


@pytest.mark.parametrize("skill", [0.0, 0.3, 0.7, 1.0])
def test_by_steps_recovers_the_skill_of_simulated_people(skill):
    # h - e over n - e has the mean `skill` for this kind of person: P(best) = skill + (1 - skill) · share. With n
    # steps its deviation is at most ½ √n / (n (1 - ½)) = 1 / √n; four of them.
    tables, best = grid(12)
    random = stream(0, "skill")
    told = []
    while sum(len(one.states) for one in told) < 4000:
        one = simulated_demonstration(tables, best, skill, random, task="t", agent="ann", most_steps=10**5)
        assert one is not None
        told.append(one)
    n = sum(len(one.states) for one in told)
    assert competence_by_steps(told, lambda task: best)["ann"] == pytest.approx(skill, abs=4 / np.sqrt(n))


# ---- simulated people ----------------------------------------------------------------------------------------


def test_a_persons_policy_by_hand():
    best = [[True, True, False, False], [True, False, False, False], [False, False, False, False]]
    assert person_policy(best, 0.6).tolist() == pytest.approx(
        np.array([[0.4, 0.4, 0.1, 0.1], [0.7, 0.1, 0.1, 0.1], [0.25] * 4])
    )


def test_an_expert_takes_a_shortest_way():
    tables, best = grid(6)
    one = simulated_demonstration(tables, best, 1.0, stream(2), task="t", agent="ann", most_steps=1000)
    assert (one.task, one.agent, len(one.states), one.states[0]) == ("t", "ann", 10, 0)
    assert best[one.states, one.actions].all()
    followed = tables.next_state[one.states, one.actions, 0]
    assert np.array_equal(followed[:-1], one.states[1:])
    assert followed[-1] == 35
