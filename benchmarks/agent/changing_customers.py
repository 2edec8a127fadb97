"""`bench changing_customers`: customers who change within a task, followed by the long-lived agent or not.

Each round is one life of each agent in the factory, on the same tasks: where customers change between episodes
with probability `CHANGE`, and where they stay but nobody can be sure of it. A row is the return that episodes miss
of the best possible, by the number of episodes since the last change. With three repeats or more, the figure
``benchmarks/results/changing_customers.png``.
"""

from collections.abc import Sequence
from itertools import pairwise
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from benchmarks.rounds import at_least, at_most, estimated_row, row
from lifelore.agent.long_lived.families.factory_customers import FactoryFamily, OrderTask
from lifelore.agent.long_lived.knowledge import Knowledge
from lifelore.agent.long_lived.live_task import LivingSettings, live_task
from lifelore.agent.long_lived.task_family import AGENTS, AgentTask
from lifelore.core.metrics import difference_estimate, mean_estimate, ratio_estimate
from lifelore.core.protocols import Progress
from lifelore.domains.factory.customer_orders import CUSTOMERS
from lifelore.domains.task_stream import DrawnTask, TaskStream

Array = NDArray[np.float64]

CHANGE = 0.1
"""Probability that another customer comes between two episodes, where customers change."""
N_TASKS, N_EPISODES = 20, 8
KNOWING = 5
"""Tasks of a life that are not judged: the first customers are all unknown."""
FOLLOWING, STATIC, SCRATCH, TOLD = "following", "static", "scratch", "told of changes"
AGENTS_OF = {"customers change": (FOLLOWING, STATIC, SCRATCH, TOLD), "customers stay": (FOLLOWING, STATIC)}
"""Worlds and who lives there. `SCRATCH` follows too, but remembers no task. `TOLD` knows when customers change."""
SPANS = {
    "first episodes": lambda since, episode: episode == 0,
    "later episodes before a change": lambda since, episode: (since < 0) & (episode > 0),
    "episode of the change": lambda since, episode: since == 0,
    "1 episode after": lambda since, episode: since == 1,
    "2 episodes after": lambda since, episode: since == 2,
    "3 or more after": lambda since, episode: since >= 3,
    "all episodes": lambda since, episode: episode >= 0,
}
"""Spans of episodes, by the number of episodes since the last change (see `since_change`) and in the task."""
NEVER = -99
"""In place of the number of episodes until the first change, where none comes."""
UNIT = "points below the best possible"
LEAST_REPEATS = 3
COST = 0.1
"""Goal: following costs at most this share where nothing changes."""
OUT = Path("benchmarks/results")


def bench_changing_customers(repeats: int, progress: Progress, out: Path = OUT) -> dict:
    """Rows and goals; see `benchmarks.bench`."""
    missed = {world: {name: [] for name in names} for world, names in AGENTS_OF.items()}
    seen: list[tuple[int, int, int]] = []
    work = [(world, life) for life in range(repeats) for world in AGENTS_OF]
    for done, (world, life) in enumerate(work):
        tables: dict = {}
        for name, lives in missed[world].items():
            family = family_of(world, life, tables)
            found, changes = live(name, family, life)
            lives.append(found)
            if name == FOLLOWING and world == "customers change":
                seen.append(changes)
        progress(done + 1, len(work), f"{world}, life {life}")
    rows = [line for world, lives in missed.items() for line in _rows(world, lives)]
    found, false, true = np.sum(seen, axis=0).tolist()
    rows.append(row("changes that were found in their episode, of those that came", found / max(true, 1), "share"))
    rows.append(row("changes that were believed and did not come, of all believed", _share(false, found), "share"))
    if repeats >= LEAST_REPEATS:
        from benchmarks.agent.figure_changing_customers import draw_changing_customers
        from lifelore.figures.style import save_figure

        out.mkdir(parents=True, exist_ok=True)
        curves = {name: _curve(lives) for name, lives in missed["customers change"].items()}
        save_figure(draw_changing_customers(curves), out / "bench_changing_customers.png")
    return {"rows": rows, "goals": _goals(missed)}


def _share(part: int, rest: int) -> float:
    return part / max(part + rest, 1)


# ---- lives -------------------------------------------------------------------------------------------------


def family_of(world: str, life: int, tables: dict) -> FactoryFamily:
    """The orders of a life; agents share what was computed of their floors."""
    types = tuple(CUSTOMERS)
    change = CHANGE if world == "customers change" else 0.0
    return FactoryFamily(TaskStream(types, life, len(types), change=change), life, tables, changing=True)


