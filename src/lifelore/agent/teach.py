"""Records demonstrations of a person who walks to goals in a grid world by keys (`lifelore teach`).

Keys are read as text, from a terminal or a pipe: w a s d or the arrow keys move, n skips the task, q quits. Only
walks that reach the goal are written.
"""

import re
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from typing import Any

import numpy as np

from lifelore.action.demonstrations.competence import competence_by_steps
from lifelore.action.demonstrations.demonstrations import Demonstration, count_demonstrations, write_demonstrations
from lifelore.action.priors.action_prior import ActionPrior
from lifelore.action.priors.policy_counts import actions_to_count
from lifelore.action.priors.prior_file import save_prior
from lifelore.agent.live.lore import PERCEPT_KEY
from lifelore.core.errors import InputError
from lifelore.core.mdp import COLLISION, TERMINAL
from lifelore.core.planning.planning import optimal_q
from lifelore.core.streams import stream
from lifelore.domains.grids.grid_world import MOVE_NAMES, PERCEPT, GridWorld
from lifelore.domains.worlds import WorldSettings, world_from_settings

MOVE_OF = {"w": 0, "\x1b[A": 0, "s": 1, "\x1b[B": 1, "d": 2, "\x1b[C": 2, "a": 3, "\x1b[D": 3}
"""Number of the move of each key, in the order of `MOVES`; terminals send arrow keys as escape sequences."""
_KEY = re.compile(r"\x1b[\[O][ABCD]|\S")
ROWS, COLUMNS = 31, 79
"""Maximum number of cells shown; of a larger world the part around the agent is shown."""
HELP = "move with w a s d or the arrow keys, then Enter (several keys a line are allowed); n next task, q quit"


def teach(
    settings: WorldSettings,
    lines: Iterable[str],
    show: Callable[[str], None],
    *,
    out: str | Path,
    person: str = "person",
    tasks: int = 3,
    seed: int = 0,
    prior: str | Path | None = None,
) -> dict[str, Any]:
    """Let a person demonstrate `tasks` tasks; append the demonstrations to the file `out`.

    Parameters
    ----------
    settings : WorldSettings
    lines : iterable of str
        Lines that the person types; the lesson ends where they end.
    show : callable
        Called with each picture and message.
    out : str or Path
        Demonstrations are appended as JSON lines, see `lifelore.action.demonstrations.demonstrations`.
    person : str
        The name written as `agent`.
    tasks : int
        At least 1.
    seed : int
        Draws goals and starts.
    prior : str or Path, optional
        File for the percept prior of this lesson, weighted by the person's estimated competence.

    Returns
    -------
    dict
        ``out``, ``person``, ``shown`` (tasks whose goal was reached), ``given_up`` (tasks begun without reaching
        the goal), ``steps``, ``competence`` (w(π) in [0, 1] by `competence_by_steps`; None without a
        demonstration), ``prior`` (path of its file, or None).
    """
    if tasks < 1:
        raise InputError(f"tasks must be at least 1, got {tasks}")
    if not person.strip():
        raise InputError("name must not be empty, got an empty text; name the person who teaches")
    for path in (out, prior):
        _check_path(path)
    if prior is not None and Path(out).resolve() == Path(prior).resolve():
        raise InputError(f"out and prior must be two files, got '{out}' for both")
    world = world_from_settings(settings)
    shown, begun, best = _lesson(world, settings, lines, show, person, tasks, seed)
    weights = competence_by_steps(shown, best.__getitem__)
    write_demonstrations(out, shown, append=True)
    if prior is not None:
        save_prior(_percept_prior(world, shown, weights), prior, {"percept": PERCEPT, "actions": MOVE_NAMES})
    return {
        "out": str(out),
        "person": person,
        "shown": len(shown),
        "given_up": begun - len(shown),
        "steps": sum(len(demonstration.states) for demonstration in shown),
        "competence": weights.get(person),
        "prior": None if prior is None else str(prior),
    }


