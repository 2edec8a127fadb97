"""C4.11: losses of every ball size at every speed, in several games. Thesis: §4.8.5.2, Figure 4.15."""

from collections.abc import Iterator, Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from lifelore.core.metrics import Estimate, mean_estimate
from lifelore.core.streams import stream
from lifelore.domains.ball_game.ball_game import SIZES, SPEEDS
from lifelore.figures.style import Axes
from reproduction.chapter4.ball_game.games import Game, choices
from reproduction.chapter4.ball_game.games import check_games as check
from reproduction.chapter4.ball_game.looks import size_lines
from reproduction.chapter4.ball_game.play import Players, play_speeds, scale_of
from reproduction.engine.estimates import exact_value
from reproduction.figures.curves import draw_curves
from reproduction.figures.panels import panels

__all__ = ["cells", "check", "readings", "rows", "run_cell"]
SLOW, FAST = [0, 1], [3, 4]
"""Speeds 30 and 40, 60 and 70."""


def cells(settings: Mapping) -> list[dict]:
    """A cell for each game; every normalisation uses the same episodes."""
    return [{"game": game} for game in settings["games"]]


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """Steps and collisions of every size at every speed, (n_types, n_speeds, episodes) as lists."""
    game = Game.parsed(cell["game"]).game
    kinds = np.arange(game.n_types).repeat(settings["episodes"])
    played = np.array(play_speeds(game, Players.drawn(kinds, 1, stream(seed, "C4.11", "players"))))
    by_speed = played.reshape(game.n_speeds, 2, game.n_types, settings["episodes"])
    steps, hits = by_speed.transpose(1, 2, 0, 3).tolist()
    return {"game": cell["game"], "steps": steps, "hits": hits}


def losses(result: Mapping, normalisation: str) -> NDArray[np.float64]:
    """Losses (n_types, n_speeds, episodes); episodes of one number met the same noise at all speeds."""
    steps, hits = np.array(result["steps"]), np.array(result["hits"])
    return scale_of(normalisation, steps, hits).loss(steps, hits)


def numbers(loss: NDArray[np.float64]) -> dict[str, Estimate]:
    """Losses saved by fast small and slow large balls, and the fall of the best speed, for (types, speeds, n)."""
    slow, fast = loss[:, SLOW].mean(axis=1), loss[:, FAST].mean(axis=1)
    best = np.array(SPEEDS)[loss.mean(axis=-1).argmin(axis=1)]
    return {
        "small_gains_by_fast": mean_estimate(slow[0] - fast[0]),
        "large_gains_by_slow": mean_estimate(fast[-1] - slow[-1]),
        "best_speed_falls_by": exact_value(best[0] - best[-1], loss.shape[-1]),
    }


def readings(settings: Mapping, results: Sequence[Mapping]) -> Iterator[tuple[dict, dict[str, Estimate]]]:
    """Every game under every normalisation."""
    for result in results:
        for normalisation in settings["normalisations"]:
            yield choices(result["game"], normalisation), numbers(losses(result, normalisation))


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """Mean loss by size and speed in the first game, and half of its 95 % interval."""
    loss = losses(results[0], settings["normalisations"][0])
    error = 1.96 * loss.std(axis=-1) / np.sqrt(loss.shape[-1])
    return [{"loss": np.round(loss.mean(axis=-1), 4).tolist(), "error": np.round(error, 4).tolist()}]


SHOWN = (2, 20, 60)
"""The thesis shows three representative sizes and does not name them."""


@panels(8.4, 2.9, 1, len(SHOWN))
def draw(result: Mapping, *every: Axes) -> None:
    """Loss by speed for three sizes of the ball (Figure 4.15).

    A panel for each size, as their losses differ tenfold; a ring at the best speed.
    """
    row = result["rows"][0]
    for axes, size in zip(every, SHOWN, strict=True):
        look = size_lines([size], marker="o", markersize=4)
        mean, error = (row[key][SIZES.index(size)] for key in ("loss", "error"))
        draw_curves(axes, SPEEDS, {f"b = {size}": {"mean": mean, "deviation": error}}, looks=look, legend=False)
        best = min(range(len(mean)), key=mean.__getitem__)
        axes.plot(SPEEDS[best], mean[best], "o", ms=10, mfc="none", mec=look[f"b = {size}"]["color"], mew=1.5)
        axes.set(title=f"b = {size}", xlabel="speed z", xticks=SPEEDS, ylim=(0, None))
    every[0].set_ylabel("mean loss, band 95 %")
