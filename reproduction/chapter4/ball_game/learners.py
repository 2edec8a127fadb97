"""The learners that are compared in the ball game: BEAT and EXP-3, as printed and tuned. Thesis: §4.8.5."""

from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike

from lifelore.domains.ball_game.simulated_player import Balls
from lifelore.interaction.adaptation.beat import Exploration, epsilon_of
from lifelore.interaction.adaptation.beat_users import BeatUsers
from lifelore.interaction.baselines.exp3 import EXP3
from reproduction.chapter4.ball_game.play import Floats, Ints, Learner, Moves


class BeatLearner(Learner):
    """BEAT for all players; ε may depend on the episode and on the player's own steps.

    Parameters
    ----------
    value, signal_table : arrays
        See `BeatUsers`.
    n_players : int
    prior : (n_types,) or (n_players, n_types) float, optional
    epsilon : see `beat.Exploration`
    command_table : (n_speeds, n_commands, n_types) float, optional
        The second factor of the likelihood: probabilities of commands by place.
    seed : numpy generator
    """

    watches: ClassVar[bool] = True

    def __init__(
        self,
        value: Floats,
        signal_table: Floats,
        n_players: int,
        *,
        prior: ArrayLike | None = None,
        epsilon: Exploration = 0.0,
        command_table: Floats | None = None,
        seed: int | np.random.Generator = 0,
    ) -> None:
        self.users = BeatUsers(value, signal_table, n_players, prior=prior, seed=seed)
        self._commands = command_table
        self._epsilon, self._step = epsilon_of(epsilon), 0
        self._every = np.arange(n_players)

    def select(self, balls: Balls, episode: int) -> Ints:
        return self.users.select(self._every, self._epsilon(self._step, episode))

    def observe(self, speed: Ints, moves: Moves) -> None:
        rows = moves.rows
        extra = None if self._commands is None else self._commands[speed[rows], moves.command[rows]]
        self.users.update(rows, speed[rows], moves.signal[rows], extra)
        self._step += 1


class PrintedExp3(Learner):
    """EXP-3 as printed: a pull is one step (k = 1), and only the step that reaches the goal pays.

    The payoff is minus the loss, brought into [0, 1] by the worst loss seen in training. The steps before pay 0,
    which leaves every weight as it is. γ is that of the known bound for the expected number of steps.
    """

    def __init__(self, n_players: int, n_speeds: int, worst: float, horizon: int, seed: np.random.Generator):
        self._arms = EXP3(n_speeds, horizon=horizon, scale=(-worst, 0.0), n_tasks=n_players, seed=seed)
        self._worst = worst

    def select(self, balls: Balls, episode: int) -> Ints:
        return self._arms.select()

    def end_episode(self, speed: Ints, loss: Floats) -> None:
        self._arms.update(speed, -np.minimum(loss, self._worst))


def exp3_by_episode(losses: Floats, gamma: float, worst: float, generator: np.random.Generator) -> Floats:
    """EXP-3 whose pulls are whole episodes.

    A speed held for one episode has the same loss as when it is held throughout, so nothing is played again.

    Parameters
    ----------
    losses : (n_players, episodes, n_speeds) float
        At constant speeds.
    gamma : float
        Share of uniform play, in (0, 1].
    worst : float
        Loss that pays 0.
    generator : numpy generator

    Returns
    -------
    lost : (n_players, episodes) float64
    """
    n, episodes, n_speeds = losses.shape
    arms = EXP3(n_speeds, gamma=gamma, scale=(-worst, 0.0), n_tasks=n, seed=generator)
    lost = np.empty((n, episodes))
    for episode in range(episodes):
        speed = arms.select()
        lost[:, episode] = losses[np.arange(n), episode, speed]
        arms.update(speed, -np.minimum(lost[:, episode], worst))
    return lost


def tuned_gamma(losses: Floats, gammas: list[float], worst: float, generator: np.random.Generator) -> float:
    """The γ that loses least on `losses` of players set aside for tuning, (n, episodes, n_speeds)."""
    mean = [exp3_by_episode(losses, gamma, worst, generator).mean() for gamma in gammas]
    return gammas[int(np.argmin(mean))]
