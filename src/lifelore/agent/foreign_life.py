"""`live_in`: the agent lives in a world of the user's own, met only through the `World` protocol.

Nothing is known of such a world but what happens in it, so states and contexts are numbered as they are met and
returns are observed, not computed. Learning is that of `lifelore.core.q_learning`, step by step in Python.
"""

import hashlib
import math
import numbers
import os
import time
import uuid
from collections.abc import Callable, Hashable
from contextlib import nullcontext
from dataclasses import asdict, dataclass, field, fields, is_dataclass
from enum import Enum
from pathlib import Path
from threading import Event

import numpy as np
from numpy.typing import NDArray

from lifelore.action.action_prior import FORMS, VERSION, ActionPrior
from lifelore.action.action_prior import KIND as PRIOR_KIND
from lifelore.action.exploration import TIES, TRACE
from lifelore.agent.summary import plain, third
from lifelore.agent.task_result import Stopped
from lifelore.core.errors import InputError
from lifelore.core.metrics import jumpstart, mean_estimate
from lifelore.core.planning import best_actions
from lifelore.core.protocols import Record, World
from lifelore.core.q_learner import QLearning
from lifelore.core.q_learning import choose, cumulative
from lifelore.core.random_state import random_state
from lifelore.core.streams import stream
from lifelore.memory import Memory, open_memory

AGENTS = ("lore", "scratch")
CODE_BITS = 47
"""Bits of a context's code: of a million contexts two share one by chance in 0.4 % of lives, and are found out."""
MOST_ACTIONS = 2**16 - 1
"""With this many, code · n_actions + action still fits a 64-bit integer."""
LOOK_EVERY = 200
"""Steps between looks at the stop sign."""
MEASURES = ("first_return", "mean_return", "final_return")


def live_in(
    world: World,
    *,
    tasks: int = 20,
    episodes: int = 200,
    max_steps: int = 1000,
    memory: str | Path | None = None,
    robot: str = "robot",
    key: str | None = None,
    seed: int = 0,
    discount: float = 0.95,
    learning_rate: float = 0.5,
    epsilon: float = 1.0,
    epsilon_decay: float = 0.98,
    epsilon_floor: float = 0.01,
    alpha0: float = 0.1,
    weight: float = 1.0,
    form: str = "proportion",
    ties: str = "uniform",
    progress: Callable[[int, int, str], None] | None = None,
    stop: Event | None = None,
) -> dict:
    """Live through `tasks` tasks of a world, `scratch` beside on the same random streams; keep what was learnt.

    Two agents learn each task by ε-greedy Q-learning from nothing (Q = 0). `scratch` explores uniformly; `lore`
    by the action prior that its life has taught it so far: after each task the learnt policy's best actions
    in the states that it holds to be worth something (value > 0) are counted by context. So a world whose
    rewards are never positive teaches nothing (``n_contexts`` stays 0): shift them.

    Parameters
    ----------
    world : World
        ``lifelore.bridges.gymnasium_world.GymnasiumWorld``, or an object of your own; it is not closed.
    tasks, episodes, max_steps : int
        Tasks to live through now, episodes of each, steps of an episode at most; ≥ 1.
    memory : str or Path, optional
        SQLite file or ``postgresql://`` URL in which to go on from earlier lives and to keep this one, one
        transaction a task. None keeps nothing on disk and starts from nothing, other than in `live`.
    robot : str
        Name under which memory keeps this life.
    key : str, optional
        What the contexts mean; lives with one key and number of actions share their lore. Default:
        ``world.context_key``; `GymnasiumWorld` has one, and its documentation says what that cannot see.
        Not needed without a memory.
    seed : int
        Episodes' seeds and the agents' choices.
    discount : float
        γ in [0, 1].
    learning_rate, epsilon, epsilon_decay, epsilon_floor : float
        As in `QLearning`.
    alpha0, weight, form, ties : float, float, str, str
        As in `LifeSettings`.
    progress : callable, optional
        Called as ``progress(done, total, label)`` after each task.
    stop : threading.Event, optional
        Set it to end early: the task in progress is given up, all finished ones are kept.

    Returns
    -------
    dict
        The JSON document of `live`, with null for what a foreign world does not tell (map, goals, optimum,
        collisions, steps and episodes to 80 %). Returns are discounted; ``final_return`` is the mean of
        a task's last tenth of episodes, ``mean_return`` of all; ``reached``: an episode was ever terminated with a
        positive reward. ``summary`` compares over the last third of the tasks; ``n_contexts``: contexts that
        the prior knows at the end.

    Raises
    ------
    InputError
        A setting breaks its rule; a reward that is not finite; a context without a stable code (see
        `context_code`); no key for a memory.
    StoreError
        Memory refuses; what was learnt before stays in it.
    """
    began = time.perf_counter()
    _check_numbers({"tasks": tasks, "episodes": episodes, "max_steps": max_steps}, discount)
    learning = QLearning(episodes, max_steps, learning_rate, epsilon, epsilon_decay, epsilon_floor)
    guidance = Guidance(alpha0, weight, form, ties)
    _check(world)
    _check_names(robot, key)
    if memory is not None and key is None:
        key = _key_of(world)
    with open_memory(memory) if memory is not None else nullcontext() as kept:
        life = _ForeignLife(world, learning, guidance, discount, seed, robot, key, kept)
        life.run(tasks, progress, stop or Event())
        settings = {"tasks": tasks, "robot": robot, "key": key, "discount": discount}
        settings |= asdict(learning) | asdict(guidance) | {"memory": kept.location if kept else None}
        return life.report(settings, round(time.perf_counter() - began, 3))


