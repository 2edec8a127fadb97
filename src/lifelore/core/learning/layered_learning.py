"""Q-learning in tasks of many layers, with tables of the visited layers alone.

Nine components of a factory have 19,683 configurations, of which a learner visits a thousand. The kernel is that
of `q_learning`; its tables hold the visited layers. A move into another layer is stored as an end of the episode:
its Q is 0, as is the value of an end, so the update is the same to the bit. The kernel halts, the layer is added,
and the episode continues. Thesis: §3.2.2.3, §3.4.3.
"""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from lifelore.core.errors import InputError
from lifelore.core.learning.curve import EPISODE, STATE, STEP, Curve, new_curve
from lifelore.core.learning.q_learner import QLearning
from lifelore.core.learning.q_learning import QLearner, Rows, cumulative, learn, new_learner, uniform_rows
from lifelore.core.mdp import TERMINAL, Tables

_ALL = 2**62
RowsOf = Callable[[int], Tables]
ProbsOf = Callable[[int], NDArray[np.float64]]


class LayeredLearning:
    """A learner of one task in layers, with Q for the visited layers.

    Parameters
    ----------
    rows_of : callable
        ``rows_of(layer) -> Tables`` of the states of one layer, the task's starts with them; `next_state` and
        `starts` are state numbers of the whole task; state s lies in layer s // layer_size.
    n_layers, layer_size : int
    world, own : numpy generators
        As in `QLearning.learn`.
    explore_of : callable, optional
        ``explore_of(layer) -> (layer_size, n_actions)`` exploration probabilities, rows sum to 1; default uniform.
    ties_of : callable, optional
        ``ties_of(layer) -> (layer_size, n_actions)`` positive tie weights; default uniform.

    Notes
    -----
    `learn` gives the same Q, visits, curve and random numbers as `QLearning.learn` on the tables of the whole
    task, to the bit. A visited layer takes some 0.07 MB at 275 cells and six actions, any other four bytes.
    """

    def __init__(
        self,
        rows_of: RowsOf,
        n_layers: int,
        layer_size: int,
        *,
        world: np.random.Generator,
        own: np.random.Generator,
        explore_of: ProbsOf | None = None,
        ties_of: ProbsOf | None = None,
    ) -> None:
        if 2 * n_layers * layer_size >= 2**31:
            raise InputError(f"n_layers · layer_size must stay below 2**30, got {n_layers} · {layer_size}")
        self._rows_of, self.layer_size = rows_of, layer_size
        self._explore_of, self._ties_of = explore_of, ties_of
        self._n_states = n_layers * layer_size
        self._block_of = np.full(n_layers, -1, np.int32)
        self._leading_to: dict[int, list[int]] = {}
        """Unvisited layer → blocks with moves into it."""
        self.layers: list[int] = []
        """The visited layers, in order of the first visit."""
        first = rows_of(0)
        shape = first.next_state.shape[1:]
        self._outcome_cum, self._n_actions = first.outcome_cum, shape[0]
        self._arrays = {
            "next_state": np.zeros((0, *shape), np.int32),
            "reward": np.zeros((0, *shape)),
            "event": np.zeros((0, *shape), np.uint8),
            "reward_class": np.zeros((0, *shape), np.uint8),
            "q": np.zeros((0, shape[0])),
            "visits": np.zeros((0, shape[0]), np.int64),
        }
        if explore_of or ties_of:
            self._arrays |= {name: np.zeros((0, shape[0])) for name in ("explore_cum", "tie_weight")}
        for layer in np.unique(first.starts // layer_size):
            self._meet(int(layer))
        self._starts = self._local(first.starts)
        self._learner = new_learner(0, self._n_actions, world, own)

    def learn(self, settings: QLearning, discount: float) -> Curve:
        """Learn the task from the first episode to the last; may be called once."""
        if self._learner.cursor.any():
            raise InputError("learn() runs once, got a learner that has learnt; make a new LayeredLearning")
        curve, schedule = new_curve(settings.episodes), settings.schedule(discount)
        cursor = self._learner.cursor
        while cursor[EPISODE] < settings.episodes:
            episode = int(cursor[EPISODE])
            this_episode = schedule._replace(
                epsilon=schedule.epsilon[: episode + 1], alpha=schedule.alpha[: episode + 1]
            )
            tables, rows, learner = self._laid_out()
            learn(tables, rows, this_episode, learner, curve, _ALL)
            if cursor[STATE] >= self._n_states:
                self._go_on(curve, episode, settings.max_steps)
        return curve

    def q(self, layer: int) -> NDArray[np.float64]:
        """Q of the states of one layer, (layer_size, n_actions); zeros for an unvisited layer."""
        return self._of_layer("q", layer)

    def visits(self, layer: int) -> NDArray[np.int64]:
        """Visits of the states and actions of one layer, (layer_size, n_actions)."""
        return self._of_layer("visits", layer)

    @property
    def random_states(self) -> tuple[NDArray[np.uint64], NDArray[np.uint64]]:
        """Current states of the world's stream and of the learner's own."""
        return self._learner.world_random, self._learner.own_random

    def _of_layer(self, name: str, layer: int) -> NDArray:
        if not 0 <= layer < len(self._block_of):
            raise InputError(f"layer must lie in [0, {len(self._block_of)}), got {layer}")
        block = self._block_of[layer]
        if block < 0:
            return np.zeros((self.layer_size, self._n_actions), self._arrays[name].dtype)
        return self._arrays[name][self._slice(block)].copy()

    # ---- the tables so far -----------------------------------------------------------------------

    def _laid_out(self) -> tuple[Tables, Rows, QLearner]:
        """Arguments of the kernel, over the visited layers."""
        n = len(self.layers) * self.layer_size
        now = {name: array[:n] for name, array in self._arrays.items()}
        tables = Tables(now["next_state"], now["reward"], now["event"], self._outcome_cum, self._starts)
        here = np.arange(n, dtype=np.int32)
        if "explore_cum" in now:
            rows = Rows(here, here[:, None], now["reward_class"], now["explore_cum"], now["tie_weight"])
        else:
            flat = np.full((1, self._n_actions), 1 / self._n_actions)
            row = np.zeros((n, 1), np.int32)
            rows = Rows(here, row, now["reward_class"], cumulative(flat), np.ones_like(flat))
        return tables, rows, self._learner._replace(q=now["q"], visits=now["visits"])

    def _go_on(self, curve: Curve, episode: int, max_steps: int) -> None:
        """Undo an end of the episode at the border of the visited layers: add the next layer."""
        cursor = self._learner.cursor
        following = int(cursor[STATE]) - self._n_states
        self._meet(following // self.layer_size)
        cursor[STATE] = self._local(np.array([following]))[0]
        curve.reached[episode] = False
        if curve.steps[episode] < max_steps:
            cursor[EPISODE], cursor[STEP] = episode, curve.steps[episode]

    def _meet(self, layer: int) -> None:
        block = len(self.layers)
        self.layers.append(layer)
        self._make_room()
        here, rows = self._slice(block), self._rows_of(layer)
        self._block_of[layer] = block
        self._arrays["reward"][here], self._arrays["event"][here] = rows.reward, rows.event
        self._arrays["next_state"][here] = rows.next_state
        if "explore_cum" in self._arrays:
            alike = np.ones((self.layer_size, self._n_actions))
            explore = self._explore_of(layer) if self._explore_of else alike / self._n_actions
            checked = uniform_rows(rows, explore, self._ties_of(layer) if self._ties_of else alike)
            self._arrays["explore_cum"][here] = checked.explore_cum
            self._arrays["tie_weight"][here] = checked.tie_weight
        self._join(block, rows)
        for other in self._leading_to.pop(layer, ()):
            self._join_to(other, layer)

    def _join(self, block: int, rows: Tables) -> None:
        """Moves of a new block: into visited layers by their local number, into others as an end."""
        here = self._slice(block)
        next_state, event = self._arrays["next_state"][here], self._arrays["event"][here]
        goes_on = rows.event & TERMINAL == 0
        met = self._block_of[rows.next_state // self.layer_size] >= 0
        next_state[:] = np.where(met, self._local(rows.next_state), rows.next_state + self._n_states)
        # The state after a true end is never read; a place of this block keeps it inside the tables.
        next_state[~goes_on & ~met] = here.start
        event[goes_on & ~met] |= TERMINAL
        for layer in np.unique(rows.next_state[goes_on & ~met] // self.layer_size):
            self._leading_to.setdefault(int(layer), []).append(block)

    def _join_to(self, block: int, layer: int) -> None:
        """Let moves of `block` that ended at the unvisited `layer` lead there."""
        here = self._slice(block)
        next_state, event = self._arrays["next_state"][here], self._arrays["event"][here]
        waiting = (next_state - self._n_states) // self.layer_size == layer
        event[waiting] &= np.uint8(255 - TERMINAL)
        next_state[waiting] = self._local(next_state[waiting] - self._n_states)

    def _local(self, states: NDArray) -> NDArray[np.int32]:
        """Local numbers of states of visited layers."""
        block = self._block_of[states // self.layer_size]
        return (block * self.layer_size + states % self.layer_size).astype(np.int32)

    def _slice(self, block: int) -> slice:
        return slice(int(block) * self.layer_size, (int(block) + 1) * self.layer_size)

    def _make_room(self) -> None:
        needed = len(self.layers) * self.layer_size
        if needed <= len(self._arrays["q"]):
            return
        room = self.layer_size * (len(self.layers) + len(self.layers) // 2 + 8)
        for name, array in self._arrays.items():
            larger = np.zeros((room, *array.shape[1:]), array.dtype)
            larger[: len(array)] = array
            self._arrays[name] = larger
