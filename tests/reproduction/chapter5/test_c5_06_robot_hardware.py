"""C5.6: power of a trial by simulation, and the numbers that the protocol states."""

import numpy as np
import pytest

from reproduction.chapter5.c5_06_robot_hardware.run import power
from reproduction.engine.registry import claim_of


def test_power_is_that_of_simulated_trials():
    draws = np.random.default_rng(1).normal(0.5, 1.0, (4000, 30))
    low = draws.mean(axis=1) - 2.04523 * draws.std(axis=1, ddof=1) / np.sqrt(30)
    # 4000 draws of a share near 0.75: four standard errors are 0.027.
    assert power(0.5, 30) == pytest.approx((low > 0).mean(), abs=0.027)
    assert power(0.0, 30) == pytest.approx(0.025)


def test_the_page_states_the_numbers():
    numbers = {
        effect: next(n for n in claim_of("C5.6").sizes["full"]["tasks"] if power(effect, n) >= 0.9)
        for effect in (0.3, 0.5, 0.8)
    }
    assert numbers == {0.3: 120, 0.5: 60, 0.8: 20}