def _check_path(path: str | Path | None) -> None:
    if path is not None and (not str(path) or Path(path).is_dir() or not Path(path).parent.is_dir()):
        raise InputError(f"out and prior must be files in a folder that exists, got '{path}'")


def _lesson(world: GridWorld, settings: WorldSettings, lines, show, person: str, tasks: int, seed: int):
    """Demonstrations that reached the goal, number of tasks begun, and best actions of each demonstrated task."""
    keys, shown, best, begun = _keys(lines), [], {}, 0
    show(HELP)
    for number in range(tasks):
        goal, start = (int(s) for s in stream(seed, "teach", number).choice(world.n_states, 2, replace=False))
        task = f"{world.name}/{settings.seed}/{world.fingerprint[:8]}/goal {goal}/start {start}"
        states, actions, end = _walk(world, goal, start, keys, show, f"task {number + 1} of {tasks}")
        begun += bool(actions)
        if end == "goal":
            shown.append(Demonstration(task, person, np.array(states, np.int64), np.array(actions, np.int64)))
            best[task] = _best(world, goal)
        elif end in ("q", None):
            break
    return shown, begun, best


def _keys(lines: Iterable[str]) -> Iterator[str]:
    for line in lines:
        for key in _KEY.findall(line):
            yield key.replace("\x1bO", "\x1b[") if key.startswith("\x1b") else key.lower()


def _walk(world: GridWorld, goal: int, start: int, keys: Iterator[str], show, title: str):
    """States, actions, and the end of the walk: ``goal``, key ``n``, key ``q``, or None if no key is left."""
    tables = world.task(goal).tables()
    state, states, actions = start, [], []
    show(f"{title}\n{grid_text(world, state, goal)}")
    for key in keys:
        if key in ("n", "q"):
            return states, actions, key
        if key not in MOVE_OF:
            show(f"'{key}' is no move; {HELP}" if key.isprintable() else HELP)
            continue
        move = MOVE_OF[key]
        states.append(state)
        actions.append(move)
        event = tables.event[state, move, 0]
        state = int(tables.next_state[state, move, 0])
        if event & TERMINAL:
            show(f"goal reached in {len(actions)} steps")
            return states, actions, "goal"
        note = f"{MOVE_NAMES[move]}: a wall\n" if event & COLLISION else ""
        show(f"{note}{grid_text(world, state, goal)}")
    return states, actions, None


def grid_text(world: GridWorld, agent: int, goal: int) -> str:
    """The world around the agent as text: ``#`` wall, ``.`` free, ``G`` goal, ``@`` agent."""
    picture = np.full(world.shape, "#")
    picture[tuple(world.cells.T)] = "."
    picture[tuple(world.cells[goal])] = "G"
    picture[tuple(world.cells[agent])] = "@"
    (top, left), (height, width) = world.cells[agent] - (ROWS // 2, COLUMNS // 2), world.shape
    top = max(0, min(int(top), height - ROWS))
    left = max(0, min(int(left), width - COLUMNS))
    rows = ["".join(row) for row in picture[top : top + ROWS, left : left + COLUMNS]]
    row, column = world.cells[goal]
    if not (top <= row < top + ROWS and left <= column < left + COLUMNS):
        d_row, d_column = world.cells[goal] - world.cells[agent]
        rows.append(f"goal: {abs(d_row)} {'down' if d_row > 0 else 'up'}, {abs(d_column)} "
                    f"{'right' if d_column > 0 else 'left'}")  # fmt: skip
    return "\n".join(rows)


def _best(world: GridWorld, goal: int) -> np.ndarray:
    task = world.task(goal)
    ended = np.arange(world.n_states) == goal
    return actions_to_count(optimal_q(task.tables(), world.discount), "all", ended=ended)


def _percept_prior(world: GridWorld, shown: list[Demonstration], weights: dict[str, float]) -> ActionPrior:
    prior = ActionPrior(len(MOVE_NAMES), key=PERCEPT_KEY)  # that of the priors in memory, so that they merge
    count_demonstrations(prior, shown, lambda demonstration: world.percepts[demonstration.states], weights)
    return prior
