"""Worlds whose episodes are rounds of one choice each: a policy, its signal and its pay, for the same hidden type.

A round is a golf shot, a call, a deployment, or a whole game of Pacman or of the ball game. A policy is selected
before each round, so that the belief changes within the episode.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from lifelore.core.streams import stream
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.signals.likelihood_signal import LikelihoodSignal
from reproduction.chapter5.c5_09_switching.agents import Player
from reproduction.chapter5.c5_09_switching.schedules import Lived

Array = NDArray[np.float64]


class Shown(NamedTuple):
    """A round: its signal, its pay as the library's performance model knows it, and its score.

    Scores of the rounds decide how the episode ends; None where they are the pays.
    """

    signal: Any
    pay: float
    score: float | None = None


Round = Callable[[np.random.Generator, int, int], Shown]
"""``round_of(generator, type, policy)``: a round."""
N_OUTCOMES, TRIALS = 3, 600
"""Categories in which episodes end, and episodes behind the scores that divide them."""


@dataclass(frozen=True, eq=False)
class RoundWorld:
    """A world of rounds; T types, P policies.

    Parameters
    ----------
    library : PolicyLibrary
    round_of : callable
        See `Round`.
    gain : (T, P) float
        What a round is expected to gain, the measure of a claim; its zero is the world's own choice.
    n_rounds : int
        Rounds of an episode.
    """

    library: PolicyLibrary
    round_of: Round
    gain: Array
    n_rounds: int

    outcomes = tuple(range(N_OUTCOMES))

    @property
    def n_types(self) -> int:
        """T."""
        return self.library.n_types

    @cached_property
    def edges(self) -> Array:
        """Scores of an episode between its outcomes: thirds of the episodes of best policies, all types alike."""
        generator, best = stream(0, "C5.9", "outcomes"), self.library.performance.mean.argmax(axis=1)
        types = generator.integers(self.n_types, size=TRIALS).tolist()
        scores = [
            sum(score_of(self.round_of(generator, type_, int(best[type_]))) for _ in range(self.n_rounds))
            for type_ in types
        ]
        return np.quantile(scores, np.arange(1, N_OUTCOMES) / N_OUTCOMES)

    def play(self, generator: np.random.Generator, type_: int, agent: Player) -> Lived:
        """An episode of an agent that selects a policy before each round; outcomes are thirds, 0 the least."""
        gain, score, policy, pay = 0.0, 0.0, 0, 0.0
        for _ in range(self.n_rounds):
            policy = agent.select()
            shown = self.round_of(generator, type_, policy)
            pay = shown.pay
            agent.observe(policy, shown.signal, pay)
            gain, score = gain + float(self.gain[type_, policy]), score + score_of(shown)
        outcome = int(np.searchsorted(self.edges, score, side="right"))
        agent.end_episode(outcome, pay)
        return Lived(gain, outcome, policy)


def score_of(shown: Shown) -> float:
    """The score of a round."""
    return shown.pay if shown.score is None else shown.score


@dataclass(frozen=True, eq=False)
class Recorded:
    """Recorded games of every pair, for worlds that are slow to play; a signal is the number of a game.

    Parameters
    ----------
    pay : (T, P, n) float
    log_likelihood : (T, P, n, T) float
        Of what each game showed, by type; a game's own type comes first.
    """

    pay: Array
    log_likelihood: Array

    def signal(self) -> LikelihoodSignal:
        """The signal model of numbers of games."""
        by_number = self.log_likelihood.reshape(-1, self.log_likelihood.shape[-1])
        return LikelihoodSignal(lambda policy, game: by_number[game], *self.pay.shape[:2], sample=self.sample)

    def sample(self, generator: np.random.Generator, type_: int, policy: int) -> int:
        """The number of a recorded game."""
        n_policies, n = self.pay.shape[1:]
        return (type_ * n_policies + policy) * n + int(generator.integers(n))

    def round_of(self, generator: np.random.Generator, type_: int, policy: int) -> Shown:
        """A game of the pair, each as likely."""
        game = self.sample(generator, type_, policy)
        return Shown(game, float(self.pay.flat[game]))