@dataclass(frozen=True)
class Guidance:
    """How counts guide exploration: α⁰, w(π), the form of the prior, and how the greedy step breaks ties."""

    alpha0: float = 0.1
    weight: float = 1.0
    form: str = "proportion"
    ties: str = "uniform"

    def __post_init__(self) -> None:
        for name, known in {"form": FORMS, "ties": TIES}.items():
            if getattr(self, name) not in known:
                raise InputError(f"{name} must be one of {', '.join(known)}, got '{getattr(self, name)}'")
        # The prior has the rules for its own numbers.
        ActionPrior(1, self.alpha0).update([], np.empty((0, 1)), self.weight)


def _check_numbers(whole: dict[str, int], discount: float) -> None:
    for name, value in whole.items():
        if not isinstance(value, int) or not 1 <= value <= 10**9:
            raise InputError(f"{name} must be a whole number from 1 to 10^9, got {value}")
    if not 0 <= discount <= 1:
        raise InputError(f"discount must lie in [0, 1], got {discount}")


def _check_names(robot: str, key: str | None) -> None:
    if not robot.strip():
        raise InputError("robot must have a name, got an empty one")
    if key is not None and not key.strip():
        raise InputError("key must say what the contexts mean, got an empty one; leave it out for the world's own")


def _check(world: World) -> None:
    if not isinstance(world, World):
        raise InputError(
            "world must have n_actions, reset, step and context (lifelore.core.protocols.World), got "
            f"{type(world).__name__}; wrap an environment of Gymnasium in GymnasiumWorld"
        )
    if not 1 <= world.n_actions <= MOST_ACTIONS:
        raise InputError(f"world.n_actions must lie in [1, {MOST_ACTIONS}], got {world.n_actions}")


def _key_of(world: World) -> str:
    key = getattr(world, "context_key", None)
    if not key:
        raise InputError(
            f"key must say what the contexts of {type(world).__name__} mean before a memory keeps them, "
            'got none; pass key="..."'
        )
    return key


# ---- contexts ------------------------------------------------------------------------------------


def context_code(context: Hashable, bits: int = CODE_BITS) -> int:
    """A context's code in [0, 2**bits), the same in every process and for equal contexts.

    Parameters
    ----------
    context : hashable
        None, numbers, strings, bytes, enum members, and tuples, frozensets and dataclasses of these.

    Raises
    ------
    InputError
        Another type, whose identity may not outlive the process; or NaN, which is not even equal to itself.
    """
    digest = hashlib.blake2b(_canonical(context).encode(), digest_size=8).digest()
    return int.from_bytes(digest, "big") >> (64 - bits)


