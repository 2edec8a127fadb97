"""Figures of C3.4 to C3.6 from runs of few episodes: what is drawn is what was measured."""

import numpy as np
import pytest
from matplotlib.collections import PathCollection

from lifelore.domains.factory.layout import factory
from lifelore.figures.style import colour_of, house_style, new_figure
from reproduction.chapter3.c3_04_factory_priors.factory_floor import draw_factory_prior
from reproduction.engine.registry import claim_of
from reproduction.engine.reproduce import ClaimRun, finish

FEW = {"runs": 3, "episodes": 10, "max_steps": 150, "ties": ["uniform"], "alpha0": [0.1]}
SMALL = {
    "C3.4": {**FEW, "training_tasks": 2, "early": 3, "last": 3},
    "C3.5": {**FEW, "prior_tasks": 4},
    "C3.6": {**FEW, "prior_tasks": 4},
}


@pytest.fixture(scope="module")
def results():
    found = {}
    for claim_id, overrides in SMALL.items():
        claim = claim_of(claim_id)
        if "prior_tasks" in overrides:
            overrides = {**overrides, "grid_tasks": [1, 4]}
        settings = claim.settings("quick", overrides)
        kept = [{"result": claim.run_cell(settings, cell, 1), "seconds": 0.0} for cell in claim.cells(settings)]
        found[claim_id] = finish(ClaimRun(claim, "quick", settings, 1), kept)
    return found


@pytest.mark.parametrize("claim_id", SMALL)
def test_every_condition_asks_for_a_number_that_is_measured(results, claim_id):
    asked = {condition.measure for condition in claim_of(claim_id).predicate.conditions}
    assert asked <= set(results[claim_id]["measured"])


def test_learning_curves_of_every_make(results):
    result = results["C3.4"]
    curves = claim_of("C3.4").draw(result).axes[0]
    drawn = curves.get_lines()
    lines = {str(line.get_label()): line for line in drawn if not str(line.get_label()).startswith("_")}
    on = [row for row in result["rows"] if "learnt_on" in row]
    assert len(drawn) == len(lines) + len(on) == 8 + 4
    stored = {row["encoding"] or row["curve_of"]: row["mean"] for row in result["rows"] if "curve_of" in row}
    assert len(stored) == 7
    assert len(lines) == 8  # and the optimal one
    np.testing.assert_allclose(np.asarray(lines["expert"].get_ydata(), float), stored["expert"])
    listed = lines["learnt, stages in the list's order"]
    np.testing.assert_allclose(np.asarray(listed.get_ydata(), float), stored["listed"])
    assert listed.get_color() == colour_of("listed")


def test_table_of_losses_holds_a_line_for_every_make(results):
    grid = claim_of("C3.4").draw(results["C3.4"]).axes[-1]
    numbers = [text.get_text() for text in grid.texts]
    rows = [row for row in results["C3.4"]["rows"] if "loss_ratio" in row and row["prior"] != "uniform"]
    assert numbers == [f"{row['loss_ratio']['value']:.2f}" for row in rows]


@pytest.mark.parametrize(("claim_id", "n_panels"), [("C3.5", 1), ("C3.6", 2)])
def test_reward_against_prior_tasks(results, claim_id, n_panels):
    result = results[claim_id]
    *panels, grid = claim_of(claim_id).draw(result).axes
    assert len(panels) == n_panels
    for axes, k in zip(panels, result["settings"]["components"], strict=True):
        bands = {row["series"]: row["mean"] for row in result["rows"] if row.get("components") == k}
        drawn = {line.get_label(): np.asarray(line.get_ydata(), float) for line in axes.get_lines()}
        np.testing.assert_allclose(drawn["from scratch (Q-learning)"], bands["uniform"])
        np.testing.assert_allclose(drawn["own, stage of every component"], bands["own global"])
        np.testing.assert_allclose(drawn["optimal"], bands["optimal"])
    first = next(row for row in result["rows"] if "growth" in row)
    assert grid.texts[0].get_text() == f"{100 * first['many']['value']:.0f}".replace("-", "−")


def test_points_of_the_task_are_drawn_in_full_and_uses_as_dots():
    world = factory()
    probs = [[1.0, 0.0, 0.0, 0.0, 0.0, 0.0]] * world.n_cells
    at = int(world.procure_at[3])
    probs[at] = [0.5, 0.0, 0.0, 0.0, 0.5, 0.0]
    with house_style():
        axes = new_figure(4, 4).subplots()
        draw_factory_prior(axes, world, probs, (3,))
    n_routes = int(world.express.sum())
    alphas = [patch.get_alpha() for patch in axes.patches][n_routes:]
    assert set(alphas) == {0.22, 0.6}
    assert alphas.count(0.6) == 2  # its procurement and its assembly point
    scatters = [one for one in axes.collections if isinstance(one, PathCollection)]
    dots = {tuple(np.asarray(one.get_offsets())[0]): one.get_sizes()[0] for one in scatters}
    row, column = world.floor.cells[at]
    assert dots[column, row] == pytest.approx(13.0)
    assert sum(size > 0 for size in dots.values()) == 1
