"""Many players of the ball game and a learner that sets their speeds: training, then episodes to be judged.

All players move step by step together. Methods that are compared get the same players: types, noises and the
random numbers of every episode. Thesis: §4.8.5.1.
"""

from collections.abc import Callable
from itertools import combinations
from typing import ClassVar, NamedTuple

import numpy as np
from numpy.typing import NDArray

from lifelore.core.streams import stream
from lifelore.domains.ball_game.ball_game import MAX_STEPS, BallGame, LossScale, draw_sigma
from lifelore.domains.ball_game.moves import N_OUTCOMES, N_SIGNALS, command_place, read_moves
from lifelore.domains.ball_game.simulated_player import Balls, advance, new_balls, random_states
from lifelore.interaction.adaptation.move_model import PSEUDO_COUNT, log_shares

PLACES = 20 * 20 * 4

Ints = NDArray[np.int64]
Floats = NDArray[np.float64]


class Trained(NamedTuple):
    """Counts from training episodes with known types.

    steps, hits : (n_types, n_speeds, episodes) int64
    signals : (n_speeds, N_SIGNALS, n_types) float64, counts of moves
    commands : (n_speeds, PLACES, n_types) float64, counts of commands by place
    """

    steps: Ints
    hits: Ints
    signals: Floats
    commands: Floats

    def scale(self, normalisation: str) -> LossScale:
        """The scale of losses, see `scale_of`."""
        return scale_of(normalisation, self.steps, self.hits)

    def value(self, scale: LossScale) -> Floats:
        """V: minus the mean loss of each type at each speed, (n_types, n_speeds)."""
        return -scale.loss(self.steps, self.hits).mean(axis=-1)

    def signal_table(self, pseudo_count: float = PSEUDO_COUNT) -> Floats:
        """Log T(s' | s, a; type) in classes, (n_speeds, N_SIGNALS, n_types)."""
        return log_shares(self.signals, N_OUTCOMES, 4 * pseudo_count / N_OUTCOMES)

    def command_table(self, pseudo_count: float = PSEUDO_COUNT) -> Floats:
        """Log P(a | place; type), (n_speeds, PLACES, n_types)."""
        return log_shares(self.commands, 4, pseudo_count)


def scale_of(normalisation: str, steps: Ints, hits: Ints) -> LossScale:
    """How losses are normalised: ``"fixed"`` T/400 + C/20, or ``"maxima"`` of these episodes."""
    return LossScale() if normalisation == "fixed" else LossScale.from_episodes(steps, hits)


class Moves(NamedTuple):
    """Moves of all players in one step; -1 in `signal` and `command` of players who do not play."""

    rows: Ints
    signal: Ints
    command: Ints


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

    def between(self, begin: int, end: int | None = None) -> "Players":
        """The same players in some of their episodes."""
        return Players(self.kinds, self.sigma[:, begin:end], self.random[:, begin:end])


class Played(NamedTuple):
    """Steps and collisions of every player's episodes, (n, episodes) int64."""

    steps: Ints
    hits: Ints


def train(game: BallGame, episodes: int, seed: int) -> Trained:
    """Play `episodes` of every type at every speed and count the moves."""
    generator = stream(seed, "ball game", "training", game.layout.name)
    pairs = np.mgrid[: game.n_types, : game.n_speeds].reshape(2, -1).repeat(episodes, axis=1)
    players = Players.drawn(pairs[0], 1, generator)
    signals = np.zeros((game.n_speeds, N_SIGNALS, game.n_types))
    commands = np.zeros((game.n_speeds, PLACES, game.n_types))

    def count(balls: Balls, speed: Ints, moves: Moves) -> None:
        speed, kind = speed[moves.rows], balls.kind[moves.rows]
        np.add.at(signals, (speed, moves.signal[moves.rows], kind), 1.0)
        np.add.at(commands, (speed, moves.command[moves.rows], kind), 1.0)

    played = play_all(game, players, FixedSpeeds(pairs[1]), LossScale(), watch=count)
    shape = (game.n_types, game.n_speeds, episodes)
    return Trained(played.steps.reshape(shape), played.hits.reshape(shape), signals, commands)


def play_all(
    game: BallGame,
    players: Players,
    learner: Learner,
    scale: LossScale,
    *,
    lag: int = 0,
    max_steps: int = MAX_STEPS,
    watch: Callable[[Balls, Ints, Moves], None] | None = None,
) -> Played:
    """All players' episodes under a learner; `watch` sees every step after the learner has."""
    n, episodes = players.sigma.shape
    heading, before, signal = np.empty(n, np.int64), np.empty((n, 2), np.int64), np.empty(n, np.int64)
    steps, hits = np.empty((2, n, episodes), np.int64)
    for episode in range(episodes):
        balls = new_balls(game, players.kinds, players.sigma[:, episode], players.random[:, episode])
        speed = np.zeros(n, np.int64)
        while balls.playing.any():
            speed = np.where(balls.playing, learner.select(balls, episode), speed)
            advance(game.field, balls, speed, lag, max_steps, heading, before)
            if learner.watches or watch:
                read_moves(game.field, before, heading, speed, balls.x, balls.y, signal)
                moves = Moves(np.flatnonzero(heading >= 0), signal, command_place(before, heading))
                learner.observe(speed, moves)
                if watch:
                    watch(balls, speed, moves)
        steps[:, episode], hits[:, episode] = balls.steps, balls.hits
        learner.end_episode(speed, scale.loss(balls.steps, balls.hits))
    return Played(steps, hits)


class FixedSpeeds(Learner):
    """No learner: every player keeps a speed of her own, (n,) int64."""

    def __init__(self, speeds: Ints) -> None:
        self.speeds = np.asarray(speeds, np.int64)

    def select(self, balls: Balls, episode: int) -> Ints:
        return self.speeds


def play_speeds(game: BallGame, players: Players) -> list[Played]:
    """All players' episodes at each constant speed."""
    fixed = (FixedSpeeds(np.full(len(players.kinds), z)) for z in range(game.n_speeds))
    return [play_all(game, players, learner, LossScale()) for learner in fixed]


def losses_by_speed(game: BallGame, players: Players, scale: LossScale) -> Floats:
    """Losses of all players' episodes at each constant speed, (n, episodes, n_speeds)."""
    return np.stack([scale.loss(*played) for played in play_speeds(game, players)], axis=-1)


def populations(n_types: int) -> list[tuple[int, ...]]:
    """All populations: every set of types but the empty one, smaller ones first; 63 of six types."""
    return [p for size in range(1, n_types + 1) for p in combinations(range(n_types), size)]
