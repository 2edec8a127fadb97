from copy import deepcopy

import numpy as np
import pytest

from lifelore.agent.types.novelty import AGAIN, SHARES, NoveltyAlarm, log_odds


def test_log_odds_are_the_mean_over_shares_of_each_kind():
    evidence, kinds = np.array([2.0, -0.5, -0.1, 3.0, 1.0]), np.array([0, 0, 0, 0, 1])
    apart = np.array([0.0, 0.9, 0.0, 0.0, 0.4])
    odds = 0.0
    for kind in (0, 1):
        every = []
        for share in SHARES:
            product = 1.0
            for e, own, q in zip(evidence, kinds, apart, strict=True):
                differs = share + (1 - share) * AGAIN * q
                product *= 1.0 if own != kind else (1 - differs) + differs * np.exp(e)
            every.append(product)
        odds += np.log(np.mean(every))
    assert log_odds(evidence, kinds, apart) == pytest.approx(odds)


KINDS = np.arange(50) % 2


@pytest.fixture(scope="module")
def world():
    """Two types over fifty causes of four effects, noisy, which differ in a third of the causes."""
    random = np.random.default_rng(0)
    law = random.dirichlet([0.3] * 4, 50)
    other = law.copy()
    other[:17] = random.dirichlet([0.3] * 4, 17)
    laws = np.stack([law, other])
    return laws, np.full((50, 4), 0.25), np.array([0.7, 0.3])


def alarm_of(world, horizon, random):
    known, base, prior = world
    return NoveltyAlarm(known, base, KINDS, np.zeros(50), prior, np.ones(50), horizon, 0.05, random)


def rate(world, laws, n):
    random, raised = np.random.default_rng(1), 0
    calibrated = [alarm_of(world, 40, np.random.default_rng(seed)) for seed in range(8)]
    for task in range(n):
        alarm = deepcopy(calibrated[task % 8])
        law = laws[0] if len(laws) == 1 else laws[random.choice(2, p=world[2])]
        for cause in random.permutation(50).tolist():
            alarm.observe(cause, int(random.choice(4, p=law[cause])))
        raised += alarm.alarm
    return raised / n


def test_alarms_come_as_often_as_stated_and_find_another_type(world):
    assert 0.025 <= rate(world, world[0], 400) <= 0.085  # 400 tasks: 5 % ± 2.2
    random = np.random.default_rng(2)
    new = world[0][0].copy()
    new[10:25] = random.dirichlet([0.3] * 4, 15)
    assert rate(world, new[None], 40) > 0.5


def test_repeats_and_causes_beyond_the_horizon_do_not_count(world):
    alarm = alarm_of(world, 2, np.random.default_rng(0))
    scores = []
    for cause, effect in ((3, 0), (3, 1), (3, 2), (4, 0), (5, 0)):
        alarm.observe(cause, effect)
        scores.append(alarm.score)
    assert scores[0] == scores[1] == scores[2] != scores[3] == scores[4]
