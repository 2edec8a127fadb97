"""The factories as environments: what they tell, and that an exact plan earns in them what it promises."""

import gymnasium
import numpy as np
import pytest

from lifelore.core.errors import InputError
from lifelore.domains.factory.contexts import FEATURE_NAMES
from lifelore.domains.factory.environment import AnyFactoryEnvironment
from lifelore.domains.factory.layout import factory

NAMES = ("lifelore/Factory-v0", "lifelore/ModifiedFactory-v0")


def plain(name, **arguments):
    return gymnasium.make(f"lifelore.domains:{name}", **arguments).unwrapped


@pytest.mark.slow
@pytest.mark.parametrize("name", NAMES)
def test_an_exact_plan_earns_what_it_promises(name):
    env = plain(name, components=3, seed=2)
    q = env.factory_task.optimal_q()
    state, info = env.reset(seed=0)
    promised, earned, reach, done, steps = q[state].max(), 0.0, 1.0, False, 0
    assert info["to_procure"] == info["to_assemble"] == env.factory_task.components
    while not done:
        state, reward, done, _, info = env.step(int(q[state].argmax()))
        earned, reach, steps = earned + reach * reward, reach * 0.99, steps + 1
        assert set(info["to_procure"]) <= set(info["to_assemble"])
        assert len(info["features"]) == len(FEATURE_NAMES)
        assert not info["collision"]
    assert earned == pytest.approx(promised, rel=1e-12)
    assert info["to_assemble"] == ()
    assert steps < 200


def test_components_by_number_or_drawn():
    assert plain(NAMES[0], components=[3, 1]).factory_task.components == (1, 3)
    drawn = {plain(NAMES[0], seed=seed).factory_task.components for seed in range(8)}
    assert {len(components) for components in drawn} == {4}
    assert len(drawn) > 1
    with pytest.raises(InputError, match=r"k must lie in \[1, 9\], got 10"):
        plain(NAMES[0], components=10)


def test_a_factory_of_ones_own():
    world = factory("#######\n#S1.a.#\n#######")
    env = AnyFactoryEnvironment(world, [0])
    env.reset(seed=0)
    total = sum(env.step(action)[1] for action in (2, 4, 2, 2, 5))
    assert total == -2 + 10 - 2 - 2 + 110
    assert np.array_equal(env.task.starts, [0])
