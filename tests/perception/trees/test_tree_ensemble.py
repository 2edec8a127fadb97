"""Our own trees against scikit-learn's, and arrays that cannot be trees."""

import numpy as np
import pytest
from sklearn.ensemble import ExtraTreesClassifier

from lifelore.core.errors import InputError
from lifelore.perception.trees.tree_ensemble import TreeEnsemble
from lifelore.perception.trees.tree_training import TreeSettings, extra_trees


@pytest.fixture(scope="module")
def forest() -> ExtraTreesClassifier:
    rng = np.random.default_rng(0)
    rows = rng.normal(size=(300, 5))
    return ExtraTreesClassifier(20, min_samples_leaf=2, random_state=0).fit(rows, rng.integers(0, 3, 300))


def test_the_arrays_answer_as_the_forest_they_came_from(forest):
    rows = np.random.default_rng(1).normal(size=(500, 5))
    ours = TreeEnsemble.from_forest(forest)
    np.testing.assert_allclose(ours.predict_proba(rows), forest.predict_proba(rows), atol=1e-6)
    # On the thresholds themselves rounding would show.
    member = forest.estimators_[0].tree_
    edges = np.tile(rows[:1], (member.node_count, 1))
    inner = np.flatnonzero(member.feature >= 0)
    edges[inner, member.feature[inner]] = member.threshold[inner]
    np.testing.assert_allclose(ours.predict_proba(edges), forest.predict_proba(edges), atol=1e-6)
    assert ours.predict_proba(rows[:0]).shape == (0, 3)


def test_many_rows_are_judged_in_parts_alike(forest):
    ours = TreeEnsemble.from_forest(forest)
    rows = np.random.default_rng(2).normal(size=(5000, 5))
    np.testing.assert_array_equal(ours.predict_proba(rows)[4999:], ours.predict_proba(rows[4999:]))


def test_arrays_there_and_back_and_damage_is_refused(forest):
    ours = TreeEnsemble.from_forest(forest)
    arrays = ours.arrays()
    rows = np.random.default_rng(3).normal(size=(10, 5))
    np.testing.assert_array_equal(TreeEnsemble.from_arrays(arrays).predict_proba(rows), ours.predict_proba(rows))
    for name, value in {
        "left": arrays["left"] + len(arrays["left"]),
        "feature": arrays["feature"] + 5,
        "leaf": arrays["leaf"] - 1,
        "threshold": arrays["threshold"][1:],
        "roots": arrays["roots"].astype(float),
        "depth": np.asarray(-1),
    }.items():
        with pytest.raises(InputError, match="damaged"):
            TreeEnsemble.from_arrays({**arrays, name: value})
    del arrays["shares"]
    with pytest.raises(InputError, match="shares"):
        TreeEnsemble.from_arrays(arrays)


def test_settings_are_scikit_learns_and_classes_are_sorted():
    rng = np.random.default_rng(4)
    rows, names = rng.normal(size=(200, 4)), rng.choice(["on", "adjacent", "none"], 200)
    settings = TreeSettings(n_trees=7, min_leaf=3, feature_share=0.5, seed=5)
    classes, trees = extra_trees(rows, names, settings)
    twin = ExtraTreesClassifier(7, min_samples_leaf=3, max_features=0.5, random_state=5).fit(rows, names)
    assert classes == ("adjacent", "none", "on")
    np.testing.assert_allclose(trees.predict_proba(rows), twin.predict_proba(rows), atol=1e-6)


def test_one_class_is_always_that_class():
    classes, trees = extra_trees(np.zeros((4, 2)), np.array(["on"] * 4), TreeSettings(n_trees=3))
    assert (classes, trees.predict_proba(np.ones((2, 2))).tolist()) == (("on",), [[1.0], [1.0]])
