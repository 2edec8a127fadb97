"""Tasks, libraries and runs of the surveillance claims: shared noise, places, and what each method was given."""

import numpy as np
import pytest

from lifelore.domains.surveillance.surveillance import Surveillance
from lifelore.interaction.selection.information import mutual_information
from reproduction.chapter4.reuse.rules import RULES
from reproduction.chapter4.surveillance.peers import performance_kernel
from reproduction.chapter4.surveillance.runs import EXACT, LEARNT, WORLD, by_method, library_of, run_method

SETTINGS = {"tasks": 5, "episodes": 12, "samples": 4}
RESERVE = Surveillance()


@pytest.mark.parametrize("name", ["EI", "sampling", "UCB1, tuned", "GP-UCB"])
@pytest.mark.parametrize("models", [LEARNT, EXACT])
def test_a_small_run_of_a_rule_or_peer(name, models):
    cell = {"method": name, "models": models, **WORLD, "groups": 2}
    found = run_method(SETTINGS, cell, 2)
    assert len(found["sums"]) == 10
    mean = found["curves"][0]["mean"]
    assert np.mean(found["sums"]) == pytest.approx(np.sum(mean), rel=1e-3)
    # After 20 and 50 of 12 episodes is after the last.
    after = np.array(found["after"]["expected"])
    assert after[:, 2].tolist() == after[:, 3].tolist()
    assert after[:, 3].mean() == pytest.approx(mean[-1], abs=0.01)
    assert (np.abs(found["after"]["realised"]) == found["after"]["size of realised"]).all()
    assert ("entropy" in found) is (name in RULES)
    assert by_method([found], {"models": models}) == {name: found}


def test_a_hilltop_tells_the_most_and_costs_the_most():
    """Erratum: "a weak signal" says the thesis; and from far away it pays less than nothing."""
    library = library_of(RESERVE, EXACT, 0, 1, 0)
    told = mutual_information(library.prior, library.table(32))
    assert set(np.argsort(told)[-4:]) == set(np.flatnonzero(RESERVE.is_hilltop))
    cost = library.prior @ (RESERVE.mean.max(axis=1, keepdims=True) - RESERVE.mean)
    assert cost[RESERVE.is_hilltop] == pytest.approx(np.full(4, 258.0), abs=0.5)
    assert cost[~RESERVE.is_hilltop].max() < 200
    assert RESERVE.mean.min() == 200 - 30 * 15 + 10


def test_the_covariance_of_policies_by_hand():
    # Columns of 40 types drawn from a process of length 1.5 over places on a line.
    place = np.linspace(0, 10, 40)
    true = np.exp(-0.5 * ((place[:, None] - place) / 1.5) ** 2) + 1e-8 * np.eye(40)
    mean = np.random.default_rng(0).multivariate_normal(np.zeros(40), true, 40)
    kernel, columns = performance_kernel(mean), mean.T
    deviation = np.sqrt(((mean - mean.mean(axis=0)) ** 2).mean())
    assert np.diag(kernel) == pytest.approx(deviation**2)
    gaps = np.sqrt(((columns[:, None] - columns[None]) ** 2).mean(axis=2))
    lengths = gaps[0, 1:] / np.sqrt(-2 * np.log(kernel[0, 1:] / deviation**2))
    assert lengths == pytest.approx(lengths[0])
    assert np.linalg.eigvalsh(kernel)[0] > -1e-9 * deviation**2
