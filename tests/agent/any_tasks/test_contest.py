import numpy as np

from lifelore.agent.any_tasks.contest import Contest


class Player:
    """Notes what it is told."""

    def __init__(self):
        self.steps, self.episodes = 0, 0

    def observe(self, step):
        self.steps += 1

    def end_episode(self, steps, earned, ended):
        self.episodes += 1

    def policy(self):
        return self


def turns(pays, hope, patience=4, n=12):
    """Whose turn it is in each episode, where the players earn `pays`."""
    contest = Contest(Player(), Player(), hope, patience)
    found = []
    for _ in range(n):
        found.append(contest.turn)
        contest.observe(None)
        contest.end_episode([], pays[contest.turn], True)
    assert all(player.steps == player.episodes == n for player in contest.players)
    return found, contest


def test_a_good_seed_plays_on():
    found, contest = turns((5.0, 1.0), hope=4.0)
    assert found == [0] * 12
    assert contest.policy() is contest.players[0]


def test_a_bad_seed_gives_way_and_comes_back_when_patience_is_over():
    found, _ = turns((1.0, 0.0), hope=4.0)
    assert found == [0] + [1] * 4 + [0] * 7
    found, contest = turns((1.0, 3.0), hope=4.0)
    assert found == [0] + [1] * 11
    assert contest.policy() is contest.players[1]
    assert contest.fresh_returns == [3.0] * 11


def test_nothing_known_of_fresh_learners_is_hope():
    assert turns((1.0, 0.0), hope=np.inf)[0][:5] == [0, 1, 1, 1, 1]
