"""The factory: a mobile manipulator procures components and assembles them.

    state = configuration · n_cells + cell,   configuration = Σ_i stage_i · 3^i
    stage: 0 raw, 1 procured, 2 assembled

The sum runs over the items of the task's own list, so k components make 3^k configurations. A configuration
leads to itself or to a larger number and never back, which is what `core.layered_planning` needs. Where
components of other tasks matter, as for a prior that is carried from task to task, `factory_contexts` gives each
state its code over all components of the factory. Thesis: §3.4.2.
"""

import hashlib
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from lifelore.core.compiled.jit import inlined, kernel
from lifelore.core.errors import InputError
from lifelore.core.mdp import COLLISION, NOTHING, TERMINAL, Domain, Tables, Task
from lifelore.core.planning.layered_planning import LayeredPlan, layered_q
from lifelore.domains.grids.grid_world import MOVE_NAMES, GridWorld

ACTION_NAMES = (*MOVE_NAMES, "procure", "assemble")
PROCURE, ASSEMBLE = 4, 5
RAW, PROCURED, ASSEMBLED = 0, 1, 2
N_STAGES = 3
N_COMPONENTS = 9


@inlined
def step(params, s, a, u):
    """A move (refused by a wall: stay), or Procure or Assemble where the robot stands.

    A state in which everything is assembled ends whatever is done in it, for 0.
    """
    neighbour, entry_reward, item_at, power, rewards = params
    collision_reward, use_reward, misuse_reward, completion_reward = rewards
    n_cells = neighbour.shape[0]
    configuration = s // n_cells
    cell = s - configuration * n_cells
    complete = power[power.size - 1] - 1
    if configuration == complete:
        return s, 0.0, TERMINAL
    if a < PROCURE:
        target = neighbour[cell, a]
        if target < 0:
            return s, collision_reward, COLLISION
        return configuration * n_cells + target, entry_reward[target], NOTHING
    item = item_at[cell, a - PROCURE]
    if item < 0 or configuration // power[item] % N_STAGES != a - PROCURE:
        return s, misuse_reward, NOTHING
    configuration += power[item]
    if configuration == complete:
        return configuration * n_cells + cell, use_reward + completion_reward, TERMINAL
    return configuration * n_cells + cell, use_reward, NOTHING


@kernel
def tabulate_from(params, midpoints, first, n_states):
    """Every action of the states from `first` on, `n_states` of them, in one compiled loop."""
    shape = (n_states, PROCURE + 2, midpoints.size)
    next_state = np.empty(shape, np.int32)
    reward = np.empty(shape, np.float64)
    event = np.empty(shape, np.uint8)
    for s in range(n_states):
        for a in range(PROCURE + 2):
            for k in range(midpoints.size):
                s2, r, e = step(params, first + s, a, midpoints[k])
                next_state[s, a, k] = s2
                reward[s, a, k] = r
                event[s, a, k] = e
    return next_state, reward, event


def tabulate(params: tuple, midpoints: NDArray[np.float64]):
    """All states of a task; see `tabulate_from`."""
    return tabulate_from(params, np.asarray(midpoints, float), 0, int(params[3][-1]) * len(params[0]))


@dataclass(frozen=True)
class FactoryRewards:
    """What the thesis pays (§3.4.2): a move, one onto an express route, a collision, a use that serves the
    task, any other use, and on top of the last use the completion.

    The thesis does not say whether the last Assemble is paid 100 or 10 and 100; here it is both.
    """

    move: float = -2.0
    express: float = -1.0
    collision: float = -100.0
    use: float = 10.0
    misuse: float = -10.0
    completion: float = 100.0


