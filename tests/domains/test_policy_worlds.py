"""Golf, telephone and surveillance as environments: the world's own sampling, step by step."""

import gymnasium
import numpy as np
import pytest
from gymnasium.utils import seeding

from lifelore.core.errors import InputError
from lifelore.domains.golf.golf import category_of
from lifelore.domains.telephone.telephone import OPEN, PATHS, reward


def plain(name: str, **arguments):
    return gymnasium.make(f"lifelore.domains:{name}", **arguments).unwrapped


def test_golf_equals_its_sampling():
    env, (generator, _) = plain("lifelore/Golf-v0"), seeding.np_random(7)
    observation, info = env.reset(seed=7)
    distance = env.world.draw_holes(generator, 1)[0]
    assert (observation, info) == (7, {"distance": distance})
    for club in (2, 0, 3):
        error = env.world.sample_errors(generator, distance, club)
        observation, pay, terminated, _, info = env.step(club)
        assert (observation, pay, terminated, info["error"]) == (category_of(error), -abs(error), False, error)
    assert env.reset(options={"distance": 179})[1] == {"distance": 179}
    assert plain("lifelore/Golf-v0", distance=200.0).reset()[1] == {"distance": 200}


def test_surveillance_equals_its_sampling():
    env, (generator, _) = plain("lifelore/Surveillance-v0", layout="ring"), seeding.np_random(7)
    _, info = env.reset(seed=7)
    cell = env.world.draw_cells(generator, 1)[0]
    assert info["poachers"] == tuple(cell)
    for policy in (0, 5, 67):
        pay = env.world.sample(generator, cell, policy)
        observation, reward_, terminated, *_ = env.step(policy)
        assert (observation[0], reward_, terminated) == (pay, pay, False)
    assert env.reset(options={"poachers": (1, 2)})[1]["poachers"] == (1, 2)


def test_telephone_equals_its_tables():
    env = plain("lifelore/Telephone-v0", caller=3)
    _, counts = env.reset(seed=1), dict.fromkeys(PATHS, 0)
    n = 4000
    for _ in range(n):
        state, _ = env.reset()
        path, total, done = [state], 0.0, False
        while not done:
            state, pay, done, _, info = env.step(8)
            assert pay == reward(path[-1], state)
            assert info == {"caller": 3}
            total += pay
            path.append(state)
        assert total in (3, 10)
        assert done is (state not in OPEN)
        counts[tuple(path)] += 1
    # Five standard errors of a share, at most 0.008 each.
    assert np.array(list(counts.values())) / n == pytest.approx(env.world.path_probs[3, 8], abs=0.04)
    with pytest.raises(InputError, match="reset"):
        env.step(0)
    assert env.reset(options={"caller": 5})[1] == {"caller": 5}


@pytest.mark.parametrize(
    ("name", "options", "rule"),
    [
        ("lifelore/Golf-v0", {"distance": 0}, "distance must be yards"),
        ("lifelore/Golf-v0", {"distance": "far"}, "distance must be yards"),
        ("lifelore/Surveillance-v0", {"poachers": (26, 0)}, "poachers"),
        ("lifelore/Surveillance-v0", {"poachers": (1.5, 0)}, "poachers"),
        ("lifelore/Telephone-v0", {"caller": 10}, "caller must be a whole number"),
    ],
)
def test_options_that_cannot_be(name, options, rule):
    with pytest.raises(InputError, match=rule):
        plain(name).reset(options=options)
