"""Recorded games of Pacman: each policy against each ghost, and how likely each ghost makes what Pacman saw.

Pacman sees the ghost in line of sight. For each strategy a forward filter over the ghost's phases gives the
likelihood of the cells where it was seen, or not, along the game.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from lifelore.core.mdp import TERMINAL
from lifelore.core.streams import stream
from lifelore.domains.pacman.pacman import MAX_STEPS, STRATEGIES, WIN_REWARD, PacmanMaze
from reproduction.chapter4.c4_04_pacman.pacman_library import Arena, arenas, trained_policies
from reproduction.chapter5.c5_09_switching.rounds import Recorded

Array = NDArray[np.float64]
TRAINING = {"epsilon": 0.5, "rate": 0.5, "training_discount": 0.97}
"""Of the policies, as in claim C4.4."""


def recorded_pacman(n_games: int, n_training: int, seed: int) -> Recorded:
    """`n_games` games of every pair in a maze with foods drawn by the seed; a won game pays 1."""
    maze = PacmanMaze()
    foods = maze.draw_foods(stream(seed, "C5.9", "Pacman", "foods"))
    here = arenas(maze, foods)
    policies = trained_policies(TRAINING | {"training_episodes": n_training}, here, (seed, "C5.9", "Pacman"))
    found = [_games(here, type_, policies, n_games, seed) for type_ in range(len(here))]
    return Recorded(np.array([won for won, _ in found]), np.array([seen for _, seen in found]))


def _games(here: Sequence[Arena], type_: int, policies: Array, n_games: int, seed: int) -> tuple[Array, Array]:
    """Won games of each policy against a ghost, (P, n), and log likelihoods of what was seen, (P, n, T)."""
    arena, random = here[type_], stream(seed, "C5.9", "Pacman", "games", STRATEGIES[type_])
    tables, observation_of = arena.tables, arena.task.observation_of
    policy = np.arange(len(policies)).repeat(n_games)
    choices = policies.cumsum(axis=2)
    state = random.choice(tables.starts, len(policy))
    playing, won = np.ones(len(policy), bool), np.zeros(len(policy))
    filters = [GhostFilter(each, len(policy)) for each in here]
    for filter_ in filters:
        filter_.see(observation_of[state], playing)
    for _ in range(MAX_STEPS):
        rows = choices[policy, observation_of[state]]
        action = np.minimum((random.random(len(policy))[:, None] >= rows).sum(axis=1), rows.shape[1] - 1)
        outcome = np.searchsorted(tables.outcome_cum, random.random(len(policy)), side="right")
        event, reward = tables.event[state, action, outcome], tables.reward[state, action, outcome]
        state = np.where(playing, tables.next_state[state, action, outcome], state)
        for filter_ in filters:
            filter_.see(observation_of[state], playing)
        ends = playing & ((event & TERMINAL) > 0)
        won[ends & (reward >= WIN_REWARD)] = 1.0
        playing &= ~ends
        if not playing.any():
            break
    found = np.stack([filter_.log_likelihood for filter_ in filters], axis=-1)
    return won.reshape(len(policies), n_games), found.reshape(len(policies), n_games, -1)


class GhostFilter:
    """The belief in the phases of a ghost of one strategy in `n` games, and the likelihood of what was seen.

    Attributes
    ----------
    log_likelihood : (n,) float64
        Minus infinity where this ghost cannot have been seen so.
    """

    def __init__(self, arena: Arena, n: int) -> None:
        _, _, self.cell, following, _ = arena.task.params
        n_phases, n_outcomes = following.shape
        self._sees, self._n_cells = arena.task.maze.sees, arena.task.maze.n_cells
        start = (self.cell != arena.task.maze.centre).astype(float)
        self._belief: Array = np.tile(start / start.sum(), (n, 1))
        self._step = np.zeros((n_phases, n_phases))
        np.add.at(self._step, (np.arange(n_phases).repeat(n_outcomes), following.ravel()), 1 / n_outcomes)
        self._first = True
        self.log_likelihood: Array = np.zeros(n)

    def see(self, observations: NDArray[np.integer], playing: NDArray[np.bool_]) -> None:
        """Learn from the `observations` (n,) of the next moment, in the games that are `playing` (n,)."""
        shown, own = observations % (self._n_cells + 1), observations // (self._n_cells + 1) % self._n_cells
        before = self._belief if self._first else self._belief @ self._step
        would_show = np.where(self._sees[own][:, self.cell], self.cell, self._n_cells)
        fits = before * (would_show == shown[:, None])
        total = fits.sum(axis=1)
        with np.errstate(divide="ignore"):
            self.log_likelihood += np.where(playing, np.log(total), 0.0)
        after = np.divide(fits, total[:, None], out=np.zeros_like(fits), where=total[:, None] > 0)
        self._belief = np.where(playing[:, None], after, self._belief)
        self._first = False
