"""Counted outcomes of one task: what is computed together, or for one outcome alone, has the same bits."""

import numpy as np
import pytest

from lifelore.interaction.outcomes.categorical_outcomes import CategoricalOutcomes
from lifelore.interaction.outcomes.dirichlet import DirichletRow, first_log_probability
from lifelore.interaction.outcomes.histogram_outcomes import HistogramOutcomes
from lifelore.interaction.outcomes.spread import Spread


def renewed_alone(task, policy):
    """Mean, deviation and variance of the mean of a policy, computed from its own row alone."""
    row, weights = task._rows[policy], np.exp(task.log_weights)
    probs = np.tensordot(weights, row.probs(), axes=1)
    counts = probs * (task.outcomes.totals[policy] + row.shown.sum())[:, None]
    alone = task.outcomes.of(task.outcomes._where(), counts[None], task.outcomes.pseudo_count)
    mean, variance = row.mean_and_variance(task.outcomes.cell_means)
    spread = weights @ variance + weights @ (mean - weights @ mean) ** 2
    return alone.mean[:, 0], alone.deviation[:, 0], spread


@pytest.mark.parametrize(("n_types", "n_policies", "n_cells"), [(2, 3, 4), (6, 5, 9), (3, 7, 40)])
def test_many_policies_are_renewed_with_the_bits_of_each_alone(n_types, n_policies, n_cells):
    generator = np.random.default_rng(n_cells)
    samples = generator.normal(size=(n_types, n_policies, 12)) + generator.normal(size=(n_types, n_policies, 1))
    task = HistogramOutcomes.from_samples(samples, np.linspace(-9, 9, n_cells + 1)).for_task()
    at_start = task.mean.copy()
    for step in range(3 * n_policies):
        policy = int(generator.integers(n_policies - 1))
        gain = generator.normal(size=len(task.log_weights))
        task.learn(policy, float(np.clip(generator.normal(), -8, 8)), task.weights_gained(gain))
        if step % 4 == 0:
            task.fade(0.75)
        if step % 2:
            continue  # several policies are stale at the next reading
        for tried in task.tried:
            mean, deviation, variance = renewed_alone(task, tried)
            assert (task.mean[:, tried] == mean).all()
            assert (task.deviation[:, tried] == deviation).all()
            assert (task.mean_variance[:, tried] == variance).all()
    assert (task.mean[:, -1] == at_start[:, -1]).all()
    assert len(task.tried) > 1


def test_a_single_outcome_has_the_cell_that_many_have():
    values = np.array([-2.0, 0.0, 1.0, 1e6])
    model = CategoricalOutcomes.from_samples(np.tile(values, (2, 1, 1)), values)
    asked = np.array(
        [-3.0, -2.0, -1.0, -1e-10, 0.0, 0.5, 1.0, 1 + 5e-10, 1 + 5e-9, 1e6, 1e6 + 1e-4, 1e6 + 1.0, 1e9]
    )
    each = [-1 if (cell := model.cell_of(value)) is None else cell for value in asked.tolist()]
    assert each == model.cells_of(asked).tolist()


def test_a_category_alone_has_the_bits_of_its_row():
    counts = np.random.default_rng(0).integers(0, 4, (5, 6)) + np.eye(5, 6)
    spread = Spread.up_to(0.8)
    for category in range(6):
        of_row = DirichletRow(counts, spread).log_probability(category)
        np.testing.assert_array_equal(first_log_probability(counts, spread, category), of_row)
