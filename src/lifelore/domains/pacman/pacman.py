"""Pacman: collect four items of food in a figure-eight maze, with one ghost that is seen only in line of sight.

The ghost follows one of four strategies. The strategy is the *type* of the task, and the agent does not know it.
State and actions are the same for all types. The agent observes its own cell, the foods left, and the ghost's cell
if it sees the ghost.

The ghost is a small Markov chain over *phases*: back and forth and both ways around are cycles of cells, random
is a walk. A hidden state is ``(foods left · phases + phase) · cells + own cell``. Thesis: §4.6.3, Figure 4.7.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from lifelore.core.compiled.jit import kernel
from lifelore.core.errors import InputError
from lifelore.core.mdp import COLLISION, NOTHING, TERMINAL, Tables
from lifelore.domains.grids.grid_world import GridWorld

STRATEGIES = ("top row", "clockwise", "anticlockwise", "random")
"""How the ghost moves; the types, in this order."""
FOOD_REWARD, WIN_REWARD, LOSS_REWARD = 10.0, 100.0, -100.0
MAX_STEPS = 200
N_FOODS, N_ACTIONS = 4, 4


@kernel
def step(params, s, a, u):
    """One move of Pacman and the ghost at once, into a wall: stay. ``(s2, reward, event)``; pure.

    They collide where they end in one cell or change places; then no food is eaten.
    """
    neighbour, food_bit, ghost_cell, ghost_next, outcome_cum = params
    n_cells, n_phases = neighbour.shape[0], ghost_cell.size
    own, rest = s % n_cells, s // n_cells
    phase, left = rest % n_phases, rest // n_phases
    k = 0
    while u >= outcome_cum[k]:
        k += 1
    phase2 = ghost_next[phase, k]
    own2 = neighbour[own, a]
    event = NOTHING
    if own2 < 0:
        own2, event = own, COLLISION
    met = own2 == ghost_cell[phase2] or (own2 == ghost_cell[phase] and own == ghost_cell[phase2])
    reward = 0.0
    if met:
        reward, event = LOSS_REWARD, event | TERMINAL
    elif left & food_bit[own2]:
        left -= food_bit[own2]
        reward = FOOD_REWARD
    if left == 0:
        reward, event = reward + WIN_REWARD, event | TERMINAL
    return (left * n_phases + phase2) * n_cells + own2, reward, event


@kernel
def _tabulate(params, n_states):
    """Every (state, action, outcome) of `step` in one compiled loop; states without food are left alone."""
    outcome_cum = params[4]
    shape = (n_states, N_ACTIONS, outcome_cum.size)
    next_state = np.zeros(shape, np.int32)
    reward = np.zeros(shape, np.float64)
    event = np.full(shape, TERMINAL, np.uint8)
    for s in range(n_states // 2**N_FOODS, n_states):
        for a in range(N_ACTIONS):
            below = 0.0
            for k in range(outcome_cum.size):
                s2, r, e = step(params, s, a, (below + outcome_cum[k]) / 2)
                next_state[s, a, k] = s2
                reward[s, a, k] = r
                event[s, a, k] = e
                below = outcome_cum[k]
    return next_state, reward, event


@dataclass(frozen=True, eq=False)
class PacmanMaze:
    """A figure-eight of corridors one cell wide: the rim of a rectangle and its middle row.

    Parameters
    ----------
    rows, columns : int
        Of the free rectangle; odd and at least 5 and 3. The centre cell is where Pacman starts.

    Examples
    --------
    >>> PacmanMaze().n_cells
    29
    """

    rows: int = 7
    columns: int = 7

    def __post_init__(self) -> None:
        for name, least in (("rows", 5), ("columns", 3)):
            value = getattr(self, name)
            if value < least or value % 2 == 0:
                raise InputError(f"{name} must be odd and at least {least}, got {value}")

    @cached_property
    def grid(self) -> GridWorld:
        """Free cells and moves; a wall is all around, and fills both holes."""
        free = np.zeros((self.rows + 2, self.columns + 2), bool)
        free[[1, self.rows // 2 + 1, -2], 1:-1] = True
        free[1:-1, [1, -2]] = True
        return GridWorld.from_free("pacman", free)

    @property
    def n_cells(self) -> int:
        """Number of free cells."""
        return self.grid.n_states

    @property
    def centre(self) -> int:
        """The middle cell of the middle row."""
        return int(self.grid.state_of[self.rows // 2 + 1, self.columns // 2 + 1])

    @cached_property
    def sees(self) -> NDArray[np.bool_]:
        """(n_cells, n_cells): whether two cells are in one row or column with all cells between them free."""
        sees = np.eye(self.n_cells, dtype=bool)
        for cell in range(self.n_cells):
            for move in range(N_ACTIONS):
                other = self.grid.neighbour[cell, move]
                while other >= 0:
                    sees[cell, other] = True
                    other = self.grid.neighbour[other, move]
        return sees

    @cached_property
    def rim(self) -> NDArray[np.int64]:
        """The cells of the outer ring, clockwise from the upper left corner."""
        bottom, right = self.rows, self.columns
        places = [(1, c) for c in range(1, right)] + [(r, right) for r in range(1, bottom)]
        places += [(bottom, c) for c in range(right, 1, -1)] + [(r, 1) for r in range(bottom, 1, -1)]
        return np.array([self.grid.state_of[place] for place in places], np.int64)

    def draw_foods(self, generator: np.random.Generator) -> tuple[int, ...]:
        """Four different cells, none of them the centre, in ascending order."""
        cells = np.delete(np.arange(self.n_cells), self.centre)
        return tuple(sorted(generator.choice(cells, N_FOODS, replace=False).tolist()))


@dataclass(frozen=True, eq=False)
class PacmanTask:
    """Foods in a maze and a ghost's strategy: one task.

    Parameters
    ----------
    maze : PacmanMaze
    foods : (4,) int
        Different cells, none of them the centre.
    strategy : {"top row", "clockwise", "anticlockwise", "random"}
        The task's type.

    Episodes start with Pacman in the centre and the ghost in any phase of its strategy that is elsewhere, each as
    likely. Thesis: §4.6.3; the errata say what it leaves open.

    Examples
    --------
    >>> maze = PacmanMaze()
    >>> PacmanTask(maze, maze.draw_foods(np.random.default_rng(0)), "random").n_observations > 0
    True
    """

    maze: PacmanMaze
    foods: tuple[int, ...]
    strategy: str

    def __post_init__(self) -> None:
        if self.strategy not in STRATEGIES:
            raise InputError(f"strategy must be one of {', '.join(STRATEGIES)}, got {self.strategy!r}")
        allowed = set(range(self.maze.n_cells)) - {self.maze.centre}
        if len(set(self.foods)) != N_FOODS or len(self.foods) != N_FOODS or not set(self.foods) <= allowed:
            raise InputError(
                f"foods must be {N_FOODS} different cells in [0, {self.maze.n_cells}), none of them the centre "
                f"{self.maze.centre}, got {tuple(self.foods)}"
            )

    @cached_property
    def params(self) -> tuple:
        """What `step` reads: neighbours, food bits, the ghost's cells and successors, outcome probabilities."""
        food_bit = np.zeros(self.maze.n_cells, np.int64)
        food_bit[list(self.foods)] = 1 << np.arange(N_FOODS)
        cells, following = self._ghost()
        outcome_cum = np.arange(1, following.shape[1] + 1) / following.shape[1]
        return self.maze.grid.neighbour.astype(np.int64), food_bit, cells, following, outcome_cum

    def _ghost(self) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """The ghost's cell in each phase (n_phases,), and what follows, equally likely, (n_phases, n_outcomes)."""
        if self.strategy == "random":
            return _random_walk(self.maze.grid.neighbour)
        top = self.maze.rim[: self.maze.columns]
        cells = {
            "top row": np.concatenate([top, top[-2:0:-1]]),
            "clockwise": self.maze.rim,
            "anticlockwise": self.maze.rim[::-1],
        }[self.strategy]
        following = np.roll(np.arange(len(cells)), -1)[:, None]
        return np.ascontiguousarray(cells), np.ascontiguousarray(following)

    @property
    def n_phases(self) -> int:
        """Number of positions in the ghost's cycle."""
        return len(self.params[2])

    @property
    def n_states(self) -> int:
        """Hidden states: foods left × ghost's phase × own cell."""
        return 2**N_FOODS * self.n_phases * self.maze.n_cells

    @property
    def n_observations(self) -> int:
        """Foods left × own cell × ghost's cell or unseen; the same for every type."""
        return 2**N_FOODS * self.maze.n_cells * (self.maze.n_cells + 1)

    @cached_property
    def starts(self) -> NDArray[np.int32]:
        """States in which episodes start, each as likely."""
        phases = np.flatnonzero(self.params[2] != self.maze.centre)
        all_left = 2**N_FOODS - 1
        return ((all_left * self.n_phases + phases) * self.maze.n_cells + self.maze.centre).astype(np.int32)

    def parts(self, states) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.int64]]:
        """Own cell, ghost's cell and foods left (bits, first food lowest) of hidden states."""
        own = np.asarray(states, np.int64) % self.maze.n_cells
        rest = np.asarray(states, np.int64) // self.maze.n_cells
        return own, self.params[2][rest % self.n_phases], rest // self.n_phases

    @cached_property
    def observation_of(self) -> NDArray[np.int32]:
        """(n_states,) int32: the number of what is observed in each hidden state."""
        own, ghost, left = self.parts(np.arange(self.n_states))
        n_cells = self.maze.n_cells
        shown = np.where(self.maze.sees[own, ghost], ghost, n_cells)
        return ((left * n_cells + own) * (n_cells + 1) + shown).astype(np.int32)

    def tables(self) -> Tables:
        """The hidden process, enumerated through `step`; pass `observation_of` to a learner as its rows."""
        next_state, reward, event = _tabulate(self.params, self.n_states)
        return Tables(next_state, reward, event, self.params[4], self.starts)


def _random_walk(neighbour: NDArray[np.int32]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """A walk to any free neighbour, each as likely: every cell a phase, as many outcomes as divide evenly."""
    around = [row[row >= 0] for row in neighbour]
    n_outcomes = int(np.lcm.reduce([len(row) for row in around]))
    following = np.array([np.repeat(row, n_outcomes // len(row)) for row in around], np.int64)
    return np.arange(len(neighbour)), following
