"""The four small games: rock-paper-scissors, penalties, battle of the sexes, a pursuit on a ring of five cells.

An opponent makes the usual move of its type with a probability of `HABIT`, else any other move, each as likely.
"""

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike

from reproduction.chapter5.c5_09_switching.matrix_games import MatrixGame

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
