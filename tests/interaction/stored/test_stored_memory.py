"""The memory file of an earlier commit: studies go on as they would have."""

import shutil

import pytest

from lifelore.agent.personalise.decisions import choose, update
from lifelore.agent.personalise.study import open_study
from lifelore.agent.personalise.study_report import report
from lifelore.memory import open_memory

from .test_stored import assert_same, expected


@pytest.mark.parametrize("name", ["learnt", "sampled"])
def test_a_study_in_memory_goes_on_as_it_would_have(name, folder, tmp_path):
    told = expected(folder, "memory")[name]
    shutil.copy(folder / "memory" / "memory.db", tmp_path)
    with open_memory(tmp_path / "memory.db") as memory:
        study = open_study(memory, name)
        assert_same(list(study.library.types), told["types"], "types")
        assert_same(study.library.performance.mean.tolist(), told["mean"], "mean")
        assert_same(study.library.prior.tolist(), told["prior"], "prior")
        assert study.states == told["states"]
        # Beliefs learn outcomes when they come, and draws of a seed are others; decisions and their sums stay.
        now = report(memory, study)
        for key in ("decisions", "pending", "control_gets"):
            assert now[key] == told["report"][key]
        for key in ("personal", "control", "uplift"):
            assert_same(_numbers(now[key]), _numbers(told["report"][key]), key)
        for user, answer in told["answers"].items():
            made = choose(memory, study, user, seed=9)
            assert made["control"] == study.holds_out(user)
            assert set(made["belief"]) == set(answer["belief"])
        late = [decision for own in told["open"].values() for decision in own]
        for decision, answer in zip(late, told["late"], strict=True):
            taken = update(memory, study, decision, 6.5)
            assert (taken["user"], taken["policy"], taken["taken"]) == (answer["user"], answer["policy"], True)


def _numbers(estimate):
    return estimate and {"value": estimate["value"], "n": estimate["n"]}
