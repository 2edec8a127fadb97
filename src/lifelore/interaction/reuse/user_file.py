"""The file format of `UserBeliefs`, one npz file: beliefs, library and random generator, bit for bit.

about            uint8, UTF-8 JSON: format, version, dtype, dynamics, models, spread, unknown, random generator
library          uint8, the library's own file (`library_file`)
log_belief       (n_users, n_types) float32 or float64
log_prior        (n_types,) of the same, log belief about a new or forgotten user
law              the dynamics' prior or matrix, where they have one
names            uint8, UTF-8 JSON: the names of the users, where they have names
heads, sizes, chunks, chunk_state
                 what the users have shown, where models are uncertain; see `UserOutcomes.to_arrays`
"""

import json
from pathlib import Path

import numpy as np

from lifelore.core.atomic_write import atomic_write
from lifelore.core.errors import InputError, StoreError
from lifelore.core.packed_arrays import Arrays, PackedFormat
from lifelore.core.protocols import SignalModel
from lifelore.interaction.beliefs.type_dynamics import TypeDynamics
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.reuse.reuse_session import generator_from_state, generator_state
from lifelore.interaction.reuse.user_beliefs import UserBeliefs

FORMAT = PackedFormat("lifelore user beliefs", 2, "file of user beliefs", "save_users", 2**40, oldest=1)


def save_users(users: UserBeliefs, path: str | Path) -> None:
    """Write all beliefs, uncompressed; StoreError where the disk refuses."""
    header = {
        "dtype": users.dtype,
        "dynamics": users.dynamics.kind,
        "rate": users.dynamics.rate,
        "models": users.models,
        "spread": users.spread,
        "unknown": users.unknown,
        "generator": generator_state(users.generator),
    }
    arrays: Arrays = {
        "library": np.frombuffer(users.library.to_bytes(), np.uint8),
        "log_belief": users.log_belief,
        "log_prior": users.log_prior,
    }
    if users.dynamics.law is not None:
        arrays["law"] = users.dynamics.law
    if users.names is not None:
        arrays["names"] = np.frombuffer(json.dumps(list(users.names)).encode(), np.uint8)
    if users.outcomes is not None:
        arrays |= users.outcomes.to_arrays(users.n_users)
    try:
        with atomic_write(path) as file:
            FORMAT.write(file, header, arrays, compress=False)
    except OSError as error:
        raise StoreError(f"the users cannot be written to {path}: {error.strerror}") from None


def load_users(path: str | Path, signal: SignalModel | None = None) -> UserBeliefs:
    """The users that `save_users` wrote; `signal` is required where the signal model is the caller's own.

    Raises
    ------
    InputError
        The file does not exist, is of another kind, newer or damaged.
    """
    if not Path(path).is_file():
        raise InputError(f"the users {path} cannot be read: no such file")
    with Path(path).open("rb") as file:
        header, arrays = FORMAT.unpack(file, str(path))
    try:
        library = PolicyLibrary.from_bytes(arrays["library"].tobytes(), f"the library in {path}", signal)
        dynamics = TypeDynamics(header["dynamics"], header["rate"], arrays.get("law"))
        named = json.loads(arrays["names"].tobytes()) if "names" in arrays else None
        users = UserBeliefs(
            library,
            len(arrays["log_belief"]) if named is None else named,
            header["dtype"],
            dynamics=dynamics,
            # Files of version 1 are older than uncertain models.
            models=header.get("models", "plug-in"),
            spread=header.get("spread"),
            unknown=header.get("unknown", "error"),
            seed=generator_from_state(header["generator"]),
        )
        _restore(users, arrays)
    except InputError:
        raise
    except (LookupError, ValueError, TypeError, AttributeError) as error:
        raise FORMAT.damaged(str(path), error) from None
    return users


def _restore(users: UserBeliefs, arrays: Arrays) -> None:
    for name in ("log_belief", "log_prior"):
        value, own = arrays[name], getattr(users, name)
        if value.shape != own.shape or value.dtype != own.dtype:
            raise ValueError(f"{name} has shape {value.shape} of {value.dtype}")
        # Rows without NaN or positive numbers, each with a type that is possible.
        if not ((value <= 0).all() and (value.max(axis=-1) > -np.inf).all()):
            raise ValueError(f"{name} holds rows that are no beliefs")
    users.log_belief[:], users.log_prior = arrays["log_belief"], arrays["log_prior"]
    if users.outcomes is not None:
        users.outcomes.restore(arrays)
