import numpy as np
import pytest
from sklearn.gaussian_process import GaussianProcessRegressor
from sklearn.gaussian_process.kernels import RBF

from lifelore.core.errors import InputError
from lifelore.interaction.baselines import GPUCB

PLACES = np.random.default_rng(0).random((12, 2))
GAPS = np.linalg.norm(PLACES[:, None] - PLACES[None], axis=2)


def process(**settings):
    return GPUCB(12, kernel=np.exp(-0.5 * (GAPS / 0.4) ** 2), **({"noise": 0.3} | settings))


@pytest.mark.parametrize("episodes", [1, 5, 30, 200])
def test_the_posterior_is_that_of_scikit_learn(episodes):
    """200 episodes are more than the 48 after which the posterior becomes the prior."""
    generator = np.random.default_rng(episodes)
    policies, paid = generator.integers(12, size=episodes), generator.normal(size=episodes)
    player = process()
    for policy, reward in zip(policies, paid, strict=True):
        player.update(int(policy), reward)
    peer = GaussianProcessRegressor(RBF(0.4, "fixed"), alpha=0.09, optimizer=None).fit(PLACES[policies], paid)
    mean, deviation = peer.predict(PLACES, return_std=True)
    ours = player.posterior()
    assert ours[0][0] == pytest.approx(mean, abs=1e-9)
    assert ours[1][0] == pytest.approx(deviation, abs=1e-9)


def test_tasks_side_by_side_are_tasks_one_by_one():
    generator = np.random.default_rng(4)
    policies, paid = generator.integers(12, size=(90, 3)), generator.normal(size=(90, 3))
    together, apart = process(n_tasks=3), [process() for _ in range(3)]
    for policy, reward in zip(policies, paid, strict=True):
        together.update(policy, reward)
        for row, player in enumerate(apart):
            player.update(int(policy[row]), reward[row])
    for row, player in enumerate(apart):
        for ours, theirs in zip(together.posterior(), player.posterior(), strict=True):
            assert ours[row] == pytest.approx(theirs[0], abs=1e-12)


def test_beta_of_srinivas_by_hand():
    player = process(delta=0.1)
    # 2 ln(12 · 1 · π² / 0.6) = 10.57; and at t = 2 it grows by 2 ln 4.
    assert player._beta() == pytest.approx(10.5703, abs=1e-3)
    player.update(0, 0.0)
    assert player._beta() == pytest.approx(10.5703 + 2 * np.log(4), abs=1e-3)


def test_from_library(library):
    player = GPUCB.from_library(library, beta=0)
    assert player._scores()[0] == pytest.approx([0.75, 0.35, 0.45, 0.025])
    assert player.noise == pytest.approx(0.1)
    types = np.random.default_rng(1).choice(2, 200_000, p=library.prior)
    drawn = np.cov(library.performance.mean[types].T)
    # The deviation of a covariance of 200,000 draws of values in [0, 1] is below 0.0006.
    assert player.kernel == pytest.approx(drawn, abs=0.003)
    assert GPUCB.from_library(library, kernel=np.eye(4)).kernel.tolist() == np.eye(4).tolist()
    with pytest.raises(InputError, match="kernel must be 4 × 4 and finite, got 'performance'"):
        GPUCB.from_library(library, kernel="performance")
