"""Many players of the ball game and a learner that sets their speeds: training, then episodes to be judged.

All players move step by step together. Methods that are compared get the same players: types, noises and the
random numbers of every episode. Thesis: §4.8.5.1.
"""

from typing import ClassVar, NamedTuple

import numpy as np
from numpy.typing import NDArray

from lifelore.core.streams import stream
from lifelore.domains.ball_game.ball_game import BallGame, LossScale, draw_sigma
from lifelore.interaction.library.policy_library import PolicyLibrary
from reproduction.chapter4.ball_game.moves import N_SIGNALS, move_signal, read_moves
from reproduction.chapter4.ball_game.players import Balls, advance, new_balls, random_states

Ints = NDArray[np.int64]
Floats = NDArray[np.float64]


class Trained(NamedTuple):
    """Counts from training episodes with known types.

    steps, hits : (n_types, n_speeds, episodes) int64
    signals : (n_speeds, N_SIGNALS, n_types) float64, counts of moves
    """

    steps: Ints
    hits: Ints
    signals: Floats

    def scale(self, normalisation: str) -> LossScale:
        """The scale of losses, see `scale_of`."""
        return scale_of(normalisation, self.steps, self.hits)

    def value(self, scale: LossScale) -> Floats:
        """V: minus the mean loss of each type at each speed, (n_types, n_speeds)."""
        return -scale.loss(self.steps, self.hits).mean(axis=-1)

    def library(self, scale: LossScale) -> PolicyLibrary:
        """Types × speeds as a policy library whose signals are moves."""
        return PolicyLibrary.from_samples(-scale.loss(self.steps, self.hits), signal=move_signal(self.signals))


def scale_of(normalisation: str, steps: Ints, hits: Ints) -> LossScale:
    """How losses are normalised: ``"fixed"`` T/400 + C/20, or ``"maxima"`` of these episodes."""
    return LossScale() if normalisation == "fixed" else LossScale.from_episodes(steps, hits)


class Moves(NamedTuple):
    """Moves of all players in one step: the `rows` of those who play, and `signal`, -1 of the others."""

    rows: Ints
    signal: Ints


class Learner:
    """Sets the speeds of all players at once, row by row; `observe` is called only if it `watches`."""

    watches: ClassVar[bool] = False

    def select(self, balls: Balls, episode: int) -> Ints:
        raise NotImplementedError

    def observe(self, speed: Ints, moves: Moves) -> None:
        """Learn from a step; by default nothing."""

    def end_episode(self, speed: Ints, loss: Floats) -> None:
        """Learn from an episode; by default nothing."""


class Players(NamedTuple):
    """Players to be judged.

    kinds : (n,) int64
    sigma : (n, episodes) float64
    random : (n, episodes, 2) uint64
    """

    kinds: Ints
    sigma: Floats
    random: NDArray[np.uint64]

    @classmethod
    def drawn(cls, kinds: Ints, episodes: int, generator: np.random.Generator) -> "Players":
        """With noises and random numbers of their own."""
        shape = (len(kinds), episodes)
        return cls(np.asarray(kinds, np.int64), draw_sigma(generator, shape), random_states(generator, shape))


class Played(NamedTuple):
    """Steps and collisions of every player's episodes, (n, episodes) int64."""

    steps: Ints
    hits: Ints


def train(game: BallGame, episodes: int, seed: int) -> Trained:
    """Play `episodes` of every type at every speed and count the moves."""
    generator = stream(seed, "ball game", "training", game.layout.name)
    pairs = np.mgrid[: game.n_types, : game.n_speeds].reshape(2, -1).repeat(episodes, axis=1)
    players = Players.drawn(pairs[0], 1, generator)
    counter = MoveCounter(pairs[1], pairs[0], np.zeros((game.n_speeds, N_SIGNALS, game.n_types)))
    played = play_all(game, players, counter, LossScale())
    shape = (game.n_types, game.n_speeds, episodes)
    return Trained(played.steps.reshape(shape), played.hits.reshape(shape), counter.counts)


def play_all(game: BallGame, players: Players, learner: Learner, scale: LossScale) -> Played:
    """All players' episodes under a learner."""
    n, episodes = players.sigma.shape
    heading, before, signal = np.empty(n, np.int64), np.empty((n, 2), np.int64), np.empty(n, np.int64)
    steps, hits = np.empty((2, n, episodes), np.int64)
    for episode in range(episodes):
        balls = new_balls(game, players.kinds, players.sigma[:, episode], players.random[:, episode])
        speed = np.zeros(n, np.int64)
        while balls.playing.any():
            speed = np.where(balls.playing, learner.select(balls, episode), speed)
            advance(game.field, balls, speed, heading, before)
            if learner.watches:
                read_moves(game.field, before, heading, speed, balls.x, balls.y, signal)
                learner.observe(speed, Moves(np.flatnonzero(heading >= 0), signal))
        steps[:, episode], hits[:, episode] = balls.steps, balls.hits
        learner.end_episode(speed, scale.loss(balls.steps, balls.hits))
    return Played(steps, hits)


class FixedSpeeds(Learner):
    """No learner: every player keeps a speed of her own, (n,) int64."""

    def __init__(self, speeds: Ints) -> None:
        self.speeds = np.asarray(speeds, np.int64)

    def select(self, balls: Balls, episode: int) -> Ints:
        return self.speeds


class MoveCounter(FixedSpeeds):
    """Counts the moves of players of known types into `counts` (n_speeds, N_SIGNALS, n_types)."""

    watches: ClassVar[bool] = True

    def __init__(self, speeds: Ints, kinds: Ints, counts: Floats) -> None:
        super().__init__(speeds)
        self.kinds, self.counts = kinds, counts

    def observe(self, speed: Ints, moves: Moves) -> None:
        rows = moves.rows
        np.add.at(self.counts, (speed[rows], moves.signal[rows], self.kinds[rows]), 1.0)


def play_speeds(game: BallGame, players: Players) -> list[Played]:
    """All players' episodes at each constant speed."""
    fixed = (FixedSpeeds(np.full(len(players.kinds), z)) for z in range(game.n_speeds))
    return [play_all(game, players, learner, LossScale()) for learner in fixed]


def losses_by_speed(game: BallGame, players: Players, scale: LossScale) -> Floats:
    """Losses of all players' episodes at each constant speed, (n, episodes, n_speeds)."""
    return np.stack([scale.loss(*played) for played in play_speeds(game, players)], axis=-1)
