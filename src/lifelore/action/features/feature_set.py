"""`FeatureSet`: packs the features of a context, whole numbers, into one int64 code by mixed radix.

    φ = (f_1, …, f_k),   f_i in [0, K_i),   K_φ = Π K_i

The last feature changes the code by 1. Thesis: §3.3.2.
"""

import hashlib
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.core.errors import InputError, NotFoundError

MOST_CODES = 2**47
"""Maximum number of configurations; with up to 65,535 actions a slot of a memory record then fits 64 bits."""

Columns = NDArray[np.int64]
"""(n, n_features), a row of feature values for each context."""


@dataclass(frozen=True)
class FeatureSet:
    """Names of features and the number of values of each.

    Parameters
    ----------
    names : sequence of str
        Distinct, not empty.
    sizes : sequence of int
        K of each feature, at least 1; their product at most `MOST_CODES`.

    Examples
    --------
    >>> features = FeatureSet(("north", "items"), (4, 3))
    >>> features.codes([[2, 1], [3, 2]]).tolist()
    [7, 11]
    >>> features.columns([7, 11]).tolist()
    [[2, 1], [3, 2]]
    """

    names: tuple[str, ...]
    sizes: tuple[int, ...]

    def __post_init__(self) -> None:
        object.__setattr__(self, "names", tuple(map(str, self.names)))
        object.__setattr__(self, "sizes", tuple(map(int, self.sizes)))
        if len(self.names) != len(self.sizes):
            raise InputError(f"each feature needs a size, got {len(self.names)} names and {len(self.sizes)} sizes")
        if "" in self.names or len(set(self.names)) != len(self.names):
            raise InputError(f"names of features must be distinct and not empty, got {', '.join(self.names)}")
        if any(size < 1 for size in self.sizes):
            raise InputError(f"sizes of features must be at least 1, got {list(self.sizes)}")
        if self.n_codes > MOST_CODES:
            raise InputError(
                f"features must have at most 2**47 configurations, got {self.n_codes}; drop or coarsen one"
            )

    def __len__(self) -> int:
        return len(self.names)

    @property
    def n_codes(self) -> int:
        """K_φ, the number of configurations: the product of the sizes."""
        product = 1
        for size in self.sizes:
            product *= size
        return product

    @property
    def places(self) -> tuple[int, ...]:
        """Increase of the code when each feature increases by 1."""
        places, place = [], 1
        for size in reversed(self.sizes):
            places.append(place)
            place *= size
        return tuple(reversed(places))

    def key(self, actions: Sequence[str]) -> str:
        """Key of a prior over these features and actions; equal only if names and order are equal."""
        text = repr((self.names, self.sizes, tuple(map(str, actions))))
        return hashlib.sha256(text.encode()).hexdigest()[:32]

    def codes(self, columns: ArrayLike) -> NDArray[np.int64]:
        """Codes in [0, `n_codes`) of rows of feature values, (n,) int64 from (n, n_features)."""
        columns = self._checked(columns)
        total = np.zeros(len(columns), np.int64)
        for column, place in zip(columns.T, self.places, strict=True):
            total += column * place
        return total

    def columns(self, codes: ArrayLike) -> Columns:
        """Feature values of codes, (n, n_features) int64."""
        codes = np.asarray(codes, np.int64).ravel()
        if codes.size and not (codes.min() >= 0 and codes.max() < self.n_codes):
            raise InputError(f"codes must lie in [0, {self.n_codes}), got {codes.min()}..{codes.max()}")
        result = np.empty((len(codes), len(self)), np.int64)
        for i, (size, place) in enumerate(zip(self.sizes, self.places, strict=True)):
            result[:, i] = codes // place % size
        return result

    def subset(self, names: Sequence[str]) -> "FeatureSet":
        """The features of these names, in this set's order."""
        unknown = [name for name in names if name not in self.names]
        if unknown:
            raise NotFoundError(f"features must be among {', '.join(self.names)}, got '{unknown[0]}'")
        chosen = [i for i, name in enumerate(self.names) if name in names]
        return FeatureSet(tuple(self.names[i] for i in chosen), tuple(self.sizes[i] for i in chosen))

    def coarser(self, codes: ArrayLike, names: Sequence[str]) -> NDArray[np.int64]:
        """Codes of `subset(names)` that contain codes of this set, as `ActionPrior.marginalise` takes them."""
        codes, part = np.asarray(codes, np.int64).ravel(), self.subset(names)
        if codes.size and not (codes.min() >= 0 and codes.max() < self.n_codes):
            raise InputError(f"codes must lie in [0, {self.n_codes}), got {codes.min()}..{codes.max()}")
        place_of = dict(zip(self.names, self.places, strict=True))
        total = np.zeros(len(codes), np.int64)
        for name, size, place in zip(part.names, part.sizes, part.places, strict=True):
            total += codes // place_of[name] % size * place
        return total

    def _checked(self, columns: ArrayLike) -> Columns:
        columns = np.asarray(columns)
        if columns.ndim != 2 or columns.shape[1] != len(self):
            raise InputError(f"columns must have shape (n, {len(self)}), got {columns.shape}")
        if columns.size and columns.dtype.kind not in "iub":
            raise InputError(f"feature values must be whole numbers, got {columns.dtype}")
        columns = columns.astype(np.int64)
        for name, size, column in zip(self.names, self.sizes, columns.T, strict=True):
            if column.size and not (column.min() >= 0 and column.max() < size):
                raise InputError(f"feature '{name}' must lie in [0, {size}), got {column.min()}..{column.max()}")
        return columns
