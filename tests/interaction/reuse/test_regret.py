"""Regret by hand (Defs 4.3.1–2)."""

import numpy as np
import pytest

from lifelore.core.errors import InputError, NotFoundError
from lifelore.interaction.reuse.regret import library_regret


def test_by_hand():
    assert library_regret([3.0, 5.0, 4.0], 0) == 2.0
    utilities = np.array([[3.0, 5.0, 4.0], [1.0, 0.0, -1.0]])
    assert library_regret(utilities, [1, 2]).tolist() == [0.0, 2.0]
    chosen = [[0, 1], [2, 0]]
    assert library_regret(utilities, chosen).tolist() == [[2.0, 0.0], [2.0, 0.0]]
    # Def. 4.3.2.
    assert library_regret(utilities, chosen).mean(axis=-1).tolist() == [1.0, 1.0]


def test_the_best_policy_is_the_librarys_best_not_the_worlds():
    assert library_regret([-7.0], 0) == 0


def test_bad_input_is_refused():
    with pytest.raises(NotFoundError, match="unknown policy"):
        library_regret([1.0, 2.0], [2])
    with pytest.raises(NotFoundError, match="unknown policy"):
        library_regret([1.0, 2.0], -1)
    with pytest.raises(InputError, match="finite"):
        library_regret([np.nan], 0)
    with pytest.raises(InputError, match="policy numbers"):
        library_regret([1.0, 2.0], 0.5)
    with pytest.raises(InputError, match="of the tasks"):
        library_regret([[1.0, 2.0]], [0, 1, 1])
    with pytest.raises(InputError, match="utilities must be"):
        library_regret(3.0, 0)
