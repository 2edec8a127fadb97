"""Regret against both bests, and savings by hand."""

import numpy as np

from reproduction.chapter4.c4_08_library_size.run import EVERY, measure, run_cell

SMALL = {"trials": 4, "episodes": [6, 2], "samples": 3, "shares": [0.1, 1.0]}


def test_the_whole_librarys_best_is_the_best_of_all():
    for share in (0.1, 1.0):
        found = run_cell(SMALL, {"models": "learnt", "rule": "EI", "share": share}, 1)
        whole, own = np.array(found["all"]), np.array(found["library"])
        assert whole.shape == (4, 2)
        assert (whole >= own).all()
        assert (whole == own).all() == (share == 1.0)


def test_a_library_of_one_policy_has_no_regret_of_its_own():
    """Erratum: by Definition 4.3.1 the smallest library would be the best."""
    found = run_cell(SMALL, {"models": "exact", "rule": "EI", "share": 0.01}, 1)
    assert found["library"] == [[0.0, 0.0]] * 4
    assert np.mean(found["all"]) > 100


def test_savings_by_hand():
    results = []
    for models, rule in EVERY:
        for share, values in ((0.1, [[8.0, 4.0], [6.0, 5.0]]), (1.0, [[6.0, 1.0], [6.0, 3.0]])):
            results.append(
                {"models": models, "rule": rule, "share": share, "all": values, "library": [[0.0, 0.0]] * 2}
            )
    values = {name: one.value for name, one in measure(SMALL, results).items()}
    assert values == {
        "saved_by_size_early": 1.0, "saved_by_size_late": 2.5, "saved_by_episodes_small": 2.5,
        "saved_by_episodes_whole": 4.0, "library_saved_by_size": 0.0, "first": 7.0, "last": 2.0,
    }  # fmt: skip
