"""Sentences on what makes a life in an external world useless, or its comparison misleading."""

from collections.abc import Collection, Sequence

LEAST_TASKS = 4
"""Tasks below which new contexts say nothing: each first task has new ones."""
MOSTLY_NEW = 0.95
"""Share of the states of the last tasks whose context no earlier task has, from which a prior cannot help."""

LEAST_MOVES = 200
"""Moves of a task below which new states say nothing: each first episode has new ones."""
HARDLY_REPEAT = 0.9
"""Share of a task's moves that begin in a state, or pay a reward, not met before, from which nothing is learnt."""
LEAST_REWARDS = 30
"""Moves of a task below which new rewards say nothing."""


def new_states(world: str, states: Sequence[int]) -> list[str]:
    """A sentence if the states in which a task's moves began hardly repeat, else none."""
    says = "began in a state that the task had not met before, so hardly anything can be learnt. "
    return _hardly_repeat(world, states, LEAST_MOVES, says + "Pass state= to bin continuous observations.")


def new_rewards(world: str, rewards: Sequence[float]) -> list[str]:
    """A sentence if the rewards of a task's moves hardly repeat, else none."""
    says = (
        "paid a reward that no move had paid before, so known types look new. Round noisy rewards with "
        'gymnasium.wrappers.TransformReward, or pass signals="returns" and another key.'
    )
    return _hardly_repeat(world, rewards, LEAST_REWARDS, says)


def _hardly_repeat(world: str, values: Sequence[float], least: int, says: str) -> list[str]:
    """A sentence if at least `least` values of a task's moves hardly repeat, else none."""
    share = len(set(values)) / len(values) if len(values) >= least else 0.0
    return [f"Of {len(values):,} moves in a task of {world}, {share:.0%} {says}"] if share >= HARDLY_REPEAT else []


class ContextNovelty:
    """Share of the states of each task whose context was in no earlier task and has no counts in the prior."""

    def __init__(self, known: Collection[int]) -> None:
        self._known = set(known)
        self.shares: list[float] = []

    def end_task(self, codes: Sequence[int]) -> None:
        """Add a finished task: the context code of each visited state."""
        new = sum(code not in self._known for code in codes)
        self.shares.append(new / len(codes) if codes else 0.0)
        self._known.update(codes)

    @property
    def late(self) -> float:
        """Mean share of the second half of the tasks; 0 for fewer than `LEAST_TASKS` tasks."""
        late = self.shares[len(self.shares) // 2 :] if len(self.shares) >= LEAST_TASKS else []
        return sum(late) / len(late) if late else 0.0


def life_warnings(
    world: str, tasks: int, n_contexts: int, novelty: float, one_task: bool, summary: dict
) -> list[str]:
    """The sentences for a life; empty where all is well.

    Parameters
    ----------
    world : str
        Its name.
    tasks, n_contexts : int
        Finished tasks, and contexts in the prior at the end.
    novelty : float
        `ContextNovelty.late`.
    one_task : bool
        Whether nothing that was observed tells the tasks apart.
    summary : dict
        The ``summary`` of the report.
    """
    if not tasks:
        return []
    sentences = []
    if not n_contexts:
        sentences.append(
            f"The action prior is empty after {tasks} tasks in {world}, so lore explores like scratch: no task "
            "had a positive value, nor an ended episode with a better return than others. Use more episodes or "
            "steps, or another reward."
        )
    if one_task:
        sentences.append(
            f"Nothing that was observed tells the {tasks} tasks of {world} apart, except perhaps where they "
            "start: the same actions in the same states have the same outcomes. A gain over scratch is then "
            "practice in one task, not transfer. Give GymnasiumWorld a function from task number to environment."
        )
    if novelty >= MOSTLY_NEW:
        sentences.append(
            f"Of the states met in later tasks of {world}, {novelty:.0%} have a context that no earlier task had, "
            "so the prior can hardly help. Pass context= (few, coarse features), and state= if observations are "
            "continuous."
        )
    return sentences + _losses(summary)


def _losses(summary: dict) -> list[str]:
    """A sentence for each agent below which the final return falls with certainty."""
    sentences = []
    for other in ("scratch", "textbook"):
        found = summary.get(f"lore_vs_{other}", {}).get("final_return_difference", {})
        interval = found.get("ci95")
        if interval is not None and interval[1] < 0:
            sentences.append(
                f"The final return of lore is certainly below that of {other}: a difference of "
                f"{found['value']:.3g}, 95 % interval {interval[0]:.3g} to {interval[1]:.3g}, over {found['n']} "
                "tasks. The prior misleads here: use other contexts, or a larger alpha0."
            )
    return sentences
