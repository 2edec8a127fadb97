"""Which agents live together."""

import pytest

from lifelore.agent.live.baselines import AGENTS, agents_for
from lifelore.core.errors import InputError, NotFoundError


def test_agents_and_their_baselines():
    assert agents_for("lore", "model") == ["lore", "scratch"]
    assert agents_for("prior", "model") == ["prior", "scratch"]
    assert agents_for("scratch", "model") == ["scratch"]
    assert agents_for("all", "model") == list(AGENTS)
    assert agents_for("all", "q") == ["lore", "scratch"]
    assert agents_for("prior", "q") == ["prior", "scratch"]
    assert agents_for("scratch", "q") == ["scratch"]


def test_refusals():
    with pytest.raises(NotFoundError, match="agent must be one of"):
        agents_for("nobody", "model")
    with pytest.raises(InputError, match="use learner 'model'"):
        agents_for("rmax", "q")


def test_the_four_are_a_factorial():
    assert {(AGENTS[n].uses_prior, AGENTS[n].remembers) for n in ("lore", "model", "prior", "scratch")} == {
        (True, True), (False, True), (True, False), (False, False),
    }  # fmt: skip
    assert len({AGENTS[n].exploration_strategy for n in ("lore", "model", "prior", "scratch")}) == 1