def _canonical(part: Hashable) -> str:
    """One text for each value; values that Python holds to be equal have one text (1, 1.0 and True)."""
    if isinstance(part, np.generic) and not isinstance(part, str | bytes):
        part = part.item()
    if isinstance(part, numbers.Real) and math.isfinite(part):
        return str(math.floor(part)) if part == math.floor(part) else float(part).hex()
    if part is None or isinstance(part, str):
        return "none" if part is None else ascii(str(part))
    if isinstance(part, bytes):
        return repr(bytes(part))
    if isinstance(part, tuple):
        return f"({','.join(map(_canonical, part))})"
    if isinstance(part, frozenset):
        return f"{{{','.join(sorted(map(_canonical, part)))}}}"
    if isinstance(part, Enum):
        return f"{type(part).__qualname__}.{part.name}"
    if is_dataclass(part) and not isinstance(part, type):
        values = tuple(getattr(part, f.name) for f in fields(part) if f.compare)
        return type(part).__qualname__ + _canonical(values)
    raise InputError(
        "context must be made of finite numbers, text, bytes, enum members, tuples, frozensets or dataclasses, "
        f"got {ascii(part)[:60]} of type {type(part).__name__}; return a tuple of such features"
    )


class ContextCodes:
    """Codes of the contexts met, and the watch that no two of them share one."""

    def __init__(self, bits: int = CODE_BITS) -> None:
        self.bits = bits
        self._code: dict[Hashable, int] = {}
        self._context: dict[int, Hashable] = {}

    def __getitem__(self, context: Hashable) -> int:
        """The context's code; InputError for a second context of one code."""
        try:
            return self._code[context]
        except KeyError:
            return self._meet(context)
        except TypeError:
            raise InputError(
                f"context must be hashable, got {type(context).__name__}; return a tuple or a number"
            ) from None

    def _meet(self, context: Hashable) -> int:
        code = context_code(context, self.bits)
        other = self._context.setdefault(code, context)
        if other != context:
            raise InputError(
                f"contexts {ascii(other)[:60]} and {ascii(context)[:60]} share the code {code}, so their lore "
                "would mix; change the features slightly, for instance add a constant to the tuple"
            )
        self._code[context] = code
        return code


# ---- one task ------------------------------------------------------------------------------------


@dataclass
class _Rows:
    """Rows of numbers for keys as they are met: `table` (capacity, n_actions), grown by doubling."""

    table: NDArray[np.float64]
    number: dict[Hashable, int] = field(default_factory=dict)

    def add(self, key: Hashable) -> int:
        row = self.number[key] = len(self.number)
        if row == len(self.table):
            self.table = np.concatenate([self.table, np.zeros_like(self.table)])
        return row


