"""A prior comes out of the memory of a life, with the contexts of that life."""

import numpy as np
import pytest

from lifelore.agent.external_world.context_code import context_code
from lifelore.agent.external_world.live_in import live_in
from lifelore.agent.external_world.stored_prior import BatchContexts, prior_from_memory
from lifelore.core.errors import InputError, NotFoundError

pytestmark = pytest.mark.filterwarnings("ignore:Nothing that was observed")


class Lamps:
    """One step an episode: button `lamp` pays 1; the lamp is the context."""

    name = "lamps"

    def __init__(self, n_actions=3):
        self.n_actions = n_actions

    def reset(self, task, seed):
        self.lamp = seed % 2
        return self.lamp

    def step(self, action):
        return "over", float(action == self.lamp), True, False

    def context(self, state, last_reward):
        return ("lamp", state)


@pytest.fixture
def lived(tmp_path):
    live_in(Lamps(), tasks=3, episodes=80, memory=tmp_path / "m.db", key="lamp")
    return tmp_path / "m.db"


def test_a_life_becomes_a_prior_for_batches_of_observations(lived):
    prior = prior_from_memory(lived, key="lamp", alpha0=0.5)
    contexts = BatchContexts(lambda lamp: ("lamp", int(lamp)))
    assert prior.counts(contexts(np.array([0, 1, 1]))).tolist() == [[3, 0, 0], [0, 3, 0], [0, 3, 0]]
    assert (prior.n_actions, prior.alpha0) == (3, 0.5)
    assert contexts.labels == {context_code(("lamp", lamp)): ("lamp", lamp) for lamp in (0, 1)}


def test_batches_of_dicts():
    contexts = BatchContexts(lambda seen: int(seen["lamp"]) + 10 * int(seen["room"][0]))
    codes = contexts({"lamp": np.array([1, 0]), "room": np.array([[2, 0], [3, 0]])})
    assert codes.tolist() == [context_code(21), context_code(30)]


def test_the_only_prior_needs_no_key_and_several_are_named(lived):
    assert len(prior_from_memory(lived)) == 2
    live_in(Lamps(2), tasks=2, episodes=60, memory=lived, key="lamp")
    with pytest.raises(InputError, match=r"it has 'lamp' for \d actions, 'lamp' for \d actions"):
        prior_from_memory(lived, key="lamp")
    assert prior_from_memory(lived, key="lamp", n_actions=2).n_actions == 2


def test_a_wrong_key_or_place_is_an_error_that_says_what_there_is(lived, tmp_path):
    with pytest.raises(NotFoundError, match=r"no prior of key 'lump' in .*; it has 'lamp' for 3 actions"):
        prior_from_memory(lived, key="lump")
    with pytest.raises(NotFoundError, match="no memory at"):
        prior_from_memory(tmp_path / "other.db")
    assert not (tmp_path / "other.db").exists()