@dataclass(frozen=True, eq=False)
class Factory:
    """A floor with a procurement point and an assembly point for each component.

    Parameters
    ----------
    floor : GridWorld
        Cells and moves; its discount is the factory's (the thesis is silent: 0.99).
    procure_at, assemble_at : (n_components,) int
        The cell, as a state of `floor`, where component i is procured or assembled.
    express : (n_cells,) bool
        Which cells are express routes.
    start : int
        The cell in which episodes start (the thesis is silent but for "the start location").
    procure_area, assemble_area : (n_cells,) bool
        The regions of the points; what the expert of Fig. 3.7 steers for.

    Points may be driven over. Components are numbered from 0, where the thesis counts from 1.
    """

    floor: GridWorld
    procure_at: NDArray[np.int32]
    assemble_at: NDArray[np.int32]
    express: NDArray[np.bool_]
    start: int
    procure_area: NDArray[np.bool_]
    assemble_area: NDArray[np.bool_]

    rewards = FactoryRewards()

    def __post_init__(self) -> None:
        for name in ("procure_at", "assemble_at"):
            cells = getattr(self, name)
            if len(set(cells.tolist())) != len(cells) or not 0 <= cells.min() <= cells.max() < self.n_cells:
                raise InputError(f"{name} must name distinct cells in [0, {self.n_cells}), got {cells.tolist()}")
        if len(self.procure_at) != len(self.assemble_at):
            raise InputError(
                f"procure_at and assemble_at must be of one length, got {len(self.procure_at)} "
                f"and {len(self.assemble_at)}"
            )
        if not 0 <= self.start < self.n_cells:
            raise InputError(f"start must be a cell in [0, {self.n_cells}), got {self.start}")

    @property
    def n_cells(self) -> int:
        return self.floor.n_states

    @property
    def n_components(self) -> int:
        return len(self.procure_at)

    def draw_components(self, generator: np.random.Generator, k: int) -> tuple[int, ...]:
        """A random task: `k` components, every set of them as likely."""
        if not 1 <= k <= self.n_components:
            raise InputError(f"k must lie in [1, {self.n_components}], got {k}")
        return tuple(sorted(generator.choice(self.n_components, size=k, replace=False).tolist()))

    def task(self, components: Sequence[int], starts: Sequence[int] | None = None) -> "FactoryTask":
        """Procure and assemble each of `components`; episodes start in the cells `starts` (default: `start`).

        Raises
        ------
        InputError
            `components` is empty, repeats itself, or names none of the factory's; `starts` no cells.
        """
        items = tuple(sorted(int(component) for component in components))
        if not items or len(set(items)) != len(items) or not 0 <= items[0] <= items[-1] < self.n_components:
            raise InputError(
                f"components must be distinct and lie in [0, {self.n_components}), got {tuple(components)}"
            )
        cells = np.asarray([self.start] if starts is None else starts, np.int32)
        if not cells.size or cells.min() < 0 or cells.max() >= self.n_cells:
            raise InputError(f"starts must be cells in [0, {self.n_cells}), got {cells.tolist()}")
        n_states = N_STAGES ** len(items) * self.n_cells
        domain = Domain(self.floor.name, n_states, len(ACTION_NAMES), step, self.floor.discount, tabulate=tabulate)
        return FactoryTask(domain, self._params(items), cells, factory=self, components=items)

    def _params(self, items: tuple[int, ...]) -> tuple:
        """What `step` reads: moves, reward of entering each cell, item of the list used where, 3^i, rewards."""
        pay = self.rewards
        entry_reward = np.where(self.express, pay.express, pay.move)
        item_at = np.full((self.n_cells, 2), -1, np.int32)
        item_at[self.procure_at[list(items)], 0] = np.arange(len(items))
        item_at[self.assemble_at[list(items)], 1] = np.arange(len(items))
        power = N_STAGES ** np.arange(len(items) + 1, dtype=np.int64)
        rewards = tuple(float(r) for r in (pay.collision, pay.use, pay.misuse, pay.completion))
        return (self.floor.neighbour, entry_reward, item_at, power, rewards)

    @cached_property
    def fingerprint(self) -> str:
        """Hash of floor, points, routes, start and rewards: equal only for the same factory."""
        digest = hashlib.sha256(self.floor.fingerprint.encode())
        for array in (self.procure_at, self.assemble_at, self.express, self.start):
            digest.update(np.ascontiguousarray(array, dtype=np.int64).tobytes())
        digest.update(repr((self.rewards, ACTION_NAMES)).encode())
        return digest.hexdigest()[:32]


@dataclass(frozen=True, eq=False)
class FactoryTask(Task):
    """A list of components to assemble; made by `Factory.task`.

    `tables()` serves the kernels up to about six components (16 MB; nine take 420 MB). Beyond, `plan` solves one
    configuration at a time.
    """

    factory: Factory = field(kw_only=True)
    components: tuple[int, ...] = field(kw_only=True)

    @property
    def n_configurations(self) -> int:
        return N_STAGES ** len(self.components)

    @cached_property
    def stages(self) -> NDArray[np.int8]:
        """(n_configurations, k) int8: RAW, PROCURED or ASSEMBLED, in the order of `components`."""
        power = N_STAGES ** np.arange(len(self.components))
        return (np.arange(self.n_configurations)[:, None] // power % N_STAGES).astype(np.int8)

    @property
    def completed(self) -> NDArray[np.bool_]:
        """(n_states,) bool: everything is assembled, nothing is chosen; never to be counted in a prior."""
        return np.arange(self.domain.n_states) >= (self.n_configurations - 1) * self.factory.n_cells

    def configuration_tables(self, configuration: int) -> Tables:
        """The rows of one configuration; `next_state` in numbers of the whole task."""
        size = self.factory.n_cells
        rows = tabulate_from(self.params, _MIDPOINT, configuration * size, size)
        return Tables(*rows, _CERTAIN, self.starts)

    def plan(self) -> LayeredPlan:
        """Exact values by the order of configurations, found as they are asked for."""
        size = self.factory.n_cells
        return LayeredPlan(self.configuration_tables, self.n_configurations, size, self.domain.discount)

    def optimal_q(self, tables: Tables | None = None) -> NDArray[np.float64]:
        """Exact action values of all states, (n_states, 6); 0 in completed ones."""
        return layered_q(tables or self.tables(), self.factory.n_cells, self.domain.discount)


_MIDPOINT, _CERTAIN = np.array([0.5]), np.ones(1)
