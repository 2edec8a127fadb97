"""The file format of a policy library: arrays and a JSON text in one npz file; equal libraries give equal bytes.

    about            uint8, UTF-8 JSON: format, version, names of types and policies, kinds of the models
    prior            (n_types,) float64
    performance.*    the performance model's arrays
    signal.*         the signal model's arrays; its parts under signal.0.*, signal.1.*, …

Reading restores every bit. A signal model that is the caller's own class cannot be written. The file records its
name, and the reader takes the model from the caller.
"""

from collections.abc import Callable
from typing import TYPE_CHECKING, Any, TypeVar

from lifelore.core.errors import InputError
from lifelore.core.packed_arrays import Arrays, PackedFormat
from lifelore.core.protocols import SignalModel
from lifelore.interaction.outcomes.outcome_kinds import STORED as OUTCOMES
from lifelore.interaction.signals.category_signal import CategorySignal
from lifelore.interaction.signals.joint_signal import JointSignal
from lifelore.interaction.signals.return_signal import ReturnSignal
from lifelore.interaction.signals.reward_signal import RewardSignal
from lifelore.interaction.signals.step_reward_signal import StepRewardSignal
from lifelore.interaction.signals.transition_signal import TransitionSignal

if TYPE_CHECKING:
    from lifelore.interaction.library.policy_library import PolicyLibrary

FORMAT = PackedFormat("lifelore policy library", 1, "policy library", "save")
SIGNALS: dict[str, Any] = {
    kind.kind: kind
    for kind in (
        ReturnSignal,
        CategorySignal,
        RewardSignal,
        TransitionSignal,
        StepRewardSignal,
        JointSignal,
    )
}
"""The signal models that a file can hold, by name."""
EARLIER = {"ordered-normal": CategorySignal}
"""Signal models of earlier files, and the models that they have become."""
DEEPEST = 8
"""Largest depth of signals within signals in a file."""


L = TypeVar("L")


def packed_library(library: "PolicyLibrary") -> bytes:
    """The library as the bytes of an npz file; InputError where the performance model is the caller's own."""
    kind = getattr(library.performance, "kind", None)
    if kind not in OUTCOMES:
        raise InputError(f"performance must be one of {', '.join(OUTCOMES)} to be saved, got {kind!r}")
    arrays: Arrays = {"prior": library.prior}
    arrays.update({f"performance.{name}": value for name, value in library.performance.to_arrays().items()})
    header = {
        "types": library.types,
        "policies": library.policies,
        "performance": kind,
        "signal": _packed(library.signal, "signal", library, arrays),
    }
    return FORMAT.pack(header, arrays)


def unpacked_library(content: bytes, where: str, signal: SignalModel | None, make: Callable[..., L]) -> L:
    """The library that `packed_library` wrote.

    Parameters
    ----------
    content : bytes
    where : str
        Name of the source in error messages.
    signal : SignalModel, optional
        Replaces the file's signal model; required where that was the caller's own.
    make : callable
        Called as ``make(performance, signal, types, policies, prior)``.

    Raises
    ------
    InputError
        The content is of another kind, newer or damaged.
    """
    header, arrays = FORMAT.unpack(content, where)
    try:
        performance = OUTCOMES[header["performance"]].from_arrays(_under("performance", arrays))
        model: SignalModel = signal or _unpacked(header["signal"], "signal", performance, arrays, where)
        return make(performance, model, tuple(header["types"]), tuple(header["policies"]), arrays["prior"])
    except (KeyError, ValueError, TypeError, AttributeError, IndexError, OverflowError) as error:
        if isinstance(error, InputError) and str(error).startswith(where):
            raise
        raise FORMAT.damaged(where, error) from None


def _packed(part: Any, name: str, library: "PolicyLibrary", arrays: Arrays) -> dict[str, Any]:
    """The description of a model as JSON; its arrays go into `arrays` under `name`."""
    if part is library.performance:
        return {"kind": "performance"}
    kind = getattr(part, "kind", None)
    if kind not in OUTCOMES and kind not in SIGNALS:
        return {"kind": "own", "class": type(part).__name__}
    inner = getattr(part, part.inner) if hasattr(part, "inner") else ()
    inner = inner if isinstance(inner, tuple) else (inner,)
    if not inner:
        arrays.update({f"{name}.{key}": value for key, value in part.to_arrays().items()})
    parts = [_packed(model, f"{name}.{i}", library, arrays) for i, model in enumerate(inner)]
    return {"kind": kind} if kind in OUTCOMES else {"kind": kind, "parts": parts}


def _unpacked(
    node: dict[str, Any], name: str, performance: Any, arrays: Arrays, where: str, depth: int = 0
) -> Any:
    kind = node["kind"]
    if kind == "performance":
        return performance
    if kind == "own":
        raise InputError(
            f"{where} was saved with a signal model of its owner ({node.get('class')}); give the model as signal="
        )
    if depth > DEEPEST:
        raise ValueError("signals within signals go too deep")
    model = (OUTCOMES | SIGNALS | EARLIER)[kind]
    if not hasattr(model, "inner"):
        return model.from_arrays(_under(name, arrays))
    parts = [
        _unpacked(inner, f"{name}.{i}", performance, arrays, where, depth + 1)
        for i, inner in enumerate(node["parts"])
    ]
    return model(parts) if model is JointSignal else model(*parts)


def _under(name: str, arrays: Arrays) -> Arrays:
    start = f"{name}."
    return {key.removeprefix(start): value for key, value in arrays.items() if key.startswith(start)}
