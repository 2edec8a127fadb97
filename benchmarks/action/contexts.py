"""`bench contexts`: contexts learnt from pixels beside contexts written by hand, in MiniGrid's crossings.

The agent sees its 7 × 7 cells as an image of 28 × 28 pixels. Its prior is conditioned on (a) which of left, front
and right are free, written by hand, (b) the nearest of k centres, learnt by k-means from images of other layouts,
(c) the image itself. Each task is a layout; the agent learns it over its pose. All lives of a run share their
tasks, episodes and random streams, and so the same ``scratch``.
"""

from collections.abc import Callable
from typing import Any

import gymnasium
import numpy as np
from numpy.typing import NDArray

from benchmarks.rounds import at_least, estimated_row, row
from lifelore.action.features.learnt_contexts import LearntContexts
from lifelore.agent.external_world.live_in import live_in
from lifelore.bridges.gymnasium_world import GymnasiumWorld
from lifelore.core.metrics import interquartile_mean_estimate, mean_estimate
from lifelore.core.protocols import Progress
from lifelore.core.streams import stream

WORLD = "SimpleCrossingS9N2"
TILE = 4
"""Pixels a side of a cell in the image."""
CODES = (8, 32, 128)
BY_HAND, PIXELS = "by hand", "the image itself"
FIT_LAYOUTS, FIT_STEPS = 20, 50
"""Layouts of the random walks whose images the centres are learnt from, and steps of each walk."""
LIFE: dict[str, Any] = {"tasks": 8, "episodes": 60, "max_steps": 150}
MEASURES = {"first_return": "first episode", "mean_return": "all episodes"}
LEAST_LIVES = 5


class PixelCrossing(gymnasium.ObservationWrapper):
    """A crossing observed as (pose, image, by hand); each view of a layout is drawn once."""

    def __init__(self, name: str = WORLD) -> None:
        super().__init__(gymnasium.make(f"minigrid:MiniGrid-{name}-v0", disable_env_checker=True))
        self.grid_env: Any = self.env.unwrapped
        self.grid_env.gen_obs = dict  # the symbolic view goes unused
        self.action_space = gymnasium.spaces.Discrete(3)
        self._views: dict[tuple, tuple[NDArray[np.uint8], tuple[bool, ...]]] = {}

    def reset(self, **settings: Any) -> tuple[Any, dict[str, Any]]:
        """Reset; a layout is known by its grid."""
        _, about = self.env.reset(**settings)
        self._layout = self.grid_env.grid.encode().tobytes()
        return self.observation({}), about

    def observation(self, observation: Any) -> tuple[tuple, NDArray[np.uint8], tuple[bool, ...]]:
        """Pose, image, and which of left, front and right are free or the goal."""
        env = self.grid_env
        column, line = env.agent_pos
        pose = int(column), int(line), int(env.agent_dir)
        known = (self._layout, pose)
        if known not in self._views:
            image = np.asarray(env.get_frame(tile_size=TILE, agent_pov=True), np.uint8)
            self._views[known] = image, tuple(_free(env.grid, *pose, turn) for turn in (3, 0, 1))
        return pose, *self._views[known]


def _free(grid: Any, x: int, y: int, facing: int, turn: int) -> bool:
    right, down = ((1, 0), (0, 1), (-1, 0), (0, -1))[(facing + turn) % 4]
    thing = grid.get(x + right, y + down)
    return thing is None or thing.type == "goal"


def images_of_walks(env: gymnasium.Env, run: int) -> NDArray[np.uint8]:
    """Images of random walks through layouts that are no tasks of the run, (n, height, width, 3)."""
    random, images = stream(run, "bench", "contexts", "walks"), []
    for _ in range(FIT_LAYOUTS):
        seen, _ = env.reset(seed=int(random.integers(2**31)))
        for _ in range(FIT_STEPS):
            images.append(seen[1])
            seen, _, terminated, truncated, _ = env.step(int(random.integers(3)))
            if terminated or truncated:
                break
    return np.array(images)


def context_functions(run: int, codes: tuple[int, ...] = CODES) -> dict[str, Callable[[Any], Any]]:
    """Name to context function; the learnt ones are fitted for the run."""
    images = images_of_walks(PixelCrossing(), run)
    ways: dict[str, Callable[[Any], Any]] = {BY_HAND: lambda seen: seen[2]}
    for n in codes:
        ways[f"{n} learnt codes"] = _by_image(LearntContexts.fit(images, n, seed=run))
    return ways | {PIXELS: lambda seen: seen[1].tobytes()}


def _by_image(contexts: LearntContexts) -> Callable[[Any], int]:
    codes: dict[bytes, int] = {}  # the same few views return at every step

    def code(seen: Any) -> int:
        image = seen[1].tobytes()
        if image not in codes:
            codes[image] = contexts(seen[1])
        return codes[image]

    return code


def bench_contexts(
    repeats: int, progress: Progress, life: dict[str, Any] = LIFE, codes: tuple[int, ...] = CODES
) -> dict:
    """Rows and goals; see `benchmarks.bench`. `repeats` are lives with each kind of context."""
    gains: dict[str, dict[str, list[list[float]]]] = {}
    sizes: dict[str, list[int]] = {}
    for run in range(repeats):
        for place, (name, context) in enumerate(context_functions(run, codes).items()):
            world = GymnasiumWorld(PixelCrossing(), state=lambda seen: seen[0], context=context, seed=run)
            with world:
                report = live_in(world, seed=run, **life)
            half = report["tasks"][-max(1, len(report["tasks"]) // 2) :]
            sizes.setdefault(name, []).append(report["n_contexts"])
            for measure in MEASURES:
                own = [task["agents"]["lore"][measure] - task["agents"]["scratch"][measure] for task in half]
                gains.setdefault(measure, {}).setdefault(name, []).append(own)
            kinds = len(codes) + 2
            progress(run * kinds + place + 1, repeats * kinds, f"{name}, life {run + 1}")
    rows = [row(f"contexts in the prior: {name}", float(np.mean(n)), "contexts") for name, n in sizes.items()]
    for measure, words in MEASURES.items():
        for name, values in gains[measure].items():
            estimates = {
                "mean": mean_estimate(np.mean(values, axis=1)),
                "interquartile mean": interquartile_mean_estimate(values),
            }
            for kind, estimate in estimates.items():
                rows.append(estimated_row(f"{words}, lore minus scratch, {kind}: {name}", estimate, "return"))
    return {"rows": rows, "goals": [at_least("lives with each kind of context", LEAST_LIVES, repeats)]}
