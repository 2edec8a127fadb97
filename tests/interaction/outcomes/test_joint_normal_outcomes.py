"""Joint-normal outcomes as a library's model: their plug-in form, parts, files and refusals."""

import numpy as np
import pytest
from scipy.stats import norm

from lifelore.core.errors import InputError
from lifelore.interaction import BayesianPolicyReuse, Greedy, JointNormalOutcomes, PolicyLibrary

MEAN = [[0.0, 1.0, 5.0], [2.0, 1.0, 3.0]]
COVARIANCE = [[4.0, 1.0, 0.0], [1.0, 1.0, 0.5], [0.0, 0.5, 2.0]]


def model() -> JointNormalOutcomes:
    return JointNormalOutcomes(MEAN, COVARIANCE, [1.0, 2.0, 0.5])


def test_plug_in_users_are_like_their_type_with_both_variances():
    deviation = np.sqrt([5.0, 5.0, 2.25])
    assert model().deviation == pytest.approx(np.broadcast_to(deviation, (2, 3)))
    assert model().log_density(2, 4.0) == pytest.approx(norm.logpdf(4.0, [5.0, 3.0], deviation[2]))
    agent = BayesianPolicyReuse(PolicyLibrary(model()), Greedy(), models="plug-in")
    agent.update(0, 9.0)
    assert agent.algorithm.known(0).performance.mean.tolist() == MEAN


def test_a_file_restores_every_bit(tmp_path, monkeypatch):
    library = PolicyLibrary(model(), prior=np.array([0.25, 0.75]))
    library.save(tmp_path / "library.npz")
    again = PolicyLibrary.load(tmp_path / "library.npz")
    assert again.to_bytes() == library.to_bytes()
    assert isinstance(again.performance, JointNormalOutcomes)
    assert again.signal.outcomes is again.performance  # pyright: ignore
    broken = {name: value for name, value in model().to_arrays().items() if name != "covariance"}
    monkeypatch.setattr(JointNormalOutcomes, "to_arrays", lambda _: broken)
    with pytest.raises(InputError, match=r"no policy library that can be read .'covariance'."):
        PolicyLibrary.from_bytes(library.to_bytes())


def test_a_type_is_added_by_its_mean_outcomes():
    more = PolicyLibrary(model()).with_type([[1.0, 3.0], [4.0, np.nan], [0.0, 2.0]]).performance
    assert more.mean[2].tolist() == [2.0, 4.0, 1.0]
    gap = PolicyLibrary(model()).with_type([[1.0], [np.nan], [0.0]], gaps=True).performance
    assert gap.mean[2].tolist() == [1.0, 1.0, 0.0]


def test_what_needs_users_side_by_side_is_refused():
    library = PolicyLibrary(model())
    with pytest.raises(InputError, match="see joint_normal_fit"):
        library.observe(0, 0, 1.0)
    with pytest.raises(InputError, match="see joint_normal_fit"):
        library.with_policy([[1.0], [2.0]])
    with pytest.raises(InputError, match="see joint_normal_fit"):
        JointNormalOutcomes.from_samples(np.zeros((2, 2, 3)))
    with pytest.raises(InputError, match="model must be one of"):
        PolicyLibrary.from_samples(np.zeros((2, 2, 3)), model="joint-normal")


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ((MEAN, np.eye(2), 1.0), r"covariance must be \(3, 3\) finite numbers"),
        ((MEAN, np.triu(np.ones((3, 3))), 1.0), "covariance must be symmetric"),
        ((MEAN, 1 - 2 * np.eye(3), 1.0), "covariance must be symmetric, without negative eigenvalues"),
        ((MEAN, np.eye(3), [1.0, 0.0, 1.0]), "deviation must be positive"),
        (([0.0, 1.0], np.eye(2), 1.0), "mean must be"),
    ],
)
def test_parameters_that_break_their_rule(arguments, said):
    with pytest.raises(InputError, match=said):
        JointNormalOutcomes(*arguments)
