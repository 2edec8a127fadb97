"""The learners that are compared in the ball game: BEAT and EXP-3. Thesis: §4.8.5."""

from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.interaction.adaptation.beat import rule_at
from lifelore.interaction.baselines.exp3 import EXP3
from lifelore.interaction.beliefs.belief import log_prior
from lifelore.interaction.beliefs.type_dynamics import TypeDynamics
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.reuse.reuse_algorithm import ReuseAlgorithm
from reproduction.chapter4.ball_game.play import Floats, Ints, Learner, Moves
from reproduction.chapter4.ball_game.players import Balls


class BeatLearner(Learner):
    """BEAT for all players, a row each; it records the type that it names after each step of the first episode.

    Parameters
    ----------
    library : PolicyLibrary
        Types × speeds, whose signals are moves.
    n_players : int
    prior : (n_types,) or (n_players, n_types) float, optional
    epsilon : float or str, as for `Beat`
    seed : numpy generator

    Attributes
    ----------
    named : list of (n_players,) int8
        The most likely type after each step of the first episode; who has finished keeps hers.
    """

    watches: ClassVar[bool] = True

    def __init__(
        self,
        library: PolicyLibrary,
        n_players: int,
        *,
        prior: ArrayLike | None = None,
        epsilon: float | str = 0.0,
        seed: int | np.random.Generator = 0,
    ) -> None:
        static = TypeDynamics.static()
        self.players = ReuseAlgorithm(library, n_players, dynamics=static, models="plug-in")
        if prior is not None:
            self.players.log_belief[:] = log_prior(prior)
        self.named: list[NDArray[np.int8]] = []
        self._epsilon, self._step, self._first = epsilon, 0, True
        self._generator = np.random.default_rng(seed)
        self._every = np.arange(n_players)

    def select(self, balls: Balls, episode: int) -> Ints:
        return self.players.select(self._every, rule_at(self._epsilon, self._step, episode), self._generator)[0]

    def observe(self, speed: Ints, moves: Moves) -> None:
        self.players.observe(moves.rows, speed[moves.rows], moves.signal[moves.rows])
        self._step += 1
        if self._first:
            self.named.append(self.players.log_belief.argmax(axis=1).astype(np.int8))

    def end_episode(self, speed: Ints, loss: Floats) -> None:
        self._first = False

    def named_halfway(self, lengths: Ints) -> NDArray[np.int8]:
        """The type named half-way through each player's first episode of `lengths` steps, (n_players,)."""
        return np.array(self.named)[-(-lengths // 2) - 1, self._every]


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


def exp3_by_episode(losses: Floats, worst: float, generator: np.random.Generator) -> Floats:
    """Losses of EXP-3 whose pulls are whole episodes, (n_players, episodes).

    A speed held for one episode has the same loss as when it is held throughout, so nothing is played again.

    Parameters
    ----------
    losses : (n_players, episodes, n_speeds) float
        At constant speeds.
    worst : float
        Loss that pays 0.
    generator : numpy generator
    """
    n, episodes, n_speeds = losses.shape
    arms = EXP3(n_speeds, horizon=episodes, scale=(-worst, 0.0), n_tasks=n, seed=generator)
    lost = np.empty((n, episodes))
    for episode in range(episodes):
        speed = arms.select()
        lost[:, episode] = losses[np.arange(n), episode, speed]
        arms.update(speed, -np.minimum(lost[:, episode], worst))
    return lost
