"""Files of an earlier commit: libraries, sessions, users and a memory are read, and say what they said then."""

import json
import math
import shutil
import zipfile
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from lifelore.agent.reuse.one_user import choose, update
from lifelore.agent.reuse.report import report
from lifelore.agent.reuse.study import open_study
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.reuse.bayesian_policy_reuse import BayesianPolicyReuse
from lifelore.interaction.reuse.reuse_session import load_session
from lifelore.interaction.reuse.user_file import load_users
from lifelore.memory import open_memory

HERE = Path(__file__).parent
RELATIVE = 1e-9
"""Sums may be taken in another order; no number of a file may differ by more."""


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """All archives, unpacked."""
    root = tmp_path_factory.mktemp("stored")
    for archive in HERE.glob("*.zip"):
        shutil.unpack_archive(archive, root / archive.stem)
    return root


def expected(folder: Path, part: str) -> dict[str, Any]:
    return json.loads((folder / part / "expected.json").read_text())


def assert_same(found: Any, told: Any, where: str) -> None:
    """Numbers agree to RELATIVE, all else exactly."""
    if isinstance(told, dict):
        assert set(found) == set(told), where
        for key in told:
            assert_same(found[key], told[key], f"{where}: {key}")
    elif isinstance(told, list):
        assert len(found) == len(told), where
        for number, (own, then) in enumerate(zip(found, told, strict=True)):
            assert_same(own, then, f"{where}[{number}]")
    elif isinstance(told, float) and isinstance(found, float | int | np.number):
        assert math.isclose(found, told, rel_tol=RELATIVE, abs_tol=1e-12), f"{where}: {found!r}, then {told!r}"
    else:
        assert found == told, where


def said_of(agent: BayesianPolicyReuse) -> dict[str, Any]:
    return {
        "belief": agent.belief.tolist(),
        "log_belief": agent.log_belief.tolist(),
        "expected_utility": agent.expected_utility().tolist(),
        "probabilities": agent.probabilities().tolist(),
        "probabilities_of_0_and_2": agent.probabilities([0, 2]).tolist(),
        "surprise": float(agent.surprise),
        "unexplained": int(agent.unexplained),
        "episode": agent.episode,
        "novelty": None if agent.novelty is None else float(agent.novelty.probability),
    }


def names_in(part: str) -> list[str]:
    """Names of the files in an archive, so that each is a test."""
    with zipfile.ZipFile(HERE / f"{part}.zip") as archive:
        return sorted(name.removesuffix(".npz") for name in archive.namelist() if name.endswith(".npz"))


@pytest.mark.parametrize("name", names_in("libraries"))
def test_a_library_gives_the_beliefs_that_it_gave(name, folder):
    told = expected(folder, "libraries")[name]
    library = PolicyLibrary.load(folder / "libraries" / f"{name}.npz")
    assert [list(library.types), list(library.policies)] == [told["types"], told["policies"]]
    assert_same(library.prior.tolist(), told["prior"], "prior")
    assert_same(np.asarray(library.performance.mean).tolist(), told["mean"], "mean")
    assert_same(np.asarray(library.performance.deviation).tolist(), told["deviation"], "deviation")
    for number, signal in enumerate(told["signals"]):
        found = library.signal.log_likelihood(number % library.n_policies, signal)
        assert_same(found.tolist(), told["log_likelihoods"][number], f"log likelihood {number}")
    for models in ("plug-in", "uncertain"):
        agent = BayesianPolicyReuse(library, models=models)
        assert agent.rule.name == told[models]["rule"]
        for number, signal in enumerate(told["signals"]):
            agent.update(number % library.n_policies, signal)
            assert_same(agent.belief.tolist(), told[models]["beliefs"][number], f"{models} {number}")
        assert_same(said_of(agent), told[models]["after"], models)


@pytest.mark.parametrize("name", names_in("sessions"))
def test_a_session_goes_on_as_it_would_have(name, folder):
    told = expected(folder, "sessions")[name]
    agent = load_session(folder / "sessions" / f"{name}.npz")
    assert [agent.rule.name, agent.models] == [told["rule"], told["models"]]
    then = told["then"]
    assert_same(said_of(agent), {key: told[key] for key in said_of(agent)}, name)
    assert [agent.select() for _ in range(3)] == told["next"]
    agent.update(*then["update"])
    assert_same(said_of(agent), {key: then[key] for key in said_of(agent)}, f"{name}, then")
    assert [agent.select() for _ in range(3)] == then["next"]


@pytest.mark.parametrize("name", names_in("users"))
def test_many_users_go_on_as_they_would_have(name, folder):
    told = expected(folder, "users")[name]
    users, own = load_users(folder / "users" / f"{name}.npz"), np.arange(5)
    single = users.dtype == "f4"
    numbers = {
        "belief": users.belief(own),
        "probabilities": users.probabilities(own),
        "probabilities_sampling": users.probabilities(own, "sampling"),
    }
    for key, found in numbers.items():
        # float32 beliefs are right to 1e-5.
        np.testing.assert_allclose(found, told[key], rtol=0, atol=1e-5 if single else 1e-11, err_msg=key)
    assert [users.select(own).tolist() for _ in range(3)] == told["next"]
    assert [users.select(own, "sampling").tolist() for _ in range(3)] == told["next_sampling"]
    evidence = users.update(*told["then"]["update"])
    np.testing.assert_allclose(evidence, told["then"]["log_evidence"], atol=1e-5 if single else 1e-9)
    np.testing.assert_allclose(users.belief(own), told["then"]["belief"], atol=1e-5 if single else 1e-11)


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
        assert_same(report(memory, study), told["report"], "report")
        for user, answer in told["answers"].items():
            assert_same(choose(memory, study, user, seed=9, novelty=True), answer, user)
        late = [decision for own in told["open"].values() for decision in own]
        for decision, answer in zip(late, told["late"], strict=True):
            assert_same(update(memory, study, decision, 6.5), answer, decision)
        for user, answer in told["after"].items():
            assert_same(choose(memory, study, user, seed=10), answer, f"{user}, after")
