"""The running median by hand, and figures that are drawn without a warning."""

import numpy as np
import pytest

from lifelore.core.errors import InputError
from lifelore.figures.lives.life_curves import draw_life, running_median
from lifelore.figures.style import save_figure


def _agents(n: int, reached: bool = True) -> dict:
    values = {"steps_to_80": np.arange(1, n + 1) * 100, "collisions": np.zeros(n), "reached": np.full(n, reached)}
    return dict.fromkeys(("lore", "scratch"), values)


def test_running_median_narrows_towards_the_start():
    assert running_median([9, 1, 5, 2, 8, 0]).tolist() == [9, 5, 5, 2, 3.5, 2]
    assert running_median([4]).tolist() == [4]


def test_a_long_life_is_smoothed_over_a_twelfth():
    values = np.random.default_rng(0).random(240)
    assert running_median(values)[100] == np.median(values[90:111])


@pytest.mark.parametrize(("n", "reached"), [(1, True), (2, False), (40, True)])
def test_figure_is_drawn(n, reached, tmp_path):
    figure = draw_life(np.arange(n) + 30, _agents(n, reached), title="A life")
    path = save_figure(figure, tmp_path / "life.png")
    assert path.stat().st_size > 5_000
    assert figure.axes[0].get_yscale() == "log"
    crosses = [line for line in figure.axes[0].lines if line.get_marker() == "x"]
    assert bool(crosses) is not reached


def test_zero_collisions_have_their_place():
    low, high = draw_life([0, 1], _agents(2)).axes[1].get_ylim()
    assert low < 0 < high


def test_steps_of_one_power_of_ten_have_several_numbers():
    steps = {"steps_to_80": np.array([200.0, 900, 8000]), "collisions": np.ones(3), "reached": np.full(3, True)}
    figure = draw_life([0, 1, 2], {"lore": steps})
    figure.canvas.draw()
    shown = {label.get_text() for label in figure.axes[0].get_yticklabels(which="both")}
    assert {"200", "500", "1,000", "2,000", "5,000"} <= shown


def test_a_measure_of_another_length_is_refused():
    with pytest.raises(InputError, match="one value a task, got 2 for 3"):
        draw_life([0, 1, 2], _agents(2))
