"""The printed shots by hand, and what histograms make of them."""

import numpy as np
import pytest

from lifelore.interaction.selection import Greedy, tied_shares
from reproduction.chapter4.c4_01_golf_example.run import follow_printed, readings
from reproduction.chapter4.golf.rounds import exact_library, learnt_library


def test_entropies_and_clubs_of_the_printed_shots_by_hand():
    """The 3-wood is 20 to 50 yards long with 0.0304 at 150 yards, 0.7331 at 170, 0.0009 at 220 (normal tables)."""
    entropies, iron = follow_printed(exact_library())
    belief = np.array([0.0304, 0.7331, 0.0009]) / (0.0304 + 0.7331 + 0.0009)
    assert entropies[0] == pytest.approx(np.log(4))
    assert entropies[1] == pytest.approx(0.1762, abs=5e-5)
    assert entropies[1] == pytest.approx(-(belief * np.log(belief)).sum(), abs=1e-3)
    assert entropies[2] == pytest.approx(0.0316, abs=5e-5)
    assert iron == [1.0] * 7


def test_fitted_histograms_give_the_printed_entropies():
    """Erratum: 0.2237 lies within the middle 95 % of fits to 100 shots; 0.0000 needs an empty bin at 150 yards."""
    generator = np.random.default_rng(0)
    first = [follow_printed(learnt_library(generator, 100, 0.0))[0][1] for _ in range(200)]
    low, high = np.quantile(first, [0.025, 0.975])
    assert low < 0.1762 < 0.2237 < high
    for n in (10, 100):
        libraries = [learnt_library(generator, n, 0.0) for _ in range(100)]
        zero = [follow_printed(library)[0][2] < 5e-5 for library in libraries]
        # The 3-wood 20 to 50 yards and the 3-iron 5 to 20 yards beyond the hole at 150 yards, the second hole.
        likely = [[library.signal.log_likelihood(*shot)[1] for shot in ((0, 5), (1, 4))] for library in libraries]
        empty = np.isneginf(likely).any(axis=1)
        assert 0 < empty.mean() < 1
        assert zero == empty.tolist()


def test_the_first_club_is_the_six_iron_not_the_wood():
    """Erratum: under the uniform prior the 6-iron misses by 33.7 yards on average, the wood by 55.6."""
    library = exact_library()
    assert tied_shares(Greedy().scores(library, library.prior)).tolist() == [0, 0, 1, 0]
    mean = library.performance.mean.mean(axis=0)
    assert mean[[2, 0]] == pytest.approx([-33.70, -55.65], abs=0.005)


def test_numbers_of_a_kind_of_models_by_hand():
    result = {
        "samples": 100, "pseudo_count": 0.0, "irons": [1.0, 0.5], "rounds_on_iron": [0.9, 0.7],
        "entropy": [[1.4, 0.3, 0.0], [1.4, 0.1, 0.2]],
    }  # fmt: skip
    ((cell, found),) = readings({}, [result])
    assert cell == {"models": "100 shots", "pseudo_count": 0.0}
    values = {name: one.value for name, one in found.items()}
    assert values == pytest.approx({
        "irons_after_printed": 0.75, "rounds_on_iron": 0.8, "entropy_2": 0.2,
        "rank_of_0_2237": 0.5, "entropy_3_is_0": 0.5,
    })  # fmt: skip