class _Learner:
    """One agent on one task: its Q and the prior as it met them, and what it saw."""

    def __init__(self, n_actions: int, prior: ActionPrior | None, guidance: Guidance, own: np.random.Generator):
        self.prior, self.guidance, self.generator = prior, guidance, own
        self.random = random_state(own)
        self.q = _Rows(np.zeros((64, n_actions)))
        self.explore, self.ties = (_Rows(np.zeros((64, n_actions))) for _ in range(2))
        # An insertion-ordered set: which contexts each state was met in.
        self.visited: dict[tuple[int, int], None] = {}

    def act(self, state: Hashable, code: int, epsilon: float) -> tuple[int, int]:
        """Row of Q, and the ε-greedy action (Alg. 2 line 5)."""
        row = self.row(state)
        context = self.explore.number.get(code)
        if context is None:
            context = self._meet(code)
        self.visited[row, code] = None
        return row, choose(self.q.table, row, self.explore.table, self.ties.table, context, epsilon, self.random)

    def row(self, state: Hashable) -> int:
        row = self.q.number.get(state)
        return self.q.add(state) if row is None else row

    def value(self, state: Hashable) -> float:
        """max_a Q(s, a)."""
        row = self.row(state)
        return float(self.q.table[row].max())

    def _meet(self, code: int) -> int:
        n_actions = self.q.table.shape[1]
        probs = np.full((1, n_actions), 1 / n_actions)
        if self.prior is not None:
            probs = self.prior.probs([code], self.guidance.form, generator=self.generator)
        row = self.explore.add(code)
        self.explore.table[row] = cumulative(probs)[0]
        self.ties.add(code)
        self.ties.table[row] = np.maximum(probs[0], TRACE) if self.guidance.ties == "prior" else 1.0
        return row

    def best(self) -> tuple[NDArray[np.int64], NDArray[np.bool_]]:
        """Contexts (n,) of the states visited, and the best actions there; rows not worth anything are False."""
        if not self.visited:
            return np.empty(0, np.int64), np.empty((0, self.q.table.shape[1]), np.bool_)
        rows, codes = np.array(list(self.visited), np.int64).T
        q = self.q.table[rows]
        return codes, best_actions(q) & (q.max(axis=1) > 0)[:, None]


