"""Estimates the time of a life before it starts, and chooses the agents of a life in a big world."""

from lifelore.agent.live.baselines import agents_for
from lifelore.agent.live.life_settings import LifeSettings

BIG = 100_000
"""Number of places above which an agent lives alone unless the settings ask for the comparison."""
LONG = 60.0
"""Estimated seconds from which on a life gets a line of advice."""
FIRST, LATER = 55e-6, 4e-6
"""Processor seconds a place of one agent's first task, with reading and storing the map, and of a later task. Time
grows in proportion to the places. Measured at 5,000 to 80,000 places, see docs/courier.md; `frontier` takes up to
five times as long. Learner q has no such law."""


def size_of_life(settings: LifeSettings, places: int) -> tuple[list[str], str | None]:
    """Names of the agents that live, and a line of advice if the world is big or the life long; else None.

    Parameters
    ----------
    settings : LifeSettings
    places : int
        Number of states of the world.
    """
    agent, learner = settings.agent, settings.learner
    names = agents_for(agent, learner, places <= BIG if settings.compare is None else settings.compare)
    left_out = settings.compare is None and len(names) < len(agents_for(agent, learner))
    seconds = estimated_seconds(places, len(names), settings.n_tasks) if learner == "model" else 0.0
    if seconds < LONG and not left_out:
        return names, None
    words = [f"{places:,} places"]
    if seconds:
        words.append(f"about {_duration(seconds)} for {settings.n_tasks} tasks of {', '.join(names)}")
    if left_out:
        words.append(f"above {BIG:,} places scratch lives beside {agent} only with --set compare=true")
    smaller = ["a larger cell (--set cell=METRES)"] if settings.world.domain == "building" else ["fewer tasks"]
    advice = " or ".join(smaller + ["fewer agents"] * (len(names) > 1))
    return names, "; ".join(words) + f"; {advice} takes less"


def estimated_seconds(places: int, agents: int, tasks: int) -> float:
    """Estimated processor seconds of a life with learner model."""
    return places * agents * (FIRST + LATER * (tasks - 1))


def _duration(seconds: float) -> str:
    return f"{seconds:.0f} s" if seconds < 90 else f"{seconds / 60:.0f} min"
