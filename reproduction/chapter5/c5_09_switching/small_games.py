"""Four small games against an opponent of an unknown type; a policy of the library is the best response to a type.

The games: rock-paper-scissors, penalties, battle of the sexes, a pursuit on a ring of five cells. An opponent
makes the usual move of its type with a probability of `HABIT`, else any other move, each as likely.

A game is a few moves of both players at once. A state holds what the next moves depend on, an opponent's type is
its probabilities of moves by state, and an episode is won where the sum of its pays is above 0. Each move of the
opponent is a signal, so that the belief, and with it the policy, changes within the episode.
"""

from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

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


HABIT = 0.75
"""Probability of the usual move; at 1 a single move reveals the type, and who knows the type always wins."""
STEPS = 9
"""Moves of an episode, but of a pursuit."""
RING, PURSUIT_STEPS = 5, 4
"""Cells of the ring, and moves of a pursuit; with more, everybody is caught."""
START, TOWARDS = 2, (0, -1, -1, 1, 1)
"""Distance at the start of a pursuit, in cells ahead, and the step that leads to the pursuer by distance."""


def rock_paper_scissors() -> MatrixGame:
    """Opponents prefer rock, paper or scissors, or what beats their own last move."""
    return _by_last_move(
        [[0, 0, 0, 0], [1, 1, 1, 1], [2, 2, 2, 2], [0, 1, 2, 0]], [[0, -1, 1], [1, 0, -1], [-1, 1, 0]]
    )


def penalties() -> MatrixGame:
    """Who guesses the side of a kick saves it; kickers prefer left, the middle or right, or alternate sides."""
    pay = 2 * np.eye(3, dtype=np.int64) - 1
    return _by_last_move([[0, 0, 0, 0], [1, 1, 1, 1], [2, 2, 2, 2], [0, 2, 0, 0]], pay)


def battle_of_the_sexes() -> MatrixGame:
    """The opera together pays 2, football together 1, else −1 each; a state holds both last choices.

    Partners prefer the opera or football, or choose what they themselves, or what the agent, did not choose last.
    """
    not_own, not_agents = np.array([[0, 1, 0, 1, 0], [1, 1, 1, 0, 0]])
    following = np.broadcast_to(1 + np.arange(4).reshape(2, 2), (5, 2, 2))
    usual = [np.zeros(5, int), np.ones(5, int), not_own, not_agents]
    return _game(usual, following, np.broadcast_to([[2, -1], [-1, 1]], (5, 2, 2)))


def pursuit() -> MatrixGame:
    """The agent wins where it catches the opponent on a ring; both step back, stay or step on, at once.

    A state is how many cells the opponent is ahead. Opponents go on, go back, stay, or come nearer.
    """
    ahead, step = np.arange(RING), np.arange(-1, 2)
    following = (ahead[:, None, None] + step - step[:, None]) % RING
    usual = [np.full(RING, move + 1) for move in (1, -1, 0)] + [np.array(TOWARDS) + 1]
    # Distances are counted from that of the start, so that episodes start in state 0.
    order = (ahead + START) % RING
    place = np.argsort(order)
    caught = order == 0
    following = place[following[order]]
    return _game(
        [each[order] for each in usual], following, caught[following].astype(np.int64), caught, PURSUIT_STEPS
    )


GAMES: dict[str, Callable[[], MatrixGame]] = {
    "rock-paper-scissors": rock_paper_scissors,
    "penalties": penalties,
    "battle of the sexes": battle_of_the_sexes,
    "pursuit": pursuit,
}
"""Each game by its name."""


def _by_last_move(usual: ArrayLike, pay: ArrayLike) -> MatrixGame:
    """A game with pays (A, M); state 0 is the first move, state 1 + m follows the opponent's move m."""
    n_states, shape = np.shape(usual)[1], np.shape(pay)
    following = np.broadcast_to(1 + np.arange(shape[1]), (n_states, *shape))
    return _game(usual, following, np.broadcast_to(pay, (n_states, *shape)))


def _game(
    usual: ArrayLike, following: ArrayLike, pay: ArrayLike, over: ArrayLike | None = None, n_steps: int = STEPS
) -> MatrixGame:
    """A game from the usual move of each type by state, (T, S)."""
    usual, following, pay = np.asarray(usual), np.asarray(following), np.asarray(pay)
    n_moves = following.shape[2]
    moves = np.where(usual[..., None] == np.arange(n_moves), HABIT, (1 - HABIT) / (n_moves - 1))
    ends = np.zeros(len(following), bool) if over is None else np.asarray(over)
    return MatrixGame(moves, following, pay, n_steps, ends)
