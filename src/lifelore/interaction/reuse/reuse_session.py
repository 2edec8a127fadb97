"""The file format of a `BayesianPolicyReuse` agent, one npz file; a restored agent continues bit for bit.

about            uint8, UTF-8 JSON: format, version, rule, dynamics, models, horizon, counters, random generator
library          uint8, the library's own file (`library_file`)
log_belief       (n_types,) float64
law              the dynamics' prior or matrix, where they have one
dynamics.*       what dynamics that learn started from, where that is an earlier task
scores           (n_policies,) float64 of the last selection, if any
task.*           what the task has shown, where models are uncertain
novelty.*        the evidence that no known type fits, where the agent computes it
log_likelihood   (n, n_types) float64 of the last signals; evidence_policy and log_evidence (n,) beside it
"""

import json
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np

from lifelore.core.atomic_write import read_file, write_file
from lifelore.core.errors import InputError
from lifelore.core.packed_arrays import Arrays, PackedFormat
from lifelore.core.protocols import SignalModel
from lifelore.interaction.beliefs.learnt_dynamics import LearntDynamics
from lifelore.interaction.beliefs.type_dynamics import TypeDynamics
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.reuse.bayesian_policy_reuse import BayesianPolicyReuse
from lifelore.interaction.reuse.explanation import Evidence
from lifelore.interaction.reuse.novelty.novelty_detector import NoveltyDetector
from lifelore.interaction.reuse.reuse_algorithm import Dynamics, named_part
from lifelore.interaction.selection import RULES, restored_rule

FORMAT = PackedFormat("lifelore policy reuse session", 4, "session", "save_session", oldest=1)
GENERATORS = ("PCG64", "PCG64DXSM", "Philox", "SFC64", "MT19937")
"""Bit generators of NumPy that a file may name."""


def save_session(agent: BayesianPolicyReuse, path: str | Path) -> None:
    """Write an agent.

    Raises
    ------
    InputError
        The rule is not one of `RULES`, or one of its settings is no plain value.
    StoreError
        The disk refuses.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> from lifelore import PolicyLibrary
    >>> agent = BayesianPolicyReuse(PolicyLibrary.from_means([[9.0, 5.0], [4.0, 8.0]], 2.0))
    >>> agent.update(0, 4.0)
    >>> with TemporaryDirectory() as folder:
    ...     save_session(agent, f"{folder}/session.npz")
    ...     np.array_equal(load_session(f"{folder}/session.npz").belief, agent.belief)
    True
    """
    write_file(path, session_bytes(agent), "the session")


def load_session(path: str | Path, signal: SignalModel | None = None) -> BayesianPolicyReuse:
    """The agent that `save_session` wrote; it selects and learns as the saved agent would have.

    Parameters
    ----------
    signal : SignalModel, optional
        Required where the library's signal model is the caller's own.

    Raises
    ------
    InputError
        The file does not exist, is of another kind, newer or damaged.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> from lifelore import PolicyLibrary
    >>> agent = BayesianPolicyReuse(PolicyLibrary.from_means([[9.0, 5.0], [4.0, 8.0]], 2.0))
    >>> with TemporaryDirectory() as folder:
    ...     save_session(agent, f"{folder}/session.npz")
    ...     load_session(f"{folder}/session.npz").select() == agent.select()
    True
    """
    return session_from_bytes(read_file(path, "the session"), str(path), signal)


def session_bytes(agent: BayesianPolicyReuse) -> bytes:
    """The agent as the bytes of an npz file; equal agents give equal bytes."""
    if RULES.get(getattr(agent.rule, "name", "")) is not type(agent.rule):
        raise InputError(f"rule must be one of {', '.join(RULES)} to be saved, got {type(agent.rule).__name__}")
    header = {
        "rule": agent.rule.name,
        "settings": asdict(agent.rule),  # pyright: ignore[reportArgumentType]
        "dynamics": agent.algorithm.dynamics.kind,
        "rate": agent.algorithm.dynamics.rate,
        "by": getattr(agent.algorithm.dynamics, "by", None),
        "models": agent.models,
        "horizon": agent.horizon,
        "episode": agent.episode,
        "surprise": agent.surprise,
        "unexplained": agent.unexplained,
        "taught": agent._taught,
        "selected": None if agent._selected is None else agent._selected[0],
        "generator": generator_state(agent.generator),
    }
    return FORMAT.pack(header, _arrays(agent))


