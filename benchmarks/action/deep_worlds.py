"""What `bench deep` explores and learns in: MiniGrid's crossings, one layout a task, and a prior from others."""

from collections.abc import Callable
from typing import Any

import gymnasium
import numpy as np

from lifelore.action.priors.action_prior import ActionPrior
from lifelore.bridges.minigrid_view import N_MOVES, SymbolicView, open_directions, solved_layout
from lifelore.core.streams import stream

SOURCES = ("SimpleCrossingS9N2", "SimpleCrossingS9N3")
"""Where the prior is learnt: two and three walls to cross. No layout of the worlds tested is among these."""
LAYOUTS = 20
"""Of each source."""
SEVEN, UNIFORM, GUIDED = "uniform over seven actions", "uniform over three moves", "prior"


def new_world(name: str) -> gymnasium.Env:
    """One of MiniGrid's environments."""
    return gymnasium.make(f"minigrid:MiniGrid-{name}-v0")


class OneLayout(gymnasium.Wrapper):
    """The same layout in every episode: a task of its own."""

    def __init__(self, env: gymnasium.Env, layout: int) -> None:
        super().__init__(env)
        self.layout = layout

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Any, dict[str, Any]]:
        """Always with the layout's seed."""
        return self.env.reset(seed=self.layout, options=options)


def one_layout(name: str, layout: int) -> gymnasium.Env:
    """A world for one who walks, with a layout of its own."""
    return OneLayout(SymbolicView(new_world(name)), layout)


def crossing_prior() -> ActionPrior:
    """Best moves on the shortest ways through the sources' layouts, by which ways are open."""
    prior = ActionPrior(N_MOVES, key="open ways: left, front, right")
    for name in SOURCES:
        env = new_world(name)
        for number in range(LAYOUTS):
            env.reset(seed=layout_seed(name, number))
            layout = solved_layout(env)
            prior.update(layout.open_directions[layout.passed], layout.best[layout.passed])
    return prior


def layout_seed(*names: str | int) -> int:
    """The seed of one of MiniGrid's layouts."""
    return int(stream(0, "bench", "deep", "layout", *names).integers(2**31))


def exploring(name: str, prior: ActionPrior, episodes: int) -> dict[str, list[int]]:
    """Steps to the goal in each episode of exploring alone, 0 where time ran out, by who explores."""
    world, walker = new_world(name), SymbolicView(new_world(name))
    random = stream(0, "bench", "deep", "exploring", name)
    ways: dict[str, tuple[gymnasium.Env, Callable[[Any], int]]] = {
        SEVEN: (world, lambda seen: int(random.integers(7))),
        UNIFORM: (walker, lambda seen: int(random.integers(N_MOVES))),
        GUIDED: (walker, lambda seen: int(prior.sample(open_directions(seen[None]), random)[0])),
    }
    return {
        who: [_steps_to_goal(env, choose, layout_seed(name, "exploring", k)) for k in range(episodes)]
        for who, (env, choose) in ways.items()
    }


def _steps_to_goal(env: gymnasium.Env, choose: Callable[[Any], int], seed: int) -> int:
    seen, _ = env.reset(seed=seed)
    steps = 0
    while True:
        seen, _, terminated, truncated, _ = env.step(choose(seen))
        steps += 1
        if terminated:
            return steps
        if truncated:
            return 0


def excluded_best(name: str, prior: ActionPrior, layouts: int, threshold: float = 0.0) -> float:
    """Share of the poses on shortest ways whose every best move the prior's mask excludes."""
    env, ways, best = new_world(name), [], []
    for number in range(layouts):
        env.reset(seed=layout_seed(name, "exploring", number))
        layout = solved_layout(env)
        ways.append(layout.open_directions[layout.passed])
        best.append(layout.best[layout.passed])
    return prior.exclusion_rate(np.concatenate(ways), np.concatenate(best), threshold)
