"""What all worlds share as Gymnasium environments: checks, and the order of calls."""

from typing import Any

import gymnasium
import numpy as np
from numpy.typing import NDArray

from lifelore.core.errors import InputError


class CheckedEnvironment(gymnasium.Env):
    """An environment with numbered actions.

    Subclasses set `action_space` and `observation_space`, and write `_begin` and `_advance`, and `_picture` where
    their `metadata` names a render mode. Randomness is `np_random`'s, drawn by the world's own sampling, so that a
    rollout equals that sampling bit for bit.
    """

    metadata = {"render_modes": []}  # noqa: RUF012

    def __init__(self, render_mode: str | None = None) -> None:
        if render_mode is not None and render_mode not in self.metadata["render_modes"]:
            known = ", ".join(self.metadata["render_modes"]) or "none"
            raise InputError(f"render_mode must be None or one of: {known}; got {render_mode!r}")
        self.render_mode = render_mode
        self._running = False

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None):
        """Start an episode; see the class for ``options``."""
        super().reset(seed=seed)
        observation, info = self._begin(options or {})
        self._running = True
        return observation, info

    def step(self, action: Any):
        """One move or choice; gymnasium's five values."""
        if not self._running:
            raise InputError("reset() must be called before step(), got no episode in progress")
        if not self.action_space.contains(action):
            n_actions = self.action_space.n  # pyright: ignore[reportAttributeAccessIssue]
            raise InputError(f"action must lie in [0, {n_actions}), got {action!r}")
        observation, reward, terminated, info = self._advance(int(action))
        return observation, float(reward), terminated, False, info

    def render(self) -> NDArray[np.uint8] | None:  # type: ignore[override]
        """The picture of the world as it is, (height, width, 3) uint8; None without a render mode."""
        return None if self.render_mode is None else self._picture()

    def _begin(self, options: dict[str, Any]) -> tuple[Any, dict[str, Any]]:
        raise NotImplementedError

    def _advance(self, action: int) -> tuple[Any, float, bool, dict[str, Any]]:
        raise NotImplementedError

    def _picture(self) -> NDArray[np.uint8]:
        raise NotImplementedError


def chosen_number(value: Any, n: int, label: str) -> int:
    """`value` if it is a whole number in [0, n), else `InputError`."""
    whole = isinstance(value, (int, np.integer)) and not isinstance(value, bool)
    if not whole or not 0 <= value < n:
        raise InputError(f"{label} must be a whole number in [0, {n}), got {value!r}")
    return int(value)
