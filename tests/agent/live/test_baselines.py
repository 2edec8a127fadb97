"""Who lives beside whom."""

import pytest

from lifelore.agent.live.baselines import ROSTER, companions
from lifelore.core.errors import InputError, NotFoundError


def test_companions():
    assert companions("lore", "model") == ["lore", "scratch"]
    assert companions("prior", "model") == ["prior", "scratch"]
    assert companions("scratch", "model") == ["scratch"]
    assert companions("all", "model") == list(ROSTER)
    assert companions("all", "q") == ["lore", "scratch"]
    assert companions("prior", "q") == ["prior", "scratch"]
    assert companions("scratch", "q") == ["scratch"]


def test_refusals():
    with pytest.raises(NotFoundError, match="agent must be one of"):
        companions("nobody", "model")
    with pytest.raises(InputError, match="use learner 'model'"):
        companions("rmax", "q")


def test_the_four_are_a_factorial():
    assert {(ROSTER[n].uses_prior, ROSTER[n].remembers) for n in ("lore", "model", "prior", "scratch")} == {
        (True, True), (False, True), (True, False), (False, False),
    }  # fmt: skip
    assert len({ROSTER[n].manner for n in ("lore", "model", "prior", "scratch")}) == 1
