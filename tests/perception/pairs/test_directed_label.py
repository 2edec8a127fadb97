"""One class of several labels: the same thing said twice is one, a contradiction is named with both its sides."""

import pytest

from lifelore.core import InputError, PairLabel
from lifelore.perception.pairs.directed_label import pair_class

NEAR, TOUCHES = PairLabel(2, 7, "on"), PairLabel(2, 7, "touches")


def test_the_class_is_that_of_the_order_asked_for():
    assert pair_class([NEAR], 2, ()) == "on"
    assert pair_class([NEAR], 7, ()) == "~on"
    assert pair_class([NEAR, NEAR], 7, ()) == "~on"
    assert pair_class([TOUCHES, PairLabel(7, 2, "touches")], 7, {"touches"}) == "touches"


def test_a_contradiction_names_the_two_that_differ():
    with pytest.raises(InputError, match=r"on\(2, 7\) and on\(7, 2\)"):
        pair_class([NEAR, NEAR, PairLabel(7, 2, "on")], 2, {"touches"})
    with pytest.raises(InputError, match=r"on\(2, 7\) and touches\(2, 7\).*multi_label"):
        pair_class([NEAR, TOUCHES], 2, {"touches"})
