"""Choices that suited the users are noticed, and choices at random are not."""

import numpy as np
import pytest

from lifelore.agent.personalise.fitting.choice_bias import choice_bias
from lifelore.agent.personalise.fitting.fit import FitSettings, fit
from lifelore.agent.personalise.log.log import read_log
from lifelore.agent.personalise.log.log_format import LogFormat
from lifelore.memory import open_memory

MEANS = np.array([[7.0, 3.0, 5.0], [3.0, 7.0, 5.0]])


def simulated(seed, suits=0.0, n_users=300, *, leaves=False):
    """A log of users of two types; `suits` is the share of choices of the type's best policy."""
    random = np.random.default_rng(seed)
    log = {"user": [], "policy": [], "outcome": [], "weight": []}
    for user in range(n_users):
        kind = user % 2
        probs = np.full(3, (1 - suits) / 3)
        probs[MEANS[kind].argmax()] += suits
        for _ in range(8):
            policy = random.choice(3, p=probs)
            outcome = random.normal(MEANS[kind, policy], 2)
            line = (f"u{user}", f"p{policy}", outcome, 1 / probs[policy])
            for column, value in zip(log.values(), line, strict=True):
                column.append(value)
            if leaves and outcome < 5 and random.random() < 0.6:
                break
    return log


@pytest.mark.parametrize("leaves", [False, True])
def test_choices_at_random_are_no_bias(leaves):
    """At most one log of forty, also where users leave after bad outcomes: each has a chance of 1 in 1,000."""
    assert sum(choice_bias(read_log(simulated(seed, leaves=leaves))) is not None for seed in range(40)) <= 1


def test_a_policy_that_gets_better_and_more_frequent_is_no_bias():
    random = np.random.default_rng(0)
    lines = []
    for when in np.linspace(0, 1, 20):
        chosen = random.random(200) < 0.25 + 0.6 * when
        outcomes = random.normal(2 * when * chosen)
        lines += [(f"u{user}", "xy"[first], outcomes[user]) for user, first in enumerate(chosen.tolist())]
    user, policy, outcome = zip(*lines, strict=True)
    assert choice_bias(read_log({"user": user, "policy": policy, "outcome": outcome})) is None


def test_choices_that_suited_the_users_are_noticed():
    for seed in range(10):
        found = choice_bias(read_log(simulated(seed, 0.5)))
        assert found is not None
        assert found.share > found.others + 0.1


def test_by_hand():
    """Ann and ben like x and got it again; each of 40 others did not and got y."""
    lines = [(f"u{user}", policy, 1.0) for user in range(40) for policy in "xxxx"]
    lines += [(f"v{user}", policy, float(policy == "y")) for user in range(40) for policy in "xyyy"]
    user, policy, outcome = zip(*lines, strict=True)
    found = choice_bias(read_log({"user": user, "policy": policy, "outcome": outcome}))
    assert found is not None
    assert (found.policy, found.share, found.others) == ("x", 1.0, 0.0)


def test_weights_say_that_the_log_is_mended():
    log = read_log(simulated(0, 0.5), LogFormat({"weight": "weight"}))
    assert choice_bias(log) is None


def test_fit_says_so(tmp_path):
    with open_memory(tmp_path / "m.db") as memory:
        log = {name: values for name, values in simulated(0, 0.5).items() if name in ("user", "policy", "outcome")}
        biased = fit(log, memory, FitSettings(types=2, model="gaussian"))["notes"]
        assert sum("1 / (probability of its choice)" in note for note in biased) == 1
        n = len(log["user"])
        equal = [note for note in biased if "equal an earlier one" in note]
        assert equal == []
        stamped = log | {"time": list(range(len(log["user"])))}
        twice = fit(
            {name: values * 2 for name, values in stamped.items()}, memory, FitSettings(types=2, model="gaussian")
        )
        assert any(note.startswith(f"{n} of {2 * n} lines equal an earlier one") for note in twice["notes"])
        timed = {name: values * 2 for name, values in log.items()} | {"time": list(range(2 * len(log["user"])))}
        timed = fit(timed, memory, FitSettings(types=2, model="gaussian"))
        assert not any("equal an earlier one" in note or "cannot be read" in note for note in timed["notes"])
        days = fit(
            log | {"time": ["14.11.2023"] * len(log["user"])}, memory, FitSettings(types=2, model="gaussian")
        )
        assert sum("such as '14.11.2023'" in note for note in days["notes"]) == 1
