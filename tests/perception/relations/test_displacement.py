"""The thesis's votes, counted by hand and against scikit-learn's neighbours."""

import numpy as np
import pytest
from sklearn.neighbors import KNeighborsClassifier
from sklearn.utils.estimator_checks import parametrize_with_checks

from lifelore.perception.relations.displacement import DisplacementNeighbours
from lifelore.perception.relations.displacement_relations import DisplacementRelations


@parametrize_with_checks([DisplacementNeighbours(), DisplacementNeighbours(omega=0.5, weights="distance")])
def test_the_estimator_is_scikit_learns(estimator, check):
    check(estimator)


@pytest.mark.parametrize("weights", ["uniform", "distance"])
def test_votes_are_those_of_scikit_learns_neighbours(weights):
    rng = np.random.default_rng(0)
    known, names, asked = (
        rng.normal(size=(80, 3)),
        rng.choice(["on", "adjacent", "none"], 80),
        rng.normal(size=(40, 3)),
    )
    asked[0] = known[3]
    ours = DisplacementNeighbours(4, weights=weights).fit(known, names).predict_proba(asked)
    theirs = KNeighborsClassifier(4, weights=weights).fit(known, names).predict_proba(asked)
    np.testing.assert_allclose(ours, theirs, atol=1e-12)


def test_long_displacements_are_not_learnt_from_but_no_class_is_lost():
    known = np.array([[0.01, 0, 0], [0.02, 0, 0], [0.5, 0, 0], [0.6, 0, 0]])
    fitted = DisplacementNeighbours(k=1, omega=0.1).fit(known, ["a", "a", "b", "b"])
    assert fitted.displacements_[:, 0].tolist() == [0.01, 0.02, 0.5]
    assert fitted.predict([[0.55, 0, 0]]).tolist() == ["b"]


def test_wrong_settings_are_refused():
    for wrong in (DisplacementNeighbours(k=0), DisplacementNeighbours(weights="even")):
        with pytest.raises(ValueError, match="weights"):
            wrong.fit(np.zeros((2, 3)), [0, 1])


def relations() -> DisplacementRelations:
    known = np.array([[0, 0, 0.01]] * 4 + [[0.01, 0, 0]] * 4 + [[0.3, 0.3, 0.3]])
    classes = ("adjacent", "both", "on")
    return DisplacementRelations(classes, known, np.array([2] * 4 + [0] * 4 + [1]), k=4, weights="uniform")


def test_one_displacement_on_and_one_adjacent_make_both():
    shares = relations().shares(np.array([[0, 0, 0.011], [0.011, 0, 0]]))
    assert shares == {"adjacent": 0.0, "both": 1.0, "on": 0.0}
    assert relations().shares(np.array([[0, 0, 0.011]])) == {"adjacent": 0.0, "both": 0.0, "on": 1.0}
