"""C5.6: no verdict without a trial; with made-up trials the filed conditions decide; power by simulation."""

import csv

import numpy as np
import pytest

from lifelore.core.errors import InputError, NotFoundError
from reproduction.chapter5.c5_06_robot_hardware.measure import measure
from reproduction.chapter5.c5_06_robot_hardware.run import (
    AGENTS,
    COLUMNS,
    cells,
    power,
    read_trials,
    run_cell,
)
from reproduction.engine.registry import claim_of

CLAIM = claim_of("C5.6")
BETTER = {"full": (9.0, 1, 0), "scratch": (2.0, 0, 2), "no-perception": (5.0, 1, 1), "no-prior": (6.0, 1, 0)}


def trial(path, outcomes, tasks=30):
    """A made-up trial: each agent's points (with noise that all agents of a task share), brought, spills."""
    rng = np.random.default_rng(0)
    with path.open("w", newline="") as file:
        table = csv.writer(file)
        table.writerow(COLUMNS)
        for task in range(tasks):
            luck = rng.normal()
            for agent, (points, brought, spills) in outcomes.items():
                table.writerow([task, agent, points + luck + 0.1 * rng.normal(), brought, spills * (1 + task % 2)])
    return str(path)


def verdict(trials):
    settings = CLAIM.settings("full", {"trials": trials})
    results = [run_cell(settings, cell, 0) for cell in cells(settings)]
    measured = {name: number.to_dict() for name, number in measure(settings, results).items()}
    return CLAIM.predicate.verdict(measured)


def test_without_a_trial_it_cannot_be_tested():
    assert verdict("") == "cannot be tested"


def test_trials_decide(tmp_path):
    assert verdict(trial(tmp_path / "good.csv", BETTER)) == "holds"
    useless = {**BETTER, "no-prior": (9.0, 1, 0)}
    assert verdict(trial(tmp_path / "prior.csv", useless)) == "holds in part"
    assert verdict(trial(tmp_path / "bad.csv", dict.fromkeys(AGENTS, (2.0, 1, 0)))) == "does not hold"


def test_files_that_are_no_trial_are_refused(tmp_path):
    with pytest.raises(NotFoundError, match="not a file"):
        CLAIM.settings("full", {"trials": str(tmp_path / "none.csv")})
    path = tmp_path / "short.csv"
    path.write_text("task,agent\n1,full\n")
    with pytest.raises(InputError, match="missing points, brought, spills"):
        read_trials(str(path))
    path.write_text("task,agent,points,brought,spills\n1,full,3,1,0\n")
    with pytest.raises(InputError, match="task 1 must have each of"):
        read_trials(str(path))
    path.write_text("task,agent,points,brought,spills\n1,full,3,2,0\n")
    with pytest.raises(InputError, match="brought 0 or 1"):
        read_trials(str(path))
    path.write_text("task,agent,points,brought,spills\n1,full,much,1,0\n")
    with pytest.raises(InputError, match="line 2"):
        read_trials(str(path))


def test_power_is_that_of_simulated_trials():
    draws = np.random.default_rng(1).normal(0.5, 1.0, (4000, 30))
    low = draws.mean(axis=1) - 2.04523 * draws.std(axis=1, ddof=1) / np.sqrt(30)
    # 4000 draws of a share near 0.75: four standard errors are 0.027.
    assert power(0.5, 30) == pytest.approx((low > 0).mean(), abs=0.027)
    assert power(0.0, 30) == pytest.approx(0.025)


def test_the_page_states_the_numbers():
    numbers = {
        effect: next(n for n in CLAIM.sizes["full"]["tasks"] if power(effect, n) >= 0.9)
        for effect in (0.3, 0.5, 0.8)
    }
    assert numbers == {0.3: 120, 0.5: 60, 0.8: 20}
