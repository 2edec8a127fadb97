"""C5.9: agents against opponents and users whose types switch, in the thesis's worlds and four small games.

A run is an opponent that uses a few of the world's types, in an order that its schedule decides. All agents meet
the same used types, patterns and luck; which types they meet then depends on what they do, where types answer to
it. An agent's share is what it gains in all episodes over what an agent gains that knows each type: a ratio of
sums over runs in each world, and the mean over worlds. Intervals resample runs.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import cache
from itertools import product

import numpy as np
from numpy.typing import NDArray

from lifelore.core.metrics import Estimate, mean_estimate, ratio_estimate
from lifelore.core.streams import stream
from lifelore.figures.style import BLUE, GREEN, GREY, INK, ORANGE, PURPLE, SKY, Axes
from reproduction.chapter5.c5_09_switching.agents import AGENTS, KNOWS, OKR, OURS, STATIC, KnowsType
from reproduction.chapter5.c5_09_switching.rounds import RoundWorld
from reproduction.chapter5.c5_09_switching.schedules import GROUPS, SCHEDULES, Opponent
from reproduction.chapter5.c5_09_switching.small_games import GAMES, MatrixGame
from reproduction.chapter5.c5_09_switching.thesis_worlds import ball_game, golf, pacman, surveillance, telephone
from reproduction.engine.estimates import exact_value
from reproduction.figures.interval_bars import draw_interval_bars
from reproduction.figures.panels import panels

Array = NDArray[np.float64]
World = RoundWorld | MatrixGame
OF_THESIS: dict[str, Callable[[Mapping, int], RoundWorld]] = {
    "golf": lambda settings, seed: golf(),
    "telephone": lambda settings, seed: telephone(),
    "surveillance": lambda settings, seed: surveillance(),
    "Pacman": lambda settings, seed: pacman(settings["recorded"], settings["training"], seed),
    "ball game": lambda settings, seed: ball_game(settings["recorded"], seed),
}
"""Worlds of the thesis by name, from the settings and a seed."""


@cache
def _world(name: str, recorded: int, training: int, seed: int) -> World:
    if name in GAMES:
        return GAMES[name]()
    return OF_THESIS[name]({"recorded": recorded, "training": training}, seed)


def world_of(name: str, settings: Mapping, seed: int) -> World:
    """A world by name, made once."""
    return _world(name, settings["recorded"], settings["training"], seed)


def cells(settings: Mapping) -> list[dict]:
    """Every world with every schedule."""
    return [{"world": world, "schedule": schedule} for world, schedule in product(settings["worlds"], SCHEDULES)]


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """What each agent gains in each run, (n_runs,) by agent."""
    world = world_of(cell["world"], settings, seed)
    gains = {
        name: [round(_gain(settings, cell, world, name, run, seed), 4) for run in range(settings["runs"])]
        for name in AGENTS
    }
    return {**cell, "gains": gains}


def _gain(settings: Mapping, cell: Mapping, world: World, name: str, run: int, seed: int) -> float:
    here = seed, "C5.9", cell["world"], cell["schedule"], run
    pays = world.library.performance.mean
    opponent = Opponent(pays, world.outcomes, cell["schedule"], stream(*here, "opponent"))
    agent, gain = AGENTS[name](world.library, stream(*here, "agent")), 0.0
    for episode in range(settings["episodes"]):
        if isinstance(agent, KnowsType):
            agent.type = opponent.type
        lived = world.play(stream(*here, "luck", episode), opponent.type, agent)
        opponent.end_episode(lived)
        gain += lived.gain
    return gain


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """Shares by agent and group of schedules; the least upper ends of our differences to two agents.

    ``okr_upper``: of all groups, the least upper end of the interval of our share minus that of Bayes-OKR; at
    least 0 where ours is never below by more than the interval. ``static_upper``: the same of the static agent,
    where types are static.
    """
    found = {
        f"{key_of(name)}_{group}": _share(results, name, GROUPS[group])
        for name, group in product(AGENTS, GROUPS)
        if name != KNOWS
    }
    return found | {
        "okr_upper": exact_value(min(_upper(results, OKR, group) for group in GROUPS.values())),
        "static_upper": exact_value(_upper(results, STATIC, GROUPS["known"])),
    }


def readings(settings: Mapping, results: Sequence[Mapping]) -> Iterator[tuple[dict, dict[str, Estimate]]]:
    """All worlds, those of the thesis, and the small games."""
    for words, names in (("all", OF_THESIS | GAMES), ("of the thesis", OF_THESIS), ("small games", GAMES)):
        own = [result for result in results if result["world"] in names]
        if own:
            yield {"worlds": words}, measure(settings, own)


def key_of(name: str) -> str:
    """An agent in the name of a measure."""
    return {OURS: "ours", OKR: "okr"}.get(name, name.lower().translate(str.maketrans(" -.+", "___p")))


def _share(results: Sequence[Mapping], name: str, schedules: Sequence[str]) -> Estimate:
    """What an agent gains over what one gains that knows the types; interval over runs."""
    return ratio_estimate(_relative(results, name, schedules), _relative(results, KNOWS, schedules))


def _upper(results: Sequence[Mapping], other: str, schedules: Sequence[str]) -> float:
    """Upper end of the interval of our share minus another agent's."""
    found = mean_estimate(_relative(results, OURS, schedules) - _relative(results, other, schedules))
    return found.ci95[1] if found.ci95 else found.value


def _relative(results: Sequence[Mapping], name: str, schedules: Sequence[str]) -> Array:
    """Gains by run, (n_runs,), in units of what is gained on average by who knows the types; mean over cells."""
    own = [result["gains"] for result in results if result["schedule"] in schedules]
    return np.mean([np.array(gains[name]) / np.mean(gains[KNOWS]) for gains in own], axis=0)


LABELS = {
    "known": "static", "every_ten": "any type\nevery ten", "every_two": "any type\nevery two",
    "adaptive": "adaptive", "exact": "exact\npatterns", "noise": "patterns,\n20 % noise",
    "unknown": "unknown\npatterns",
}  # fmt: skip
COLOURS = (GREY, SKY, ORANGE, BLUE, PURPLE, GREEN)
"""Of the agents in their order."""


@panels(10.5, 3.8)
def draw(result: Mapping, axes: Axes) -> None:
    """Shares of the agents by kind of schedule, with 95 % intervals.

    A group of bars for each kind of schedule, a bar for each agent; the line is who knows the type.
    """
    shares = {
        name: [result["measured"][f"{key_of(name)}_{group}"] for group in GROUPS]
        for name in AGENTS
        if name != KNOWS
    }
    names = [LABELS[group] for group in GROUPS]
    draw_interval_bars(axes, names, shares, colours=COLOURS, horizontal=False, words=None, legend=False)
    axes.axhline(1, color=INK, linestyle=":", linewidth=1)
    axes.set(ylabel="share of what is gained\nwith the type known", ylim=(0, 1.05))
    axes.set_axisbelow(True)
    axes.figure.legend(loc="outside right upper")
