"""The memory file of an earlier commit: studies go on as they would have."""

import shutil

import pytest

from lifelore.agent.personalise.decisions import choose, update
from lifelore.agent.personalise.report import report
from lifelore.agent.personalise.study import open_study
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
        # Predicted quantiles are those of a mixture over spreads now, and a broad type is another one.
        assert_same(report(memory, study), told["report"], "report", ("calibration",))
        for user, answer in told["answers"].items():
            assert_same(choose(memory, study, user, seed=9, novelty=True), answer, user, ("novelty",))
        late = [decision for own in told["open"].values() for decision in own]
        for decision, answer in zip(late, told["late"], strict=True):
            assert_same(update(memory, study, decision, 6.5), answer, decision)
        for user, answer in told["after"].items():
            assert_same(choose(memory, study, user, seed=10), answer, f"{user}, after")
