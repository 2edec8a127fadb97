"""Training and play of many: against one at a time, and what is learnt from counts."""

import numpy as np
import pytest

from lifelore.core.errors import LifeloreError
from lifelore.core.streams import stream
from lifelore.domains.ball_game.ball_game import LossScale, ball_game
from lifelore.interaction.baselines.exp3 import EXP3
from reproduction.chapter4.ball_game.games import Game, check_games, choices
from reproduction.chapter4.ball_game.learners import BeatLearner, exp3_by_episode
from reproduction.chapter4.ball_game.play import Learner, Players, losses_by_speed, play_all, train

GAME = ball_game()
SCALE = LossScale()
TRAINED = train(GAME, 12, 0)


def players(n=12, episodes=2, seed=3):
    return Players.drawn(np.arange(n) % 6, episodes, stream(seed, "test"))


class Kept(Learner):
    """A speed for each player and episode."""

    def __init__(self, speeds):
        self.speeds = speeds

    def select(self, balls, episode):
        return self.speeds[:, episode]

    def observe(self, speed, moves):
        raise AssertionError


def test_a_speed_kept_for_an_episode_loses_what_the_table_says():
    everyone = players()
    losses = losses_by_speed(GAME, everyone, SCALE)
    assert losses.shape == (12, 2, 5)
    speeds = np.random.default_rng(0).integers(5, size=(12, 2))
    lost = SCALE.loss(*play_all(GAME, everyone, Kept(speeds), SCALE))
    expected = np.take_along_axis(losses, speeds[:, :, None], axis=2)[:, :, 0]
    np.testing.assert_array_equal(lost, expected)


def test_exp3_by_episode_is_exp3_on_the_table():
    losses = np.random.default_rng(0).uniform(0, 2, (7, 5, 3))
    lost = exp3_by_episode(losses, 2.0, np.random.default_rng(8))
    arms = EXP3(3, horizon=5, scale=(-2.0, 0.0), n_tasks=7, seed=np.random.default_rng(8))
    for episode in range(5):
        chosen = arms.select()
        assert lost[:, episode].tolist() == losses[np.arange(7), episode, chosen].tolist()
        arms.update(chosen, -losses[np.arange(7), episode, chosen])


def test_beat_learner_knows_types_that_it_is_told():
    everyone = players(60, 1)
    told = np.eye(6)[everyone.kinds]
    value = TRAINED.value(SCALE)
    learner = BeatLearner(TRAINED.library(SCALE), 60, prior=told)
    lost = SCALE.loss(*play_all(GAME, everyone, learner, SCALE))
    best = losses_by_speed(GAME, everyone, SCALE)[np.arange(60), :, value.argmax(axis=1)[everyone.kinds]]
    np.testing.assert_array_equal(lost, best)


def test_the_type_named_halfway_through_the_first_episode():
    everyone = players(12, 2)
    told = np.eye(6)[everyone.kinds]
    learner = BeatLearner(TRAINED.library(SCALE), 12, prior=told)
    lengths = play_all(GAME, everyone, learner, SCALE).steps[:, 0]
    assert len(learner.named) == lengths.max()  # nothing of the second episode
    assert learner.named_halfway(lengths).tolist() == everyone.kinds.tolist()
    learner.named = [np.full(12, step, np.int8) for step in range(100)]
    # Of 7 steps half are made after the fourth, whose number is 3.
    assert learner.named_halfway(np.arange(12) + 1).tolist() == [0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 5, 5]


def test_games_by_their_words():
    careless = Game.parsed("blobs, r = b, careless, stays").game
    assert (careless.radius_share, careless.care, careless.blocked) == (1.0, 0.0, "stays")
    plain = Game.parsed("s-maze 160").game
    assert (plain.radius_share, plain.care, plain.blocked) == (GAME.radius_share, GAME.care, GAME.blocked)
    assert choices("s-maze 110, stays", "maxima") == {
        "layout": "s-maze 110", "radius": "r = b/2", "player": "careful", "blocked": "stays",
        "normalisation": "maxima",
    }  # fmt: skip
    for words, rule in (("moon", "unknown layout"), ("blobs, bounces", "a layout, then any of r = b, careless")):
        with pytest.raises(LifeloreError, match=rule):
            check_games({"games": [words]})
