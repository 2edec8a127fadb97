"""The thesis's votes, counted by hand and against scikit-learn's neighbours."""

import numpy as np
import pytest
from sklearn.neighbors import KNeighborsClassifier

from lifelore.core.errors import InputError
from lifelore.perception.relations.displacement import short_enough, votes
from lifelore.perception.relations.displacement_relations import DisplacementRelations, NeighbourSettings


@pytest.mark.parametrize("weights", ["uniform", "distance"])
def test_votes_are_those_of_scikit_learns_neighbours(weights):
    rng = np.random.default_rng(0)
    known, names, asked = (
        rng.normal(size=(80, 3)),
        rng.choice(["on", "adjacent", "none"], 80),
        rng.normal(size=(40, 3)),
    )
    asked[0] = known[3]
    ours = votes(known, np.unique(names, return_inverse=True)[1], 3, asked, 4, weights)
    theirs = KNeighborsClassifier(4, weights=weights).fit(known, names).predict_proba(asked)
    np.testing.assert_allclose(ours, theirs, atol=1e-12)


def test_long_displacements_are_not_learnt_from_but_no_class_is_lost():
    known = np.array([[0.01, 0, 0], [0.02, 0, 0], [0.5, 0, 0], [0.6, 0, 0]])
    codes = np.array([0, 0, 1, 1])
    assert short_enough(known, codes, 0.1).tolist() == [True, True, True, False]
    assert short_enough(known, codes, None).all()
    assert short_enough(known, codes, 0.005).tolist() == [True, False, True, False]


@pytest.mark.parametrize("wrong", [{"k": 0}, {"k": 2.5}, {"omega": 0.0}, {"weights": "even"}])
def test_wrong_settings_are_refused(wrong):
    (name,) = wrong
    with pytest.raises(InputError, match=name):
        NeighbourSettings(**wrong)


def relations() -> DisplacementRelations:
    known = np.array([[0, 0, 0.01]] * 4 + [[0.01, 0, 0]] * 4 + [[0.3, 0.3, 0.3]])
    classes = ("adjacent", "both", "on")
    return DisplacementRelations(classes, known, np.array([2] * 4 + [0] * 4 + [1]), k=4, weights="uniform")


def test_one_displacement_on_and_one_adjacent_make_both():
    shares = relations().shares(np.array([[0, 0, 0.011], [0.011, 0, 0]]))
    assert shares == {"adjacent": 0.0, "both": 1.0, "on": 0.0}
    assert relations().shares(np.array([[0, 0, 0.011]])) == {"adjacent": 0.0, "both": 0.0, "on": 1.0}
