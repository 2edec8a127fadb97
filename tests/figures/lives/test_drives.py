"""Figures of driven jobs are drawn, and say what was lost."""

from pathlib import Path
from runpy import run_path

import numpy as np
import pytest

from lifelore.domains.grids.lattice import lattice
from lifelore.figures.lives.drives import LearntFloor, draw_drives
from lifelore.figures.style import save_figure

WORLD = lattice(9)


def floor() -> LearntFloor:
    delay = np.linspace(0.9, 4.0, WORLD.n_states)
    delay[:5] = np.nan
    return LearntFloor(WORLD.shape, WORLD.cells, WORLD.neighbour, delay, WORLD.cells[:2], 0.5)


def driven(n: int) -> dict:
    return {
        "lore": {"lost": np.full(n, 30.0), "refusals": np.arange(n) % 2},
        "map only": {"lost": np.full(n, 60.0), "refusals": np.ones(n, int)},
    }


@pytest.mark.parametrize("n", [1, 2, 40])
def test_lost_minutes_are_added_up(n, tmp_path):
    figure = draw_drives(np.arange(n), driven(n), floor(), title="Jobs")
    assert save_figure(figure, tmp_path / "drives.png").stat().st_size > 5_000
    own, crosses, other, _ = figure.axes[0].lines
    assert np.asarray(own.get_ydata())[-1] == n * 0.5
    assert np.asarray(other.get_ydata())[-1] == n
    assert len(np.asarray(crosses.get_xdata())) == n // 2
    words = [text.get_text() for text in figure.axes[0].texts]
    assert words[1] == f"on the map alone\n{n} min, " + ("1 refused move" if n == 1 else f"{n} refused moves")


@pytest.mark.parametrize("seconds", [-1e-9, -0.02])
def test_a_quiet_building_shows_that_nothing_was_lost(seconds):
    figure = draw_drives(
        np.arange(4), {"lore": {"lost": np.full(4, seconds), "refusals": np.zeros(4)}}, floor(), title=""
    )
    axes = figure.axes[0]
    assert axes.get_ylim() == (0, 1)
    assert axes.texts[0].get_text() == "with memory\n0 min, 0 refused moves"
    assert axes.texts[0].xy[1] == 0  # a point below the axis would hide its words


def test_searches_and_drives_in_one_picture(tmp_path):
    demo = run_path(str(Path(__file__).parents[3] / "examples" / "demo" / "known_and_hidden.py"))
    recent = demo["RECENT"]
    searched = {"lore": [100.0] * 3 + [50.0] * recent, "scratch": [400.0] * (3 + recent)}
    figure = demo["draw_known_and_hidden"](searched, driven(20), floor(), title="Both")
    assert save_figure(figure, tmp_path / "both.png").stat().st_size > 5_000
    left = figure.axes[0]
    assert left.get_yscale() == "log"
    assert "with memory\n50 m" in [text.get_text() for text in left.texts]
