"""A `PolicyLibrary` as one npz file: arrays and a JSON text; no pickle; equal libraries give equal bytes.

    about            uint8, UTF-8 JSON: format, version, names of types and policies, what the models are
    prior            (n_types,) float64
    performance.*    the performance model's arrays
    signal.*         the signal model's arrays; its parts under signal.0.*, signal.1.*, …

Reading gives back the same bits. A signal model that is the caller's own function cannot be written: the file
says so, and `load_library` takes the model again.
"""

from pathlib import Path
from typing import Any

from lifelore.core.atomic_write import atomic_write
from lifelore.core.errors import InputError, StoreError
from lifelore.core.packed_arrays import Arrays, PackedFormat
from lifelore.core.protocols import SignalModel
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.outcomes.outcome_kinds import KINDS as OUTCOMES
from lifelore.interaction.signals.signal_kinds import KINDS as SIGNALS

FORMAT = PackedFormat("lifelore policy library", 1, "policy library", "save")
DEEPEST = 8
"""Signals within signals that a file may hold."""


def save_library(library: PolicyLibrary, path: str | Path) -> None:
    """Write a library.

    Raises
    ------
    InputError
        The performance model is not one of this package.
    StoreError
        The disk refuses.
    """
    content = library_bytes(library)
    try:
        with atomic_write(path) as file:
            file.write(content)
    except OSError as error:
        raise StoreError(f"the library cannot be written to {path}: {error.strerror}") from None


def load_library(path: str | Path, signal: SignalModel | None = None) -> PolicyLibrary:
    """The library that `save_library` wrote, bit for bit.

    Parameters
    ----------
    signal : SignalModel, optional
        Takes the place of the file's; needed where that was the caller's own.

    Raises
    ------
    InputError
        There is no such file, or it is none of ours, newer, or damaged.
    """
    try:
        content = Path(path).read_bytes()
    except OSError as error:
        raise InputError(f"the library {path} cannot be read: {error.strerror}") from None
    return library_from_bytes(content, str(path), signal)


def library_bytes(library: PolicyLibrary) -> bytes:
    """The library as the bytes of an npz file."""
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


def library_from_bytes(
    content: bytes, where: str = "the library", signal: SignalModel | None = None
) -> PolicyLibrary:
    """The library of `library_bytes`; `where` is named when it cannot be read."""
    header, arrays = FORMAT.unpack(content, where)
    try:
        performance = OUTCOMES[header["performance"]].from_arrays(_under("performance", arrays))
        model: SignalModel = signal or _unpacked(header["signal"], "signal", performance, arrays, where)
        return PolicyLibrary(
            performance, model, tuple(header["types"]), tuple(header["policies"]), arrays["prior"]
        )
    except (KeyError, ValueError, TypeError, AttributeError, IndexError, OverflowError) as error:
        if isinstance(error, InputError) and str(error).startswith(where):
            raise
        raise FORMAT.damaged(where, error) from None


def _packed(part: Any, name: str, library: PolicyLibrary, arrays: Arrays) -> dict[str, Any]:
    """What the model is, as JSON; its arrays go into `arrays` under `name`."""
    if part is library.performance:
        return {"kind": "performance"}
    kind = getattr(part, "kind", None)
    if kind in OUTCOMES:
        arrays.update({f"{name}.{key}": value for key, value in part.to_arrays().items()})
        return {"kind": kind}
    if kind not in SIGNALS:
        return {"kind": "own", "class": type(part).__name__}
    arrays.update({f"{name}.{key}": value for key, value in part.to_arrays().items()})
    parts = [_packed(inner, f"{name}.{i}", library, arrays) for i, inner in enumerate(part.parts())]
    return {"kind": kind, "parts": parts}


def _unpacked(
    node: dict[str, Any], name: str, performance: Any, arrays: Arrays, where: str, depth: int = 0
) -> Any:
    kind = node["kind"]
    if kind == "performance":
        return performance
    if kind == "own":
        raise InputError(
            f"{where} was saved with a signal model of its owner's ({node.get('class')}); give it as signal="
        )
    if depth > DEEPEST:
        raise ValueError("signals within signals go too deep")
    if kind in OUTCOMES:
        return OUTCOMES[kind].from_arrays(_under(name, arrays))
    parts = [
        _unpacked(inner, f"{name}.{i}", performance, arrays, where, depth + 1)
        for i, inner in enumerate(node["parts"])
    ]
    return SIGNALS[kind].from_arrays(_under(name, arrays), tuple(parts))


def _under(name: str, arrays: Arrays) -> Arrays:
    start = f"{name}."
    return {key.removeprefix(start): value for key, value in arrays.items() if key.startswith(start)}