def session_from_bytes(
    content: bytes, where: str = "the session", signal: SignalModel | None = None
) -> BayesianPolicyReuse:
    """The agent of `session_bytes`; `where` names the source in error messages."""
    header, arrays = FORMAT.unpack(content, where)
    try:
        library = PolicyLibrary.from_bytes(arrays["library"].tobytes(), f"the library in {where}", signal)
        dynamics = _dynamics(header, arrays)
        rule = restored_rule(header["rule"], header["settings"])
        generator = generator_from_state(header["generator"])
        # Files of version 1 are older than uncertain models.
        models = header.get("models", "plug-in")
        agent = BayesianPolicyReuse(library, rule, None, dynamics, header["horizon"], generator, models)
        _restore(agent, header, arrays)
    except InputError:
        raise
    except (LookupError, ValueError, TypeError, AttributeError) as error:
        raise FORMAT.damaged(where, error) from None
    return agent


def _dynamics(header: dict[str, Any], arrays: Arrays) -> Dynamics:
    if header["dynamics"] != LearntDynamics.kind:
        return TypeDynamics(header["dynamics"], header["rate"], arrays.get("law"))
    start = named_part(arrays, "dynamics.")
    categories = json.loads(start.pop("categories").tobytes()) if start else []
    return LearntDynamics(header["by"], start, categories)


def _arrays(agent: BayesianPolicyReuse) -> Arrays:
    last = list(agent._evidence)
    arrays: Arrays = {
        "library": np.frombuffer(agent.library.to_bytes(), np.uint8),
        "log_belief": agent.log_belief,
        "evidence_policy": np.array([signal.policy for signal in last], np.int64),
        "log_evidence": np.array([signal.log_evidence for signal in last], np.float64),
        "log_likelihood": np.array([signal.log_likelihood for signal in last]).reshape(-1, agent.library.n_types),
    }
    dynamics = agent.algorithm.dynamics
    if isinstance(dynamics, LearntDynamics) and dynamics.start:
        arrays |= {f"dynamics.{name}": array for name, array in dynamics.start.items()}
        arrays["dynamics.categories"] = np.frombuffer(json.dumps(dynamics.categories).encode(), np.uint8)
    elif dynamics.law is not None:
        arrays["law"] = dynamics.law
    arrays |= {f"task.{name}": array for name, array in agent.algorithm.state(0).items()}
    if agent.novelty is not None:
        arrays |= {f"novelty.{name}": array for name, array in agent.novelty.state().items()}
    if agent._selected is not None:
        arrays["scores"] = agent._selected[1]
    return arrays


def _restore(agent: BayesianPolicyReuse, header: dict[str, Any], arrays: Arrays) -> None:
    agent.algorithm.restore(0, arrays["log_belief"], named_part(arrays, "task."))
    # Files of versions 1 and 2 have none.
    if novelty := named_part(arrays, "novelty."):
        agent.novelty = NoveltyDetector.restored(novelty, agent.library, agent.algorithm.dynamics, agent.models)
    agent.episode, agent.unexplained = int(header["episode"]), int(header["unexplained"])
    agent.surprise, agent._taught = float(header["surprise"]), bool(header.get("taught", False))
    last = zip(arrays["evidence_policy"], arrays["log_likelihood"], arrays["log_evidence"], strict=True)
    agent._evidence.extend(Evidence(int(policy), row, float(evidence)) for policy, row, evidence in last)
    if header["selected"] is not None:
        # Until version 3, scores of policies that were not available were NaN.
        scores = arrays["scores"]
        agent._selected = int(header["selected"]), np.where(np.isnan(scores), -np.inf, scores)


def generator_state(generator: np.random.Generator) -> dict[str, Any]:
    """The state of a random generator as plain data: numbers, texts, lists and dictionaries."""
    return _plain(generator.bit_generator.state)


def generator_from_state(state: dict[str, Any]) -> np.random.Generator:
    """The generator of `generator_state`; ValueError where its kind is unknown."""
    if state["bit_generator"] not in GENERATORS:
        raise ValueError(f"unknown random generator {state['bit_generator']!r}")
    source = getattr(np.random, state["bit_generator"])()
    source.state = _restored(state)
    return np.random.Generator(source)


def _plain(state: Any) -> Any:
    if isinstance(state, dict):
        return {name: _plain(value) for name, value in state.items()}
    if isinstance(state, np.ndarray):
        return {"array": state.tolist(), "dtype": state.dtype.str}
    return int(state) if isinstance(state, np.integer) else state


def _restored(state: Any) -> Any:
    if not isinstance(state, dict):
        return state
    if set(state) == {"array", "dtype"}:
        return np.array(state["array"], state["dtype"])
    return {name: _restored(value) for name, value in state.items()}
