"""Four small games against an opponent of an unknown type; a policy of the library is the best response to a type.

A game is a few moves of both players at once. A state holds what the next moves depend on, an opponent's type is
its probabilities of moves by state, and an episode is won where the sum of its pays is above 0. Each move of the
opponent is a signal, so that the belief, and with it the policy, changes within the episode.
"""

from collections import Counter
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.outcomes.categorical_outcomes import CategoricalOutcomes
from lifelore.interaction.signals.likelihood_signal import LikelihoodSignal
from reproduction.chapter5.c5_09_switching.agents import Player
from reproduction.chapter5.c5_09_switching.schedules import Lived

Array = NDArray[np.float64]
WON, DRAWN, LOST = "won", "drawn", "lost"
"""How an episode ends."""


@dataclass(frozen=True, eq=False)
class MatrixGame:
    """A game of a few moves; S states, A actions, M moves of the opponent, T types.

    Parameters
    ----------
    moves : (T, S, M) float
        Probability of each move of the opponent by type and state, above 0; rows sum to 1.
    following : (S, A, M) int
        The state after an action and a move.
    pay : (S, A, M) int
        What they pay the agent.
    n_steps : int
        Moves of an episode.
    over : (S,) bool
        States in which an episode ends early.

    Episodes start in state 0.
    """

    moves: Array
    following: NDArray[np.int64]
    pay: NDArray[np.int64]
    n_steps: int
    over: NDArray[np.bool_]

    @property
    def n_types(self) -> int:
        """T: as many types as policies."""
        return len(self.moves)

    outcomes = (LOST, DRAWN, WON)

    @cached_property
    def policies(self) -> NDArray[np.int64]:
        """The action of the best response to each type by step and state, (T, n_steps, S): dynamic programming."""
        value = np.zeros(self.moves.shape[:2])
        actions = np.empty((self.n_types, self.n_steps, len(self.over)), np.int64)
        for step in reversed(range(self.n_steps)):
            later = np.where(self.over, 0.0, value)[:, self.following]
            of_action = (self.moves[:, :, None, :] * (self.pay + later)).sum(axis=-1)
            actions[:, step], value = of_action.argmax(axis=-1), of_action.max(axis=-1)
        return actions

    @cached_property
    def win_probs(self) -> Array:
        """Probability that each policy wins an episode against each type, (T, T), exact."""
        every = range(self.n_types)
        return np.array([[self._win_prob(type_, policy) for policy in every] for type_ in every])

    def _win_prob(self, type_: int, policy: int) -> float:
        reached, ended = Counter({(0, 0): 1.0}), Counter[int]()
        for step in range(self.n_steps):
            after = Counter[tuple[int, int]]()
            for (state, score), prob in reached.items():
                action = self.policies[policy, step, state]
                for move, share in enumerate(self.moves[type_, state]):
                    state2 = int(self.following[state, action, move])
                    score2 = score + int(self.pay[state, action, move])
                    if self.over[state2]:
                        ended[score2] += prob * share
                    else:
                        after[state2, score2] += prob * share
            reached = after
        for (_, score), prob in reached.items():
            ended[score] += prob
        return sum(prob for score, prob in ended.items() if score > 0)

    @cached_property
    def library(self) -> PolicyLibrary:
        """Types × best responses: a win pays 1, and signals are pairs of a state and a move there."""
        log_moves = np.log(np.moveaxis(self.moves, 0, -1))
        signal = LikelihoodSignal(
            lambda policy, seen: log_moves[seen], self.n_types, self.n_types, sample=self.sample_signal
        )
        return PolicyLibrary(win_or_not(self.win_probs), signal)

    def sample_signal(self, generator: np.random.Generator, type_: int, policy: int) -> tuple[int, int]:
        """A state and a move that an episode shows at a step drawn at random."""
        state, last = 0, int(generator.integers(self.n_steps))
        for step in range(self.n_steps):
            action, move = self.policies[policy, step, state], self.draw_move(generator, type_, state)
            following = int(self.following[state, action, move])
            if step == last or self.over[following]:
                return state, move
            state = following
        raise AssertionError("an episode shows its last step at the latest")

    def draw_move(self, generator: np.random.Generator, type_: int, state: int) -> int:
        """A move of the opponent."""
        below = self.moves[type_, state].cumsum()[:-1]
        return int((generator.random() >= below).sum())

    def play(self, generator: np.random.Generator, type_: int, agent: Player) -> Lived:
        """An episode of an agent that selects a policy before each step; a win gains and pays 1."""
        state, score, policy = 0, 0, 0
        for step in range(self.n_steps):
            policy = agent.select()
            action, move = self.policies[policy, step, state], self.draw_move(generator, type_, state)
            agent.observe(policy, (state, move))
            score += int(self.pay[state, action, move])
            state = int(self.following[state, action, move])
            if self.over[state]:
                break
        outcome, won = WON if score > 0 else DRAWN if score == 0 else LOST, float(score > 0)
        agent.end_episode(outcome, won)
        return Lived(won, outcome, policy)


def win_or_not(prob: Array) -> CategoricalOutcomes:
    """Pays of 1 with probability `prob` (T, P), else 0."""
    return CategoricalOutcomes([0.0, 1.0], np.stack([1 - prob, prob], axis=-1))
