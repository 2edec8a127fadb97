"""Calibration of a study's decisions: the beliefs of an agent that lives the same, and files of the report."""

import json

import numpy as np
import pytest

from lifelore.agent.personalise.calibration import calibrated
from lifelore.agent.personalise.decisions import choose, update
from lifelore.agent.personalise.fitting.fit import FitSettings, fit
from lifelore.agent.personalise.study import open_study
from lifelore.agent.personalise.study_report import report
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.reuse.bayesian_policy_reuse import BayesianPolicyReuse
from lifelore.memory import open_memory

MEANS = np.array([[5.0, 0.0, 3.0], [0.0, 5.0, 3.0]])


@pytest.fixture
def memory(tmp_path):
    with open_memory(tmp_path / "m.db") as opened:
        yield opened


def outcome(random, user, policy, model):
    """A normal outcome of a user, or whether it is good."""
    value = random.normal(MEANS[user % 2, policy], 2)
    return float(value > 2) if model == "categorical" else float(value)


@pytest.fixture
def model():
    return "gaussian"


@pytest.fixture
def study(memory, model):
    random = np.random.default_rng(0)
    rows = [(user, policy) for user in range(20) for policy in range(3)]
    frame = {
        "user": [f"u{user}" for user, _ in rows], "type": [f"k{user % 2}" for user, _ in rows],
        "policy": [f"p{policy}" for _, policy in rows],
        "outcome": [outcome(random, user, policy, model) for user, policy in rows],
    }  # fmt: skip
    fit(frame, memory, FitSettings(model=model, control=0.0, rule="sampling"))
    return open_study(memory)


def lived(memory, study, users=6, times=4, model="gaussian"):
    """Decisions and outcomes of new users, by user, in the order of decisions; the last outcome is not known."""
    random, said = np.random.default_rng(1), {}
    for user in range(users):
        for time in range(times):
            made = choose(memory, study, f"n{user}")
            policy = int(made["policy"][1])
            if time < times - 1:
                said.setdefault(user, []).append((policy, outcome(random, user, policy, model)))
                update(memory, study, made["decision"], said[user][-1][1])
    return said


@pytest.mark.parametrize("model", ["gaussian", "categorical"])
def test_outcomes_are_those_of_agents_that_live_the_same(memory, study, model):
    said = lived(memory, study, model=model)
    levels, groups = [], []
    for user, rows in said.items():
        agent = BayesianPolicyReuse(study.library)
        for policy, outcome in rows:
            performance = agent.algorithm.known(0).performance
            ends = outcome - 1e-9 * (model == "categorical"), outcome
            levels.append(agent.belief @ performance.cumulative(policy, np.array(ends)))
            groups.append(user)
            agent.update(policy, outcome)
    found = report(memory, study)["calibration"]["outcomes"]
    expected = calibrated(np.array(levels), np.array(groups))
    assert found["observed"] == pytest.approx(expected["observed"])
    assert found["ci95"] == [one and pytest.approx(one) for one in expected["ci95"]]
    assert (found["n"][0], found["groups"]) == (18, 6)


def test_even_cover_of_discrete_levels_is_calibrated_exactly():
    """Outcomes in just the predicted shares lie on the line at every level."""
    levels = np.repeat([[0, 0.4], [0.4, 0.85], [0.85, 1]], [40, 45, 15], axis=0)
    found = calibrated(levels, np.arange(100))
    assert found["observed"] == pytest.approx(found["predicted"])
    assert found["error"] == pytest.approx(0, abs=1e-12)


def test_intervals_are_by_the_spread_of_users_by_hand():
    """At level 0.5 the users have 2 of 2, 1 of 1 and 0 of 1 outcomes: residuals 0.5, 0.25 and -0.75 about 0.75."""
    levels, users = np.repeat([[0.2], [0.7]], [3, 1], axis=0) * [[1, 1]], np.array([0, 0, 1, 2])
    found = calibrated(levels, users)
    half = 1.96 * ((0.5**2 + 0.25**2 + 0.75**2) * 3 / 2) ** 0.5 / 4
    assert found["observed"][4] == 0.75
    assert found["ci95"][4] == pytest.approx([0.75 - half, 1.0])
    assert calibrated(levels[:3], users[:3])["ci95"] == [None] * 9, "two users"


@pytest.mark.parametrize("model", ["gaussian", "categorical"])
def test_predicted_quantiles_are_sums_of_the_predicted_density(model):
    """P(U ≤ u) given a user's outcomes is the integral of the likelihoods by which the belief learns."""
    random = np.random.default_rng(4)
    samples = random.integers(0, 4, (3, 2, 5)).astype(float) + np.arange(3)[:, None, None]
    agent = BayesianPolicyReuse(PolicyLibrary.from_samples(samples, model=model))
    for policy, outcome in ((0, 2.0), (1, 4.0), (0, 3.0)):
        agent.update(policy, outcome)
    grid = np.linspace(-300, 300, 600_001) if model == "gaussian" else np.arange(6.0)
    model_of_user = agent.algorithm.signals
    by_spread = model_of_user.law.log_likelihoods(
        np.zeros(len(grid), np.int64),
        model_of_user.law.checked(grid),
        model_of_user.shown,
        np.zeros(len(grid), int),
    )
    density = (np.exp(by_spread) * np.exp(model_of_user.log_weights[0])[:, None]).sum(axis=1)
    step = grid[1] - grid[0]
    for value in (1.0, 3.0, 4.0):
        part = density[grid <= value + 1e-9]
        expected = part.sum(axis=0) * step - (0.5 * step * part[-1] if model == "gaussian" else 0)
        found = agent.algorithm.known(0).performance.cumulative(0, np.array([value]))[:, 0]
        assert found == pytest.approx(expected, abs=1e-4)


def test_the_report_has_the_picture_where_there_is_an_outcome(memory, study, tmp_path):
    report(memory, study, out=tmp_path / "none")
    assert not (tmp_path / "none" / "calibration.png").exists()
    choose(memory, study, "ann")
    lived(memory, study, users=2)
    document = report(memory, study, out=tmp_path / "some")
    assert (tmp_path / "some" / "calibration.png").stat().st_size > 5000
    assert json.loads((tmp_path / "some" / "report.json").read_text())["calibration"] == document["calibration"]
