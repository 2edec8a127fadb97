"""The state of a random generator as JSON values, and back to the bit."""

from typing import Any

import numpy as np

KINDS = ("PCG64", "PCG64DXSM", "Philox", "SFC64", "MT19937")


def generator_state(generator: np.random.Generator) -> dict[str, Any]:
    """Plain data: numbers, texts, lists and dictionaries."""
    return _plain(generator.bit_generator.state)


def generator_from_state(state: dict[str, Any]) -> np.random.Generator:
    """The generator of `generator_state`; ValueError where the state is none."""
    if state["bit_generator"] not in KINDS:
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
