"""Pictures of policy reuse's problems: what is drawn is what was given."""

import numpy as np
import pytest

from docs.pictures.figure_category_bars import draw_category_bars
from docs.pictures.figure_performance_curves import draw_performance_curves
from docs.pictures.figure_reserve_map import draw_reserve_maps
from lifelore.domains.golf.golf import CLUBS, EDGES, HOLES, Golf
from lifelore.domains.surveillance.surveillance import BASE, SIDE, Surveillance
from lifelore.domains.telephone.telephone import ANGRY, HUNG_UP, OPEN, STATES, SUCCESS, reward
from lifelore.figures.style import new_figure
from reproduction.chapter4.c4_03_telephone_signals.call_graph import EDGES as CALL_EDGES
from reproduction.chapter4.c4_03_telephone_signals.call_graph import PLACES, draw_call_graph


def test_category_bars_show_the_tables():
    golf = Golf()
    figure = draw_category_bars(golf.category_probs, EDGES, CLUBS, HOLES)
    assert len(figure.axes) == 16
    for k, axes in enumerate(figure.axes):
        assert [bar.get_height() for bar in axes.patches] == pytest.approx(golf.category_probs[k // 4, k % 4])
        # As wide as the category: 15 yards from 5 to 20.
        assert axes.patches[4].get_width() == 15


def test_call_graph_is_the_worlds():
    assert set(PLACES) == set(STATES)
    for (before, after), (_, paid) in CALL_EDGES.items():
        assert paid == reward(STATES.index(before), STATES.index(after))
    there = {(STATES[s], STATES[s2]) for s in OPEN for s2 in (s + 1, SUCCESS, HUNG_UP)}
    assert set(CALL_EDGES) == there
    axes = new_figure(7, 4).subplots()
    draw_call_graph(axes)
    written = [text.get_text() for text in axes.texts]
    assert STATES[ANGRY] in written
    for part in ("[10]", "[3]", "(1−η)ρ"):
        assert any(part in text for text in written)


def test_reserve_map_shows_targets_hilltops_and_base():
    world = Surveillance("ring")
    figure = draw_reserve_maps({"ring": (world.targets, world.is_hilltop)}, BASE, SIDE)
    assert len(figure.axes[0].patches) == 64 + 4 + 1


def test_performance_curves_mark_what_is_known_and_what_is_asked():
    tasks = np.linspace(0, 10, 50)
    figure = draw_performance_curves(
        tasks, {"$\\pi_1$": tasks, "$\\pi_2$": 10 - tasks}, {"$\\tau_1$": 2.0, "$\\tau_2$": 8.0}, 5.0,
        shown=("$\\tau_1$", "$\\pi_2$"), deviation=0.5, epsilon=2.0,
    )  # fmt: skip
    points = [line for line in figure.axes[0].lines if line.get_marker() == "o"]
    known = [line.get_ydata() for line in points if len(line.get_xdata()) == 2]
    assert np.concatenate(known).tolist() == pytest.approx([2, 8, 8, 2])
    asked = [float(line.get_ydata()[0]) for line in points if len(line.get_xdata()) == 1]
    assert asked == pytest.approx([5, 5])
