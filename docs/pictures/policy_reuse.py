"""The thesis's pictures of policy reuse as ours draws them: Figures 4.1, 4.2, 4.3, 4.7, 4.9, 4.13 and 4.14.

``python -m docs.pictures.policy_reuse`` writes them to ``docs/pictures``. Figure 4.1's curves are
made up, as the thesis's are; Figure 4.13's surface is what claim C4.11 measured. Figure 4.5 is part of claim
C4.3's.
"""

import json
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from docs.pictures.ball_game_picture import draw_ball_game
from docs.pictures.figure_category_bars import draw_category_bars
from docs.pictures.figure_graph_models import draw_interaction_model, draw_type_model
from docs.pictures.figure_performance_curves import draw_performance_curves
from docs.pictures.figure_reserve_map import draw_reserve_maps
from docs.pictures.figure_response_surface import draw_response_surface
from docs.pictures.figure_world_plates import draw_world_plates
from docs.pictures.pacman_picture import draw_pacman
from lifelore.core.streams import stream
from lifelore.domains.ball_game.ball_game import SIZES, SPEEDS, ball_game
from lifelore.domains.golf.golf import CLUBS, EDGES, HOLES, Golf
from lifelore.domains.pacman.pacman import PacmanMaze, PacmanTask
from lifelore.domains.surveillance.surveillance import BASE, LAYOUTS, SIDE, Surveillance
from lifelore.figures.style import save_figure

if TYPE_CHECKING:
    from matplotlib.figure import Figure

FOLDER, RESULTS = Path("docs/pictures"), Path("reproduction/results")


def plates(results: Path = RESULTS) -> Iterator[tuple[str, "Figure"]]:
    """File name and figure of each; `results` holds that of claim C4.11."""
    yield "reuse_curves", _curves()
    yield "reuse_model", draw_type_model()
    yield "reuse_clubs", draw_category_bars(Golf().category_probs, EDGES, CLUBS, HOLES)
    reserves = {name: Surveillance(name) for name in LAYOUTS}
    maps = {name: (reserve.targets, reserve.is_hilltop) for name, reserve in reserves.items()}
    yield "reuse_reserves", draw_reserve_maps(maps, BASE, SIDE)
    mean, error = _losses(results)
    sizes, speeds = [f"b = {b}" for b in SIZES], [str(speed) for speed in SPEEDS]
    words = ("size of the ball", "speed", "minus the loss")
    yield "reuse_surface", draw_response_surface(-mean, error, sizes, speeds, words=words)
    yield "reuse_interaction", draw_interaction_model()
    yield "reuse_games", draw_world_plates(list(_games()))


def _curves() -> "Figure":
    tasks = np.linspace(0, 10, 200)
    curves = {
        "$\\pi_1$": 4 + 3 * np.sin(tasks / 2.2),
        "$\\pi_2$": 5 + 2.4 * np.cos(tasks / 1.9 + 0.6),
        "$\\pi_3$": 2.2 + 0.45 * tasks,
    }
    types = {"$\\tau_1$": 1.2, "$\\tau_2$": 3.6, "$\\tau_3$": 6.0, "$\\tau_4$": 8.6}
    return draw_performance_curves(
        tasks, curves, types, 7.2, shown=("$\\tau_1$", "$\\pi_3$"), deviation=0.5, epsilon=1.2
    )


def _losses(results: Path) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Mean loss and its error (n_sizes, n_speeds) in the ball game's default."""
    result = json.loads((results / "C4.11" / "result.json").read_text(encoding="utf-8"))
    row = result["rows"][0]
    return np.array(row["loss"]), np.array(row["error"])


def _games() -> Iterator[tuple[str, NDArray[np.uint8]]]:
    maze = PacmanMaze()
    task = PacmanTask(maze, maze.draw_foods(stream(0, "reuse plates", "pacman")), "clockwise")
    yield "Pacman (4.7)", draw_pacman(task, int(task.starts[0]))
    for layout in ("s-maze 160", "blobs", "open field"):
        yield f"ball game, {layout} (4.14)", draw_ball_game(ball_game(layout))


if __name__ == "__main__":
    for name, figure in plates():
        print(save_figure(figure, FOLDER / f"{name}.png"))
