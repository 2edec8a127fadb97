"""`bench evaluation`: exact truths against simulation, the contract of its answer, and its committed numbers."""

import json
from pathlib import Path

import numpy as np
import pytest

from benchmarks import bench
from benchmarks.interaction import evaluation, simulated_log
from benchmarks.interaction.simulated_log import FIRST, N_POLICIES, N_TYPES, Study

RESULT = Path(__file__).parents[2] / "results" / "bench_evaluation.json"


@pytest.fixture
def study(monkeypatch):
    monkeypatch.setattr(simulated_log, "N_USERS", 20_000)
    return Study.drawn(np.random.default_rng(3))


@pytest.mark.parametrize("explore", [0.0, 0.1, 1.0])
def test_exact_values_are_the_means_of_many_users(study, explore):
    """20,000 users: standard errors of mean outcomes are at most 0.5 / √20,000 = 0.0035; bounds are 4 of them."""
    log = study.log(np.random.default_rng(0), explore).first(FIRST)
    if explore == 0.0:
        assert log.outcomes.mean() == pytest.approx(study.value_of_rule(0.0), abs=0.0142)
    chosen = log.rule[np.arange(len(log.users)), log.policies]
    if explore > 0:
        weighted = chosen / log.probability * log.outcomes
        error = weighted.std() / 20_000**0.5
        assert weighted.mean() == pytest.approx(study.value_of_rule(explore), abs=4 * error)


def test_beliefs_are_those_of_bayes_rule(study, monkeypatch):
    monkeypatch.setattr(simulated_log, "N_USERS", 30)
    log = study.log(np.random.default_rng(1), 0.5)
    best = study.chance.argmax(axis=1)
    for user in range(30):
        belief = study.prior.copy()
        for row in np.flatnonzero(log.users == user):
            rule = np.bincount(best, belief, N_POLICIES)
            assert log.rule[row] == pytest.approx(rule)
            assert log.probability[row] == pytest.approx(0.5 * rule[log.policies[row]] + 0.5 / N_POLICIES)
            chance = study.chance[:, log.policies[row]]
            belief *= chance if log.outcomes[row] else 1 - chance
            belief /= belief.sum()
    assert len(study.prior) == N_TYPES


@pytest.mark.slow
def test_the_answer_keeps_its_contract(monkeypatch):
    monkeypatch.setattr(evaluation, "STUDIES", 8)
    result = bench("evaluation", repeats=2)
    assert json.loads(json.dumps(result, allow_nan=False)) == result
    names = [line["name"] for line in result["rows"]]
    assert len(set(names)) == len(names)
    committed = json.loads(RESULT.read_text(encoding="utf-8"))
    assert {goal["name"] for goal in result["goals"]} == {goal["name"] for goal in committed["goals"]}


def test_committed_intervals_cover_and_estimates_are_unbiased():
    """Of 1,200 studies; the three goals that are missed are named in docs/policy_reuse.md."""
    goals = json.loads(RESULT.read_text(encoding="utf-8"))["goals"]
    assert len(goals) == 60
    missed = {goal["name"] for goal in goals if not goal["met"]}
    assert missed == {
        "coverage, random log, rule, first 3 decisions, ips",
        "coverage, 3 % random, single policy, ips",
        "coverage, 3 % random, single policy, doubly-robust",
    }
    assert min(goal["measured"] for goal in goals if goal["name"].startswith("coverage")) > 0.914
    rows = json.loads(RESULT.read_text(encoding="utf-8"))["rows"]
    biases = [(line["value"], float(line["unit"][2:])) for line in rows if line["name"].startswith("bias")]
    assert len(biases) == 36
    assert all(abs(bias) < 3.3 / 1.96 * half for bias, half in biases)


def test_the_guides_table_is_that_of_the_result():
    page = (RESULT.parents[1] / "docs" / "policy_reuse.md").read_text(encoding="utf-8")
    found = json.loads(RESULT.read_text(encoding="utf-8"))
    measured = {goal["name"]: goal["measured"] for goal in found["goals"]}
    words = {
        "random log": "all choices random",
        "10 % random": "by belief, 10 % random",
        "3 % random": "by belief, 3 % random",
    }
    for log, label in words.items():
        for estimator in ("ips", "self-normalised", "doubly-robust"):
            cells = [measured[f"coverage, {log}, {target}, {estimator}"] for target in evaluation.TARGETS]
            assert f"| {label} | {estimator} | {' | '.join(f'{cell:.3f}' for cell in cells)} |\n" in page
    lowest = min(line["value"] for line in found["rows"] if "below 20" in line["name"])
    assert f"Below 20 effective users coverage fell as low as\n{lowest:.2f}." in page
