"""Contexts learnt from pixels or vectors: the number of the nearest of k centres (k-means) as the feature.

An observation of many numbers (an image, joint angles) is a context of its own almost every time, so that no
count of a prior applies again. `LearntContexts` maps observations that look alike to one code.
"""

import hashlib
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.core.atomic_write import read_file, write_file
from lifelore.core.errors import InputError
from lifelore.core.packed_arrays import PackedFormat
from lifelore.core.streams import stream

FORMAT = PackedFormat("lifelore learnt contexts", 1, "learnt contexts", "LearntContexts.save")
BATCH = 1024
"""Observations of a step of mini-batch k-means; more cost time and give slightly better centres."""


@dataclass(frozen=True, eq=False)
class LearntContexts:
    """A context function for observations of many numbers: ``context=`` of `GymnasiumWorld`.

    Parameters
    ----------
    centres : (n_codes, n_numbers) float32
        In units of `scale` around `shift`.
    shift, scale : (n_numbers,) float32
        Subtracted from an observation, then divided by; `scale` is positive.

    Examples
    --------
    >>> seen = np.array([[0.0, 1.0], [0.1, 1.1], [9.0, -4.0], [9.1, -4.1]])
    >>> contexts = LearntContexts.fit(seen, n_codes=2)
    >>> contexts([0.05, 1.05]) == contexts([0.0, 0.9]) != contexts([8.0, -3.0])
    True
    """

    centres: NDArray[np.float32]
    shift: NDArray[np.float32] = field(repr=False)
    scale: NDArray[np.float32] = field(repr=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "_half_squares", 0.5 * (self.centres**2).sum(axis=1))

    @classmethod
    def fit(
        cls,
        observations: Sequence[ArrayLike] | NDArray[Any],
        n_codes: int = 32,
        *,
        standardise: bool | None = None,
        seed: int = 0,
    ) -> Self:
        """Learn the centres by mini-batch k-means; the same observations and seed give the same centres.

        Parameters
        ----------
        observations : (n, …) numbers
            Of many situations and tasks, for example of random walks; n ≥ `n_codes`.
        n_codes : int
            Number of contexts, ≥ 1. More separate more situations, and each then has fewer counts.
        standardise : bool, optional
            Divide each number by its standard deviation, for vectors whose numbers have different units. Default:
            yes, except for images (8-bit whole numbers).
        seed : int

        Raises
        ------
        InputError
            The observations differ in shape, are fewer than `n_codes`, or are not all finite.
        """
        rows, pixels = _rows(observations)
        if not 1 <= n_codes <= len(rows):
            raise InputError(f"n_codes must lie in [1, {len(rows)}], the number of observations, got {n_codes}")
        if not np.isfinite(rows).all():
            raise InputError(
                "observations must be finite, got infinite or missing numbers; drop these observations"
            )
        shift = rows.mean(axis=0)
        deviation = rows.std(axis=0)
        wanted = not pixels if standardise is None else standardise
        scale = (
            np.where(deviation > 0, deviation, 1.0) if wanted else np.full(len(shift), 255.0 if pixels else 1.0)
        )
        shift, scale = shift.astype(np.float32), scale.astype(np.float32)
        return cls(_centres((rows - shift) / scale, n_codes, seed), shift, scale)

    def __call__(self, observation: ArrayLike) -> int:
        """The code of one observation, in [0, n_codes)."""
        numbers = np.asarray(observation, np.float32).ravel()
        if numbers.shape != self.shift.shape:
            raise InputError(f"observation must have {len(self.shift)} numbers, as in fit, got {len(numbers)}")
        near = self.centres @ ((numbers - self.shift) / self.scale) - self._half_squares  # type: ignore[attr-defined]
        return int(near.argmax())

    @property
    def key(self) -> str:
        """A hash of the centres, for ``key=`` of `live_in`: codes of other centres mean something else."""
        content = b"".join(np.ascontiguousarray(part).tobytes() for part in (self.centres, self.shift, self.scale))
        return f"learnt contexts {hashlib.sha256(content).hexdigest()[:24]}"

    def save(self, path: str | Path) -> None:
        """Write the centres to an npz file; a prior in memory is of use only with the centres of its codes.

        Raises
        ------
        StoreError
            The file cannot be written.
        """
        content = FORMAT.pack({}, {"centres": self.centres, "shift": self.shift, "scale": self.scale})
        write_file(path, content, "learnt contexts")

    @classmethod
    def load(cls, path: str | Path) -> Self:
        """The contexts that `save` wrote, equal to the bit.

        Raises
        ------
        InputError
            The file is missing, damaged or of another format.
        """
        _, arrays = FORMAT.unpack(read_file(path, "learnt contexts"), str(path))
        try:
            parts = [np.asarray(arrays[name], np.float32) for name in ("centres", "shift", "scale")]
            if parts[0].ndim != 2 or parts[1].shape != parts[2].shape or parts[1].shape != parts[0].shape[1:]:
                raise ValueError(f"shapes {', '.join(str(part.shape) for part in parts)} do not fit")
        except (KeyError, ValueError) as error:
            raise FORMAT.damaged(str(path), error) from None
        return cls(*parts)


def _rows(observations: Sequence[ArrayLike] | NDArray[Any]) -> tuple[NDArray[np.float32], bool]:
    """The observations as rows of numbers, and whether they are images."""
    try:
        array = np.asarray(observations)
        pixels = array.dtype == np.uint8
        rows = array.astype(np.float32).reshape(len(array), -1)
    except (TypeError, ValueError) as error:
        raise InputError(f"observations must be numbers of one shape: {error}") from None
    return rows, pixels


def _centres(rows: NDArray[np.float32], n_codes: int, seed: int) -> NDArray[np.float32]:
    from sklearn.cluster import MiniBatchKMeans
    from threadpoolctl import threadpool_limits

    state = int(stream(seed, "learnt contexts").integers(2**31))
    # With several threads, sums are made in another order and centres differ in their last bits.
    with threadpool_limits(1):
        means = MiniBatchKMeans(n_codes, batch_size=BATCH, n_init=1, random_state=state)  # pyright: ignore[reportArgumentType]
        means.fit(rows)
    return np.asarray(means.cluster_centers_, np.float32)