def live(name: str, family: FactoryFamily, life: int) -> tuple[dict[str, Array], tuple[int, int, int]]:
    """Points missed and episodes since the last change, (n_tasks, n_episodes) each; changes found, false, true."""
    missed, since, counts = [], [], np.zeros(3, np.int64)
    abilities, knowledge = AGENTS["scratch" if name == SCRATCH else "full"], Knowledge.empty(family)
    living = LivingSettings(N_EPISODES, change=0.0 if name in (STATIC, TOLD) else CHANGE)
    for number in range(N_TASKS):
        if not abilities.memory:
            knowledge = Knowledge.empty(family)
        episodes = family.episodes(number, N_EPISODES)
        types = [hidden for hidden, _ in episodes]
        true = {place for place, (a, b) in enumerate(pairwise(types), 1) if a != b}
        own_name = f"agent.{number}"
        if name == TOLD:
            returns = _told(knowledge, family, number, sorted(true), own_name, life)
        else:
            drawn, task = family.meet(number, abilities)
            lived, _ = live_task(knowledge, drawn, task, abilities, living, own_name, life)
            returns, believed = lived.returns, {episode for episode, _ in lived.changes}
            counts += len(true & believed), len(believed - true), len(true)
        missed.append(np.array([best for _, best in episodes]) - np.array(returns))
        since.append(since_change(types))
    found, false, came = counts.tolist()
    return {"missed": np.array(missed), "since": np.array(since)}, (found, false, came)


def since_change(types: Sequence[str]) -> NDArray[np.int64]:
    """Episodes since the last change, below 0 before the first, `NEVER` without any.

    Examples
    --------
    >>> since_change(["a", "a", "b", "b", "a"]).tolist()
    [-2, -1, 0, 1, 0]
    """
    changes = [place for place, (a, b) in enumerate(pairwise(types), 1) if a != b]
    if not changes:
        return np.full(len(types), NEVER)
    last = [max((one for one in changes if one <= k), default=changes[0]) for k in range(len(types))]
    return np.arange(len(types)) - np.array(last)


def _told(
    knowledge: Knowledge, family: FactoryFamily, number: int, changes: list[int], name: str, life: int
) -> list[float]:
    """Live each span between two changes as a task of its own, whose answers are sure."""
    returns: list[float] = []
    for first, end in pairwise([0, *changes, N_EPISODES]):
        drawn, order = family.order(number, episode=first)
        family.meet(number, AGENTS["full"])  # computes the table of the floor
        task: AgentTask = OrderTask(order, family.tables[number])
        living = LivingSettings(end - first)
        # Spans of a task have one date; a type that is new in one is known in the next.
        lived, _ = live_task(
            knowledge, DrawnTask(number, drawn.context, drawn.hidden_type), task, AGENTS["full"], living,
            f"{name}.{first}", life,
        )  # fmt: skip
        returns += lived.returns
    return returns


# ---- the answer --------------------------------------------------------------------------------------------


def mean_missed(lives: Sequence[dict[str, Array]], span: str) -> Array:
    """(n_lives,) mean of the points missed in the episodes of a span; NaN where a life has none."""
    found = []
    for life in lives:
        since, missed = life["since"][KNOWING:], life["missed"][KNOWING:]
        chosen = SPANS[span](since, np.broadcast_to(np.arange(N_EPISODES), since.shape))
        found.append(missed[chosen].mean() if chosen.any() else np.nan)
    return np.array(found)


def _rows(world: str, lives: dict[str, list[dict[str, Array]]]) -> list[dict]:
    rows = []
    for span in SPANS:
        base = mean_missed(lives[FOLLOWING], span)
        had = np.isfinite(base)
        for name, own in lives.items():
            missed = mean_missed(own, span)
            if had.any():
                rows.append(estimated_row(f"{world}, {span}: {name}", mean_estimate(missed[had]), UNIT))
                if name != FOLLOWING:
                    more = difference_estimate(missed[had], base[had])
                    rows.append(estimated_row(f"{world}, {span}: {name}, more than {FOLLOWING}", more, UNIT))
    return rows


def _goals(missed: dict[str, dict[str, list[dict[str, Array]]]]) -> list[dict]:
    change, stay = missed["customers change"], missed["customers stay"]
    goals = []
    for name in (STATIC, SCRATCH):
        more = difference_estimate(
            mean_missed(change[name], "all episodes"), mean_missed(change[FOLLOWING], "all episodes")
        )
        low = None if more.ci95 is None else more.ci95[0]
        goals.append(at_least(f"{name} misses more than {FOLLOWING}, lower end of the interval", 0.0, low))
    cost = ratio_estimate(mean_missed(stay[FOLLOWING], "all episodes"), mean_missed(stay[STATIC], "all episodes"))
    goals.append(
        at_most(
            "cost of following where customers stay, share of what the static agent misses", COST, cost.value - 1
        )
    )
    return goals


def _curve(lives: Sequence[dict[str, Array]]) -> dict[int, tuple[float, float]]:
    """Mean and half of the 95 % interval by episodes since the change."""
    found = {}
    for since in range(-3, 5):
        each = []
        for life in lives:
            chosen = life["since"][KNOWING:] == since
            if since < 0:
                chosen &= np.arange(N_EPISODES) > 0
            each += [life["missed"][KNOWING:][chosen].mean()] if chosen.any() else []
        if each:
            found[since] = float(np.mean(each)), float(1.96 * np.std(each) / len(each) ** 0.5)
    return found
