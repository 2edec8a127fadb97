"""Calibration of a study's decisions: the beliefs of an agent that lives the same, and files of the report."""

import json

import numpy as np
import pytest

from lifelore.agent.personalise.decisions import choose, update
from lifelore.agent.personalise.fitting.fit import FitSettings, fit
from lifelore.agent.personalise.past import warm
from lifelore.agent.personalise.study import open_study
from lifelore.agent.personalise.study_report import report
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.reuse.bayesian_policy_reuse import BayesianPolicyReuse
from lifelore.interaction.reuse.calibration import outcome_calibration, outcome_levels, type_calibration
from lifelore.memory import open_memory

MEANS = np.array([[5.0, 0.0, 3.0], [0.0, 5.0, 3.0]])


@pytest.fixture
def memory(tmp_path):
    with open_memory(tmp_path / "m.db") as opened:
        yield opened


@pytest.fixture
def study(memory):
    random = np.random.default_rng(0)
    rows = [(user, policy) for user in range(20) for policy in range(3)]
    frame = {
        "user": [f"u{user}" for user, _ in rows], "type": [f"k{user % 2}" for user, _ in rows],
        "policy": [f"p{policy}" for _, policy in rows],
        "outcome": [random.normal(MEANS[user % 2, policy], 2) for user, policy in rows],
    }  # fmt: skip
    fit(frame, memory, FitSettings(model="gaussian", control=0.0, rule="sampling"))
    return open_study(memory)


def lived(memory, study, users=6, times=4):
    """Decisions and outcomes of new users, by user, in the order of decisions; the last outcome is not known."""
    random, said = np.random.default_rng(1), {}
    for user in range(users):
        for time in range(times):
            made = choose(memory, study, f"n{user}")
            policy = int(made["policy"][1])
            if time < times - 1:
                outcome = float(random.normal(MEANS[user % 2, policy], 2))
                update(memory, study, made["decision"], outcome)
                said.setdefault(user, []).append((policy, outcome))
    return said


def test_outcomes_are_those_of_agents_that_live_the_same(memory, study):
    said = lived(memory, study)
    beliefs, levels, groups = [], [], []
    for user, rows in said.items():
        agent = BayesianPolicyReuse(study.library)
        for policy, outcome in rows:
            beliefs.append(agent.belief)
            levels.append(outcome_levels(agent.algorithm.known(0), [agent.belief], [policy], [outcome])[0])
            groups.append(user)
            agent.update(policy, outcome)
    found = report(memory, study)["calibration"]
    assert found["types"] is None
    expected = outcome_calibration(levels, groups).to_dict()
    assert found["outcomes"]["observed"] == pytest.approx(expected["observed"])
    assert found["outcomes"]["ci95"] == [one and pytest.approx(one) for one in expected["ci95"]]
    assert (found["outcomes"]["n"][0], found["outcomes"]["groups"]) == (18, 6)


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


def test_types_are_known_from_a_log_and_the_name_is_no_evidence(memory, study):
    said = lived(memory, study)
    warm(
        {"user": [f"n{user}" for user in (0, 1, 3)], "type": ["k0", "k1", "k1"], "policy": ["p2"] * 3,
         "outcome": [3.0] * 3}, memory, study,
    )  # fmt: skip
    beliefs, types, groups = [], [], []
    for user in (0, 1, 3):
        agent = BayesianPolicyReuse(study.library)
        for policy, outcome in said[user]:
            agent.update(policy, outcome)
            beliefs.append(agent.belief)
            types.append(user % 2)
            groups.append(user)
    found = report(memory, study)["calibration"]["types"]
    expected = type_calibration(beliefs, types, groups).to_dict()
    assert found["predicted"] == pytest.approx(expected["predicted"])
    assert found["observed"] == pytest.approx(expected["observed"])
    assert found["groups"] == 3


def test_the_report_has_the_picture_where_there_is_an_outcome(memory, study, tmp_path):
    report(memory, study, out=tmp_path / "none")
    assert not (tmp_path / "none" / "calibration.png").exists()
    choose(memory, study, "ann")
    lived(memory, study, users=2)
    document = report(memory, study, out=tmp_path / "some")
    assert (tmp_path / "some" / "calibration.png").stat().st_size > 5000
    assert json.loads((tmp_path / "some" / "report.json").read_text())["calibration"] == document["calibration"]
