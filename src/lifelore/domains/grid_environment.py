"""The grid worlds as Gymnasium environments; `lifelore.domains` registers them."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from lifelore.core.errors import InputError
from lifelore.core.streams import stream
from lifelore.domains.advice.advice_maze import maze_goals
from lifelore.domains.grids.grid_picture import draw_grid
from lifelore.domains.grids.grid_world import GridWorld
from lifelore.domains.task_environment import TaskEnvironment
from lifelore.domains.worlds import make_world

Goal = int | tuple[int, int] | None


class GridEnvironment(TaskEnvironment):
    """A grid world with a goal to be found.

    ## Action Space
    ``Discrete(4)``: north, south, east, west.

    ## Observation Space
    ``Discrete(n_states)``: the number of the cell the agent is in.

    ## Rewards
    ``goal_reward`` for entering the goal, ``wall_reward`` for a move that is refused, else 0.

    ## Starting State
    Any cell but the goal, each as likely; ``reset(options={"state": s})`` starts in state s.

    ## Episode End
    The goal is entered.

    ## Arguments
    `world`: a `GridWorld`. `goal`: a state, a cell (row, column), or None, which draws one from `seed`.
    `render_mode`: None or ``"rgb_array"``.

    ``info["collision"]`` tells whether the last move was refused, ``info["percept"]`` what the agent
    perceives around it (`grid_world.PERCEPT`).

    Examples
    --------
    >>> from lifelore.domains.grids.grid_world import GridWorld
    >>> env = GridEnvironment(GridWorld.from_free("room", np.ones((2, 3), bool)), goal=5)
    >>> observation, info = env.reset(seed=0)
    >>> env.action_space
    Discrete(4)
    """

    metadata = {"render_modes": ["rgb_array"], "render_fps": 10}  # noqa: RUF012

    def __init__(self, world: GridWorld, goal: Goal = None, seed: int = 0, render_mode: str | None = None) -> None:
        self.world = world
        state = self._drawn_goal(world, seed) if goal is None else _goal_state(world, goal)
        super().__init__(world.task(state), render_mode)

    def _drawn_goal(self, world: GridWorld, seed: int) -> int:
        """The goal where none is given."""
        return int(stream(seed, "goal").integers(world.n_states))

    def _picture(self) -> NDArray[np.uint8]:
        """The picture of the world, (height, width, 3) uint8."""
        return draw_grid(self.world, self._state, self.task.goal)

    def _info(self, event: int) -> dict[str, Any]:
        return super()._info(event) | {"percept": int(self.world.percepts[self._state])}


class NamedGridEnvironment(GridEnvironment):
    """A world of `make_world` to find a goal in; its settings are further arguments."""

    domain = ""
    """Name of the world."""

    def __init__(
        self, *, goal: Goal = None, seed: int = 0, render_mode: str | None = None, **settings: Any
    ) -> None:
        super().__init__(make_world(self.domain, seed=seed, **settings), goal, seed, render_mode)


class BuildingEnvironment(NamedGridEnvironment):
    """An office building to find a place in: a ROS map's, or an invented one.

    ## Action Space
    ``Discrete(4)``: north, south, east, west.

    ## Observation Space
    ``Discrete(n_states)``: the number of the cell the agent is in.

    ## Rewards
    100 for entering the goal, -10 for a move that is refused, else 0.

    ## Starting State
    Any cell but the goal, each as likely; ``reset(options={"state": s})`` starts in state s.

    ## Episode End
    The goal is entered; truncated after 2,000 steps.

    ## Arguments
    `map`: YAML of a ROS map, None for an invented office. `cell`, `robot_radius`: metres, 0.5 and 0.2.
    `goal`: a state, a cell (row, column), or None, which draws one from `seed`. `seed`: of the office and
    the goal. `render_mode`: None or ``"rgb_array"``.
    """

    domain = "building"


class LatticeEnvironment(NamedGridEnvironment):
    """The thesis's lattice (§3.4.1): every second row and column of a walled square is passable.

    ## Action Space
    ``Discrete(4)``: north, south, east, west.

    ## Observation Space
    ``Discrete(n_states)``: the number of the cell the agent is in; 341 at size 23.

    ## Rewards
    100 for entering the goal, -10 for walking into a wall, else 0.

    ## Starting State
    Any cell but the goal, each as likely; ``reset(options={"state": s})`` starts in state s.

    ## Episode End
    The goal is entered; truncated after 1,000 steps.

    ## Arguments
    `size`: cells a side, odd, 23. `goal`: a state, a cell (row, column), or None, which draws one from
    `seed`. `render_mode`: None or ``"rgb_array"``.
    """

    domain = "lattice"


class NoiseMazeEnvironment(NamedGridEnvironment):
    """The thesis's noise maze (§3.4.1): 50–80 % of the cells are obstacles, the rest connected.

    ## Action Space
    ``Discrete(4)``: north, south, east, west.

    ## Observation Space
    ``Discrete(n_states)``: the number of the cell the agent is in.

    ## Rewards
    100 for entering the goal, -10 for walking into a wall, else 0.

    ## Starting State
    Any cell but the goal, each as likely; ``reset(options={"state": s})`` starts in state s.

    ## Episode End
    The goal is entered; truncated after 1,000 steps.

    ## Arguments
    `size`: cells a side, 23. `density`: share of obstacles, None draws it. `goal`: a state, a cell (row,
    column), or None, which draws one from `seed`. `seed`: of the maze and the goal. `render_mode`: None or
    ``"rgb_array"``.
    """

    domain = "noise"


class AdviceMazeEnvironment(NamedGridEnvironment):
    """The thesis's advice maze (§3.7.2.1): 30 × 30 cells of corridors with some loops, and eight goals.

    ## Action Space
    ``Discrete(4)``: north, south, east, west.

    ## Observation Space
    ``Discrete(n_states)``: the number of the cell the agent is in.

    ## Rewards
    1000 for entering the goal, else 0.

    ## Starting State
    Any cell but the goal, each as likely; ``reset(options={"state": s})`` starts in state s.

    ## Episode End
    The goal is entered; truncated after 5,000 steps. The other goals are cells like any other.

    ## Arguments
    `size`: cells a side, 30. `loops`: share of the walls between two corridors that are opened, 0.1. `goal`: a
    state, a cell (row, column), or None, which draws one of the maze's eight from `seed`. `seed`: of the maze and
    the goal. `render_mode`: None or ``"rgb_array"``.
    """

    domain = "advice"

    def _drawn_goal(self, world: GridWorld, seed: int) -> int:
        return int(stream(seed, "goal").choice(maze_goals(world)))


def _goal_state(world: GridWorld, goal: int | tuple[int, int]) -> int:
    if isinstance(goal, (int, np.integer)):
        return int(goal)
    row, column = goal
    inside = 0 <= row < world.shape[0] and 0 <= column < world.shape[1]
    state = int(world.state_of[row, column]) if inside else -1
    if state < 0:
        raise InputError(f"goal must be a free cell (row, column) of the world, got {tuple(goal)}")
    return state