@dataclass(frozen=True)
class _Trial:
    """One task that both agents are given, with the same seeds of its episodes."""

    world: World
    codes: ContextCodes
    learning: QLearning
    discount: float
    index: int
    seeds: list[int]
    stop: Event

    def live(self, learner: _Learner) -> dict:
        schedule = self.learning.schedule(self.discount)
        returns, reached = [], False
        for episode_seed, epsilon in zip(self.seeds, schedule.epsilon, strict=True):
            value, goal = self._episode(learner, episode_seed, float(epsilon))
            returns.append(value)
            reached |= goal
        last = max(1, len(returns) // 10)
        unknown = dict.fromkeys(("collisions", "steps_to_80", "episodes_to_80"))
        return unknown | {
            "first_return": returns[0],
            "reached": reached,
            "final_return": sum(returns[-last:]) / last,
            "mean_return": sum(returns) / len(returns),
        }

    def _episode(self, learner: _Learner, seed: int, epsilon: float) -> tuple[float, bool]:
        """One episode: its discounted return, and whether it was terminated with a positive reward."""
        state, reward, total, factor = self.world.reset(self.index, seed), 0.0, 0.0, 1.0
        for step in range(self.learning.max_steps):
            if step % LOOK_EVERY == 0 and self.stop.is_set():
                raise Stopped
            code = self.codes[self.world.context(state, reward)]
            row, action = learner.act(state, code, epsilon)
            state, reward, terminated, truncated = self.world.step(action)
            if not math.isfinite(reward):
                raise InputError(
                    f"reward must be a finite number, got {reward} for action {action} in task {self.index}; "
                    "mend the world's step"
                )
            future = 0.0 if terminated else self.discount * learner.value(state)
            # Looked up only now: meeting the next state may have made it a larger one.
            q = learner.q.table
            q[row, action] += self.learning.learning_rate * (reward + future - q[row, action])
            total, factor = total + factor * reward, factor * self.discount
            if terminated or truncated:
                return total, terminated and reward > 0
        return total, False


# ---- the life ------------------------------------------------------------------------------------


class _ForeignLife:
    """The life under way: what it has learnt, and the memory that keeps it."""

    def __init__(
        self,
        world: World,
        learning: QLearning,
        guidance: Guidance,
        discount: float,
        seed: int,
        robot: str,
        key: str | None,
        memory: Memory | None,
    ) -> None:
        self.world, self.learning, self.guidance, self.discount = world, learning, guidance, discount
        self.seed, self.robot, self.key, self.memory = seed, robot, key, memory
        self.name = str(getattr(world, "name", type(world).__name__))
        self.scope = hashlib.sha256(repr(("foreign", key, world.n_actions)).encode()).hexdigest()[:32]
        known = memory.recall(PRIOR_KIND, self.scope, VERSION) if memory else None
        self.prior = (
            ActionPrior.from_record(known, world.n_actions, guidance.alpha0)
            if known
            else ActionPrior(world.n_actions, guidance.alpha0, self.scope)
        )
        self.tasks_before = memory.tasks(robot) if memory else 0
        self.process = f"{os.getpid()}-{uuid.uuid4().hex[:12]}"
        self.codes, self.states, self.finished = ContextCodes(), set[Hashable](), list[dict]()

    def run(self, tasks: int, progress: Callable[[int, int, str], None] | None, stop: Event) -> None:
        for done in range(tasks):
            index = self.tasks_before + done
            try:
                self._live_task(index, done, stop)
            except Stopped:
                break
            if progress:
                progress(done + 1, tasks, f"task {index}")

    def _live_task(self, index: int, seq: int, stop: Event) -> None:
        drawn = stream(self.seed, "task", index, "world").integers(2**31, size=self.learning.episodes)
        trial = _Trial(self.world, self.codes, self.learning, self.discount, index, drawn.tolist(), stop)
        # Equal streams of their own choices make the comparison of the two a paired one.
        learners = {
            name: _Learner(
                self.world.n_actions,
                self.prior if name == "lore" else None,
                self.guidance,
                stream(self.seed, "task", index, "own"),
            )
            for name in AGENTS
        }
        agents = {name: trial.live(learner) for name, learner in learners.items()}
        news = self._learn(learners["lore"])
        if self.memory:
            about = {"index": index, "world": self.name}
            records = [news] if len(news.slots) else []
            self.memory.contribute(self.robot, records, process=self.process, seq=seq, task=about)
        for learner in learners.values():
            self.states.update(learner.q.number)
        self.finished.append({"index": index, "goal": None, "optimal_return": None, "agents": agents})

    def _learn(self, learner: _Learner) -> Record:
        """Count a finished task's policy (Eq. 3.5, 3.7); the contribution."""
        news = ActionPrior(self.world.n_actions, self.guidance.alpha0, self.scope)
        news.update(*learner.best(), self.guidance.weight)
        self.prior.merge(news)
        return news.to_record({"prior": "foreign", "world": self.name, "means": self.key})

    def report(self, settings: dict, seconds: float) -> dict:
        return {
            "domain": self.name,
            "map": None,
            "n_states": len(self.states),
            "n_contexts": len(self.prior),
            "seed": self.seed,
            "settings": settings,
            "tasks": self.finished,
            "summary": _summarise(self.finished) if self.finished else {},
            "memory": {"tasks_before": self.tasks_before, "tasks_after": self.tasks_before + len(self.finished)},
            "seconds": seconds,
        }


def _column(tasks: list[dict], agent: str, measure: str) -> NDArray[np.float64]:
    return np.array([task["agents"][agent][measure] for task in tasks], np.float64)


def _summarise(tasks: list[dict]) -> dict:
    last = third(tasks, "last")
    beside = {m: [_column(last, name, m) for name in AGENTS] for m in MEASURES}
    return {
        "lore_vs_scratch": {
            "jumpstart": plain(jumpstart(*beside["first_return"])) | _raw(beside["first_return"]),
            "mean_return_difference": _difference(beside["mean_return"]),
            "final_return_difference": _difference(beside["final_return"]),
            "never_reached": {who: sum(not t["agents"][who]["reached"] for t in last) for who in AGENTS},
        },
        "agents": {
            name: {
                which: {m: plain(mean_estimate(_column(third(tasks, which), name, m))) for m in MEASURES}
                for which in ("first", "last")
            }
            for name in AGENTS
        },
    }


def _difference(pair: list[NDArray[np.float64]]) -> dict:
    return plain(mean_estimate(pair[0] - pair[1])) | _raw(pair)


def _raw(pair: list[NDArray[np.float64]]) -> dict:
    return {"raw": {name: float(values.mean()) for name, values in zip(AGENTS, pair, strict=True)}}
