"""A task's `step` on a GPU (CUDA): many (state, action) pairs advanced in one launch.

The pure scalar ``step(params, s, a, u)`` of a `Domain`, from which the tables and the environments come, is
compiled once more, for the GPU. Results equal those of the processor as long as `step` neither adds a product (a
GPU rounds once where the processor rounds twice) nor calls a function of the mathematical library; no `step` here
does. No other module knows CUDA or needs a GPU. ``NUMBA_ENABLE_CUDASIM=1``, set before Python starts, simulates a
GPU in plain Python, slowly and without the extra ``cuda``.
"""

from collections.abc import Callable
from functools import cache
from importlib import import_module
from typing import Any, NamedTuple

import numba
import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.core.errors import InputError, MissingExtraError, NotFoundError
from lifelore.core.mdp import Step, Task

SIMULATED = bool(numba.config.ENABLE_CUDASIM)  # type: ignore[attr-defined]
if not SIMULATED:
    try:
        import numba_cuda  # noqa: F401  # pyright: ignore[reportMissingImports]
    except ImportError as error:
        raise MissingExtraError(
            f"CUDA comes with the extra cuda: pip install 'lifelore[cuda]' ({error})"
        ) from None
cuda: Any = import_module("numba.cuda")  # numba-cuda's, where that is installed

THREADS = 128
"""Threads of a block, a multiple of 32; not tuned."""
COMPUTE_CAPABILITY = (7, 5)
"""The oldest GPUs that CUDA 13 compiles for (Turing, 2018)."""


class StepResults(NamedTuple):
    """Results of `CudaTask.step_many`, one a pair.

    states : (n,) int32, the states reached
    rewards : (n,) float64
    events : (n,) uint8, bits TERMINAL | COLLISION of `core.mdp`
    """

    states: NDArray[np.int32]
    rewards: NDArray[np.float64]
    events: NDArray[np.uint8]


class CudaTask:
    """A task on the GPU: its `step` compiled, its parameters copied there once.

    Parameters
    ----------
    task : Task
        The domain's `step` is a kernel or plain Python that Numba compiles.

    Raises
    ------
    NotFoundError
        No GPU was found.
    """

    def __init__(self, task: Task) -> None:
        if not cuda.is_available():
            raise NotFoundError(
                "no GPU was found that CUDA 13 can use: install its driver (580 or newer), or set "
                "NUMBA_ENABLE_CUDASIM=1 to simulate a GPU"
            )
        self._domain = task.domain
        self._params = _on_device(task.params)
        self._advance = _advance(task.domain.step)

    def step_many(self, states: ArrayLike, actions: ArrayLike, uniforms: ArrayLike) -> StepResults:
        """The result of `step` for each (state, action, uniform), all in one launch.

        The arrays are copied to the GPU and the results back. For many steps in a row, call `device_step` in your
        own kernel, which keeps the states on the GPU.

        Parameters
        ----------
        states, actions : (n,) int
            In [0, n_states) and [0, n_actions).
        uniforms : (n,) float
            In [0, 1); a deterministic domain ignores them.

        Raises
        ------
        InputError
            The arrays differ in length, or a number is out of its range.
        """
        domain = self._domain
        sent = (
            _checked("states", states, domain.n_states, np.int32),
            _checked("actions", actions, domain.n_actions, np.int32),
            _checked("uniforms", uniforms, 1, np.float64),
        )
        n, *others = map(len, sent)
        if others != [n, n]:
            raise InputError(
                f"states, actions and uniforms must be of one length, got {n}, {others[0]}, {others[1]}"
            )
        if not n:
            return StepResults(np.empty(0, np.int32), np.empty(0), np.empty(0, np.uint8))
        found = [cuda.device_array(n, kind) for kind in (np.int32, np.float64, np.uint8)]
        self._advance[-(-n // THREADS), THREADS](self._params, *map(cuda.to_device, sent), *found)
        return StepResults(*(array.copy_to_host() for array in found))


def _checked(name: str, values: ArrayLike, end: int, kind: type) -> NDArray[Any]:
    """Values as a contiguous array of a kind; a number out of range would read foreign memory on the GPU."""
    array = np.asarray(values)
    if array.ndim != 1 or not (array.size == 0 or np.can_cast(array.dtype, kind, "same_kind")):
        raise InputError(f"{name} must be a list of {kind.__name__}, got {array.dtype} of shape {array.shape}")
    if not ((array >= 0) & (array < end)).all():
        raise InputError(f"{name} must lie in [0, {end}), got {array.min()}..{array.max()}")
    return np.ascontiguousarray(array, kind)


def _on_device(params: tuple) -> tuple:
    """Parameters of a `step` with every array, at any depth of tuples, copied to the GPU."""
    parts = [
        cuda.to_device(np.ascontiguousarray(part))
        if isinstance(part, np.ndarray)
        else _on_device(part)
        if isinstance(part, tuple)
        else part
        for part in params
    ]
    return type(params)(*parts) if hasattr(params, "_fields") else tuple(parts)


@cache
def device_step(step: Step) -> Any:
    """`step` as a CUDA device function, to be called in your own CUDA kernels."""
    return cuda.jit(device=True)(_plain(step))


def _plain(step: Step) -> Callable:
    return getattr(step, "py_func", step)


@cache
def _advance(step: Step) -> Any:
    """The CUDA kernel of `step_many`: one thread per pair."""
    own = device_step(step)

    @cuda.jit
    def advance(params, states, actions, uniforms, next_states, rewards, events):
        i = cuda.grid(1)
        if i < states.size:
            s2, reward, event = own(params, np.int64(states[i]), np.int64(actions[i]), uniforms[i])
            next_states[i] = s2
            rewards[i] = reward
            events[i] = event

    return advance


def step_ptx(task: Task, compute_capability: tuple[int, int] = COMPUTE_CAPABILITY) -> str:
    """A task's `step` as GPU assembly (PTX) text; compiling needs no GPU.

    Raises
    ------
    InputError
        A GPU is simulated, which compiles nothing.
    """
    if SIMULATED:
        raise InputError(
            "step_ptx compiles, and NUMBA_ENABLE_CUDASIM=1 interprets instead: leave the variable out"
        )
    kinds = (numba.typeof(task.params), numba.int64, numba.int64, numba.float64)
    text, _ = cuda.compile_ptx(_plain(task.domain.step), kinds, device=True, cc=compute_capability)
    return text
