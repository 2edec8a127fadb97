"""The ball game's environment agrees with its step and with the players' kernel."""

import numpy as np
import pytest
from gymnasium.utils import seeding

from lifelore.core.errors import InputError
from lifelore.domains.ball_game.ball_game import HEADINGS, SPEEDS, LossScale, ball_game, step
from lifelore.domains.ball_game.environment import BallGameEnvironment
from lifelore.domains.ball_game.simulated_player import choose_heading


@pytest.mark.parametrize("blocked", ["slides", "stays"])
@pytest.mark.parametrize("size", [2, 60])
def test_environment_and_step_agree(size, blocked):
    env = BallGameEnvironment(size=size, speed=40, blocked=blocked)
    game = ball_game(blocked=blocked)
    field, kind = game.field, game.sizes.index(size)
    uniforms, _ = seeding.np_random(4)
    observation, info = env.reset(seed=4)
    sigma = uniforms.uniform(0.3, 8.0)
    assert (observation.tolist(), info["sigma"]) == ([80, 80], sigma)
    actions, place, hits = np.random.default_rng(1), (80, 80), 0
    for count in range(1, 300):
        action = int(actions.integers(4))
        *place, hit, reached = step(field, kind, *place, action, 40, sigma, *uniforms.random(3))
        observation, reward, terminated, truncated, info = env.step(action)
        hits += hit
        assert observation.tolist() == place
        assert (terminated, truncated) == (reached, False)
        assert (info["collision"], info["heading"], info["speed"]) == (hit, HEADINGS[action], 40)
        assert reward == (-(count / 400 + hits / 20) if reached else 0.0)


def test_as_interface_the_player_steers_and_speeds_are_chosen():
    env = BallGameEnvironment(size=10, role="interface", scale=LossScale(200.0, 10.0))
    assert env.action_space.n == len(SPEEDS)
    env.reset(seed=0, options={"place": (300, 90), "sigma": 1.0})
    steps = hits = 0
    terminated = False
    place = (300, 90)
    while not terminated:
        speed = steps % 5
        expected = choose_heading(env.game.field, env.kind, *place, env.game.speeds[speed])
        observation, reward, terminated, _, info = env.step(speed)
        assert info["heading"] == HEADINGS[expected]
        assert info["speed"] == SPEEDS[speed]
        place = tuple(observation.tolist())
        steps, hits = steps + 1, hits + info["collision"]
    assert reward == pytest.approx(-(steps / 200 + hits / 10))


def test_arguments_that_cannot_be():
    for arguments, rule in (
        ({"size": 3}, "size must be one of 2, 5, 10, 20, 40, 60, got 3"),
        ({"speed": 35}, "speed must be one of 30, 40, 50, 60, 70, got 35"),
        ({"role": "referee"}, "role must be one of player, interface"),
        ({"blocked": "bounces"}, "blocked must be one of slides, stays"),
    ):
        with pytest.raises(InputError, match=rule):
            BallGameEnvironment(**arguments)
    env = BallGameEnvironment()
    with pytest.raises(InputError, match="place must be free"):
        env.reset(options={"place": (5, 5)})
    with pytest.raises(InputError, match="sigma"):
        env.reset(options={"sigma": -1.0})
