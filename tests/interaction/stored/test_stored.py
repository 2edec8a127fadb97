"""Files of an earlier commit: libraries and sessions are read, and say what they said then."""

import json
import math
import zipfile
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from lifelore.interaction import BayesianPolicyReuse, PolicyLibrary, TypeDynamics, load_session

HERE = Path(__file__).parent
RELATIVE = 1e-12
"""Sums may be taken in another order; no number of a file may differ by more."""


def expected(folder: Path, part: str) -> dict[str, Any]:
    return json.loads((folder / part / "expected.json").read_text())


def assert_same(found: Any, told: Any, where: str, moved: tuple[str, ...] = ()) -> None:
    """Numbers agree to RELATIVE, all else exactly; what is under the keys `moved` follows other formulas now."""
    if isinstance(told, dict):
        assert set(found) == set(told), where
        for key in told:
            # Values without spread had no interval; now both of its ends are equal.
            ends = found[key] if key == "ci95" and told[key] is None else None
            if key not in moved and not (ends and ends[0] == ends[1]):
                assert_same(found[key], told[key], f"{where}: {key}", moved)
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
    # Agents of those versions had this hazard, and improvement of the pay where signals have no table.
    hazard = TypeDynamics.hazard(0.002, library.prior)
    for models in ("plug-in", "uncertain"):
        agent = BayesianPolicyReuse(library, told[models]["rule"], dynamics=hazard, models=models)
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
    # The broad type that a new signal is compared with is another one.
    assert_same(said_of(agent), {key: then[key] for key in said_of(agent)}, f"{name}, then", ("novelty",))
    assert agent.novelty is None or 0 < agent.novelty.probability < 1
    assert [agent.select() for _ in range(3)] == then["next"]
