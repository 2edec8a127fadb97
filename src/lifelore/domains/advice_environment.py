"""The advice maze as a Gymnasium environment; `lifelore.domains` registers it."""

from lifelore.core.streams import stream
from lifelore.domains.advice.advice_maze import maze_goals
from lifelore.domains.grid_environment import Goal, GridEnvironment
from lifelore.domains.worlds import make_world


class AdviceMazeEnvironment(GridEnvironment):
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

    def __init__(
        self,
        size: int | None = None,
        loops: float | None = None,
        goal: Goal = None,
        seed: int = 0,
        render_mode: str | None = None,
    ) -> None:
        world = make_world("advice", size=size, loops=loops, seed=seed)
        if goal is None:
            goal = int(stream(seed, "goal").choice(maze_goals(world)))
        super().__init__(world, goal, seed, render_mode)
