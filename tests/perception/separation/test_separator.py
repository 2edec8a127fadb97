"""The separator beside scikit-learn's SVC (libsvm) on the same problem, and the conditions of its optimum."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.distance import cdist
from sklearn.svm import SVC

from lifelore.core.errors import InputError
from lifelore.perception.separation.separator import separate


def box(n, seed=0, size=(0.1, 0.1, 0.1), corner=(0.0, 0.0, 0.0)):
    """Points on the surface of a box, metres."""
    random = np.random.default_rng(seed)
    points = random.random((n, 3))
    axis = random.integers(0, 3, n)
    points[np.arange(n), axis] = random.integers(0, 2, n)
    return points * size + corner


def ball(n, seed=0, radius=0.05, centre=(0.0, 0.0, 0.0)):
    """Points on a sphere, metres."""
    points = np.random.default_rng(seed).normal(size=(n, 3))
    return points / np.linalg.norm(points, axis=1, keepdims=True) * radius + centre


PAIRS = {
    "touching boxes": lambda n: (box(n), box(n, 1, corner=(0.1013, 0.02, 0))),
    "ball on block": lambda n: (ball(n, centre=(0.05, 0.05, 0.1515)), box(n + 50, 1)),
    "interpenetrating": lambda n: (box(n), box(n - 30, 1, corner=(0.05, 0.05, 0.05))),
    "far apart": lambda n: (box(n), box(n, 1, corner=(0.4, 0, 0))),
    "one point": lambda n: (np.array([[0.11, 0.05, 0.05]]), box(n)),
}


def libsvm(first, second, length, cost, tolerance=1e-3):
    points = np.concatenate([first, second])
    side = np.repeat([1.0, -1.0], [len(first), len(second)])
    return SVC(C=cost, gamma=1 / (2 * length**2), tol=tolerance).fit(points, side)


def kernel_matrix(a, b, length):
    return np.exp(-cdist(a, b, "sqeuclidean") / (2 * length**2))


def signed(first, second, found):
    """β = yα of all points."""
    beta = np.zeros(len(first) + len(second))
    beta[found.support_first] = found.alpha_first
    beta[len(first) + found.support_second] = -found.alpha_second
    return beta


def objective(points, beta, length):
    return np.abs(beta).sum() - beta @ kernel_matrix(points, points, length) @ beta / 2


def violation(first, second, found, length, cost):
    """max{r : β may rise} - min{r : β may fall} by the definition."""
    points = np.concatenate([first, second])
    side = np.repeat([1.0, -1.0], [len(first), len(second)])
    beta = signed(first, second, found)
    slope = side - kernel_matrix(points, points, length) @ beta
    upper, lower = np.where(side > 0, cost, 0), np.where(side > 0, 0, -cost)
    return max(slope[beta < upper].max() - slope[beta > lower].min(), 0.0)


def check_same_support(first, second, found, twin):
    """Which points carry weight is settled but for points on the margin itself, to within the tolerance."""
    support = np.concatenate([found.support_first, found.support_second + len(first)])
    differing = np.setxor1d(support, twin.support_)
    margin = np.abs(twin.decision_function(np.concatenate([first, second])))
    assert margin[differing] == pytest.approx(np.ones(len(differing)), abs=3e-5)


@pytest.mark.parametrize("name", PAIRS)
@pytest.mark.parametrize(("n", "length", "cost"), [(60, 0.12, 1.0), (60, 0.03, 10.0), (700, 0.06, 10.0)])
def test_same_as_libsvm(name, n, length, cost):
    first, second = PAIRS[name](n)
    found = separate(first, second, length=length, cost=cost, tolerance=1e-5)
    twin = libsvm(first, second, length, cost, 1e-7)
    points = np.concatenate([first, second])
    assert found.max_violation <= 1e-5
    check_same_support(first, second, found, twin)
    assert found.decision(points) == pytest.approx(twin.decision_function(points), rel=2e-5, abs=1e-4)
    beta = np.zeros(len(points))
    beta[twin.support_] = twin.dual_coef_[0]
    best = objective(points, beta, length)
    assert objective(points, signed(first, second, found), length) == pytest.approx(best, rel=1e-6, abs=1e-6)


@pytest.mark.slow
def test_same_as_libsvm_where_working_sets_and_expansions_take_part():
    first, second = PAIRS["touching boxes"](4500)
    found = separate(first, second, length=0.06, cost=4.0, tolerance=1e-5)
    twin = libsvm(first, second, 0.06, 4.0, 1e-7)
    check_same_support(first, second, found, twin)
    some = np.concatenate([first[::9], second[::9]])
    assert found.decision(some) == pytest.approx(twin.decision_function(some), rel=2e-5, abs=1e-4)


@pytest.mark.slow
@given(
    st.integers(0, 10**6),
    st.integers(1, 400),
    st.integers(1, 400),
    st.floats(-0.1, 0.2),
    st.sampled_from([0.02, 0.06, 0.12, 1.0]),
    st.sampled_from([0.1, 1.0, 30.0]),
)
@settings(max_examples=60, deadline=None)
def test_the_optimality_conditions_hold_and_the_report_is_true(seed, n, m, gap, length, cost):
    first, second = box(n, seed), box(m, seed + 1, corner=(0.1 + gap, 0, 0))
    found = separate(first, second, length=length, cost=cost)
    assert found.max_violation <= 1e-3
    assert violation(first, second, found, length, cost) == pytest.approx(found.max_violation, abs=1e-9)
    for alpha in (found.alpha_first, found.alpha_second):
        assert (alpha > 0).all()
        assert (alpha <= cost).all()
    assert found.alpha_first.sum() == pytest.approx(found.alpha_second.sum(), rel=1e-9)


def test_report_is_true_where_the_far_field_decides():
    first, second = PAIRS["ball on block"](1500)
    found = separate(first, second, length=0.06, cost=13.0)
    assert found.max_violation <= 1e-3
    assert violation(first, second, found, 0.06, 13.0) == pytest.approx(found.max_violation, abs=1e-9)


@pytest.mark.parametrize("cost", [1.0, 1e4])
def test_identical_clouds_weigh_each_other_out(cost):
    cloud = box(1500)
    found = separate(cloud, cloud, cost=cost)
    assert found.max_violation <= 1e-3
    assert found.decision(cloud) == pytest.approx(np.zeros(1500), abs=1e-3)


@pytest.mark.parametrize("sizes", [(1, 1), (3000, 4000)])
def test_all_points_at_one_place(sizes):
    n, m = sizes
    found = separate(np.zeros((n, 3)), np.zeros((m, 3)))
    # Nothing separates them: all that can be is weighed against each other.
    assert found.max_violation == 0
    assert found.alpha_first.sum() == pytest.approx(min(sizes))


@pytest.mark.slow
def test_more_support_vectors_than_a_working_set_holds():
    random = np.random.default_rng(0)
    first, second = random.uniform(0, 0.1, (1600, 3)), random.uniform(0.1, 0.2, (1700, 3))
    found = separate(first, second, length=1e-3, cost=10.0)
    assert len(found.support_first) + len(found.support_second) > 2500
    assert found.max_violation <= 1e-3


def test_a_point_far_out_changes_nothing_elsewhere():
    first, second = PAIRS["touching boxes"](500)
    found = separate(np.vstack([first, [[1e4, 0, 0]]]), second, length=0.06, cost=10.0, tolerance=1e-5)
    twin = libsvm(np.vstack([first, [[1e4, 0, 0]]]), second, 0.06, 10.0, 1e-7)
    assert np.abs(found.decision(first) - twin.decision_function(first)).max() <= 1e-4


def test_swapped_clouds_swap_the_sign():
    first, second = PAIRS["ball on block"](500)
    one, two = separate(first, second, tolerance=1e-5), separate(second, first, tolerance=1e-5)
    assert np.array_equal(one.support_first, two.support_second)
    assert one.decision(first) == pytest.approx(-two.decision(first), abs=1e-4)


def test_gradient_is_the_slope_of_the_decision():
    first, second = PAIRS["ball on block"](300)
    found = separate(first, second)
    at, h = np.array([[0.05, 0.05, 0.1], [0.02, 0.1, 0.13]]), 1e-6
    for axis in range(3):
        step = np.eye(3)[axis] * h
        slope = (found.decision(at + step) - found.decision(at - step)) / (2 * h)
        assert found.gradient(at)[:, axis] == pytest.approx(slope, rel=1e-6, abs=1e-6)
    assert found.decision(first).mean() > 0 > found.decision(second).mean()
    assert found.decision(np.empty((0, 3))).shape == (0,)
    assert found.gradient(np.empty((0, 3))).shape == (0, 3)


GOOD = np.zeros((2, 3))


@pytest.mark.parametrize(
    ("arguments", "settings", "said"),
    [
        ((np.empty((0, 3)), GOOD), {}, "first must be a cloud"),
        ((GOOD, np.empty((0, 3))), {}, "second must be a cloud"),
        ((GOOD, np.zeros((4, 2))), {}, r"got shape \(4, 2\)"),
        ((GOOD, np.zeros(3)), {}, r"got shape \(3,\)"),
        ((GOOD, [[0, np.nan, 0]]), {}, "second must be finite"),
        (([[0, np.inf, 0]], GOOD), {}, "first must be finite"),
        ((GOOD, GOOD), {"length": 0}, "length must be positive"),
        ((GOOD, GOOD), {"length": -0.1}, "length must be positive"),
        ((GOOD, GOOD), {"length": np.nan}, "length must be positive"),
        ((GOOD, GOOD), {"cost": 0.0}, "cost must be positive"),
        ((GOOD, GOOD), {"cost": np.inf}, "cost must be positive"),
        ((GOOD, GOOD), {"tolerance": 0.0}, "tolerance must be positive"),
        ((GOOD, GOOD), {"max_work": 0.0}, "max_work must be"),
        ((GOOD, GOOD), {"max_work": np.nan}, "max_work must be"),
    ],
)
def test_bad_input(arguments, settings, said):
    with pytest.raises(InputError, match=said):
        separate(*arguments, **settings)


def mixed(n, seed=0, side=0.3):
    """Two clouds at random in one cube: no surface lies between them."""
    points = np.random.default_rng(seed).uniform(0, side, (2, n, 3))
    return points[0], points[1]


@pytest.mark.parametrize("side", [0.2, 0.05, 0.01])  # many cells of the far field, some, and one
@pytest.mark.parametrize("max_work", [1e3, 1e5, 1e6, 1e7])
def test_too_little_work_is_owned_up_to(max_work, side):
    first, second = mixed(1200, side=side)
    found = separate(first, second, length=0.06, cost=10.0, max_work=max_work)
    true = violation(first, second, found, 0.06, 10.0)
    assert found.max_violation >= true - 1e-9
    assert max_work > 1e5 or true > 1e-3
    assert found.alpha_first.sum() == pytest.approx(found.alpha_second.sum(), rel=1e-9)
    assert (np.concatenate([found.alpha_first, found.alpha_second]) <= 10.0).all()
    assert np.isfinite(found.bias)


def test_work_is_counted_and_bounded(monkeypatch):
    from lifelore.perception.separation import separator_dual

    evaluations, plain = [], separator_dual.kernel_sums

    def counted(points, sources, weights, which, sums):
        evaluations.append(len(weights) * len(which))
        plain(points, sources, weights, which, sums)

    monkeypatch.setattr(separator_dual, "kernel_sums", counted)
    first, second = mixed(1200, side=0.2)
    free = separate(first, second, length=0.06, cost=10.0, max_work=1e8)
    without = sum(evaluations)
    evaluations.clear()
    few = separate(first, second, length=0.06, cost=10.0, max_work=5e6)
    assert sum(evaluations) <= 5e6 < without
    assert free.max_violation < few.max_violation


def test_rows_of_the_kernel_that_were_forgotten_come_back_the_same(monkeypatch):
    from lifelore.perception.separation import separator_smo

    points = np.random.default_rng(0).uniform(0, 1, (3, 40))
    side = np.where(points[0] > 0.5, 1.0, -1.0)
    plain = getattr(separator_smo.ascend, "py_func", separator_smo.ascend)
    results = []
    for most in (2**26, 0):
        monkeypatch.setattr(separator_smo, "MOST_KEPT", most)
        beta, slope = np.zeros(40), side.copy()
        steps = plain(points, np.minimum(side, 0), np.maximum(side, 0), beta, slope, 1e-3, 300)
        results.append((steps, beta, slope))
    assert results[0][0] == results[1][0] > 5
    assert np.array_equal(results[0][1], results[1][1])
    assert np.array_equal(results[0][2], results[1][2])
