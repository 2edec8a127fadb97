"""Prior over types from numeric features of a user: a multinomial logistic regression, fitted and regularised.

    P(type | x) = (1 − s) softmax(W z + c) + s G₀,  z = (x − centre) / scale, cut to the range of the training rows

The strength of the features (inverse of the ridge penalty on W) has the best held-out likelihood, up to a standard
error; strength 0 leaves the features out. `PSEUDO_ROWS` rows of the library's prior G₀ are added at the centre, so
few rows give nearly G₀. The share s keeps every type possible, so that outcomes can correct a wrong prior. The
thesis has no features; its prior is G₀ (Alg. 7).
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.core.errors import InputError, NotFoundError
from lifelore.core.streams import stream
from lifelore.interaction.outcomes.outcome_rows import numbers

Array = NDArray[np.float64]

STRENGTHS = (0.0, 0.01, 0.1, 1.0, 10.0)
"""Variances of the weights per standardised feature that are compared; 0 leaves the features out."""
PSEUDO_ROWS = 5.0
"""Number of rows of the library's prior that are added at the centre; more trust the features later."""
SHARE = 0.01
"""Share of the library's prior in the answer; larger corrects wrong priors sooner and uses right ones less."""
FOLDS = 5
"""Parts of the rows that are held out in turn; more cost time."""
STEPS = 5000
"""Largest number of steps of a fit, which takes about twenty."""


@dataclass(frozen=True, eq=False)
class FeaturePrior:
    """A learnt map from features to a prior over types; made by `fit`.

    Parameters
    ----------
    names : tuple of str
        Of the features, distinct.
    library_prior : (n_types,) float64
        G₀.
    centre, scale : (n_features,) float64
        Mean and deviation of the training rows.
    low, high : (n_features,) float64
        Range of the standardised training rows; features beyond it count as its ends.
    weights : (n_types, n_features) float64
    intercept : (n_types,) float64
        Minus infinity for a type that G₀ and the training rows exclude.
    strength : float
        The chosen one of `STRENGTHS`.
    gain : float
        Held-out log likelihood in nats a row, less that of leaving the features out.

    Examples
    --------
    >>> ages = np.array([[20.0], [22.0], [25.0], [60.0], [63.0], [70.0]] * 5)
    >>> prior = FeaturePrior.fit(ages, [0, 0, 0, 1, 1, 1] * 5, [0.5, 0.5], ["age"])
    >>> prior.prior({"age": 24.0}).argmax()
    np.int64(0)
    """

    names: tuple[str, ...]
    library_prior: Array
    centre: Array
    scale: Array
    low: Array
    high: Array
    weights: Array
    intercept: Array
    strength: float
    gain: float

    @classmethod
    def fit(
        cls,
        features: ArrayLike,
        types: ArrayLike,
        library_prior: ArrayLike,
        names: Sequence[str] = (),
        *,
        seed: int = 0,
    ) -> "FeaturePrior":
        """The map fitted to rows of features and types.

        Parameters
        ----------
        features : (n, n_features) float
            Finite.
        types : (n,) int or (n, n_types) float
            The type of each row, or a belief over types.
        library_prior : (n_types,) float
            G₀; sums to 1.
        names : sequence of str, optional
            By default "feature 0", ….
        seed : int
            For the parts held out.

        Raises
        ------
        InputError
            Shapes do not agree, a feature is not finite, a name is not distinct, or a belief is no distribution.
        NotFoundError
            There is no such type.

        Examples
        --------
        >>> age = np.linspace(20, 60, 200)[:, None]
        >>> prior = FeaturePrior.fit(age, (age[:, 0] > 40).astype(int), [0.5, 0.5], ["age"])
        >>> prior.prior({"age": 25}).round(1).tolist(), prior.prior({"age": 55}).round(1).tolist()
        ([1.0, 0.0], [0.0, 1.0])
        """
        rows, prior = _checked_rows(features), np.asarray(library_prior, np.float64)
        names = _checked_names(names, rows.shape[1])
        beliefs = _beliefs(types, len(rows), prior)
        centre, scale = rows.mean(axis=0), rows.std(axis=0)
        # The deviation of equal large numbers may be a rounding above 0.
        constant = np.ptp(rows, axis=0) == 0
        centre, scale = np.where(constant, rows[0], centre), np.where(constant, 1.0, scale)
        rows = (rows - centre) / scale
        strength, gain = _best_strength(rows, beliefs, prior, seed)
        weights, intercept = _fitted(rows, beliefs, prior, strength)
        low, high = rows.min(axis=0), rows.max(axis=0)
        return cls(names, prior, centre, scale, low, high, weights, intercept, strength, gain)

    @property
    def n_types(self) -> int:
        """Number of types."""
        return len(self.library_prior)

    def prior(self, features: Mapping[str, float] | ArrayLike) -> Array:
        """Prior over types, (n_types,) or (..., n_types); rows sum to 1.

        Parameters
        ----------
        features : mapping of str to float, or (..., n_features) float in the order of `names`

        Raises
        ------
        InputError
            A feature is missing or not finite, or there is another number of features.
        NotFoundError
            There is no such feature.
        """
        if isinstance(features, Mapping):
            features = list(self.checked(features).values())
        values = np.asarray(features, np.float64)
        if values.ndim < 1 or values.shape[-1] != len(self.names) or not np.isfinite(values).all():
            raise InputError(
                f"features must be finite numbers (..., {len(self.names)}), one for each of "
                f"{', '.join(self.names)}, got {np.shape(values)}"
            )
        z = np.clip((values - self.centre) / self.scale, self.low, self.high)
        return _prior(z, self.weights, self.intercept, self.library_prior)

    def checked(self, features: Mapping[str, Any]) -> dict[str, float]:
        """The features as numbers in the order of `names`; errors as for `prior`."""
        for name in features:
            if name not in self.names:
                raise NotFoundError(f"unknown feature {name!r}; there are {', '.join(self.names)}")
        missing = [name for name in self.names if name not in features]
        if missing:
            raise InputError(
                f"features must have all of {', '.join(self.names)}, got no {', '.join(missing)}; without any "
                "feature the prior of all users is used"
            )
        found: dict[str, float] = {}
        for name in self.names:
            try:
                found[name] = float(features[name])
            except (TypeError, ValueError):
                found[name] = np.nan
            if not np.isfinite(found[name]):
                raise InputError(f"feature {name!r} must be a finite number, got {features[name]!r}")
        return found

    def to_dict(self) -> dict[str, Any]:
        """Plain data; `from_dict` restores every bit."""
        arrays = {name: value.tolist() for name, value in vars(self).items() if isinstance(value, np.ndarray)}
        # JSON has no infinity.
        arrays["intercept"] = [None if np.isneginf(value) else value for value in self.intercept.tolist()]
        return {"names": list(self.names), **arrays, "strength": self.strength, "gain": self.gain}

    @classmethod
    def from_dict(cls, data: Mapping[str, Any]) -> "FeaturePrior":
        """The map of `to_dict`; InputError where the data is none."""
        try:
            intercept = [-np.inf if value is None else value for value in data["intercept"]]
            arrays = {
                name: np.array(data[name], np.float64)
                for name in ("library_prior", "centre", "scale", "low", "high", "weights")
            }
            made = cls(
                names=tuple(data["names"]), intercept=np.array(intercept, np.float64), **arrays,
                strength=float(data["strength"]), gain=float(data["gain"]),
            )  # fmt: skip
            # A prior over features that are all 0 needs every array in its shape.
            fits = (
                made.weights.shape == (made.n_types, len(made.names))
                and np.isfinite(made.prior(np.zeros(len(made.names)))).all()
            )
        except (KeyError, TypeError, ValueError) as error:
            raise InputError(f"data must be a FeaturePrior's to_dict, got {error!r:.80}") from None
        if not fits:
            raise InputError("data must be a FeaturePrior's to_dict, its arrays do not fit one another")
        return made


def _best_strength(rows: Array, beliefs: Array, prior: Array, seed: int) -> tuple[float, float]:
    """The smallest strength whose held-out likelihood is within a standard error of the best, and its gain."""
    if len(rows) < FOLDS:
        return 0.0, 0.0
    part = stream(seed, "feature prior").permutation(len(rows)) % FOLDS
    likelihoods = np.empty((len(STRENGTHS), len(rows)))
    for fold in range(FOLDS):
        out = part == fold
        for place, strength in enumerate(STRENGTHS):
            weights, intercept = _fitted(rows[~out], beliefs[~out], prior, strength)
            probs = _prior(rows[out], weights, intercept, prior)
            logs = np.log(np.where(beliefs[out] > 0, probs, 1.0))
            likelihoods[place, out] = (beliefs[out] * logs).sum(axis=1)
    means = likelihoods.mean(axis=1)
    worse = likelihoods[means.argmax()] - likelihoods
    error = worse.std(axis=1, ddof=1) / np.sqrt(len(rows))
    chosen = int(np.flatnonzero(worse.mean(axis=1) <= error)[0])
    return STRENGTHS[chosen], float(means[chosen] - means[0])


def _fitted(rows: Array, beliefs: Array, prior: Array, strength: float) -> tuple[Array, Array]:
    """Weights (n_types, n_features) and intercepts (n_types,) from standardised rows and pseudo-rows."""
    n_types, n_features = len(prior), rows.shape[1]
    mass = beliefs.sum(axis=0) + PSEUDO_ROWS * prior
    weights = np.zeros((n_types, n_features))
    with np.errstate(divide="ignore"):
        intercept = np.log(mass / mass.sum())
    known = np.flatnonzero(mass > 0)
    if strength == 0 or len(known) < 2:
        return weights, intercept
    # Each row once for each type that it may be of, weighted by the belief.
    row, type_ = np.nonzero(beliefs)
    sample = np.concatenate([rows[row], np.zeros((n_types, n_features))])
    labels = np.concatenate([type_, np.arange(n_types)])
    share = np.concatenate([beliefs[row, type_], PSEUDO_ROWS * prior])
    used = share > 0
    from sklearn.linear_model import LogisticRegression

    model = LogisticRegression(C=strength, max_iter=STEPS, tol=1e-6).fit(sample[used], labels[used], share[used])
    # Of two types, scikit-learn gives the second's weights against the first.
    first = len(known) - len(model.coef_)
    weights[known[first:]] = model.coef_
    intercept[known] = 0.0
    intercept[known[first:]] = model.intercept_
    return weights, intercept


def _prior(rows: Array, weights: Array, intercept: Array, prior: Array) -> Array:
    """P(type | x) of standardised rows (..., n_features), (..., n_types)."""
    logits = rows @ weights.T + intercept
    powers = np.exp(logits - logits.max(axis=-1, keepdims=True))
    mixed = (1 - SHARE) * (powers / powers.sum(axis=-1, keepdims=True)) + SHARE * prior
    return mixed / mixed.sum(axis=-1, keepdims=True)


def _checked_rows(features: ArrayLike) -> Array:
    rows = numbers(features, "features must be numbers (n, n_features)")
    if rows.ndim != 2 or not rows.size:
        raise InputError(f"features must be (n, n_features) numbers, none of them 0, got {rows.shape}")
    if not np.isfinite(rows).all():
        row = int(np.flatnonzero(~np.isfinite(rows).all(axis=1))[0])
        raise InputError(f"features must be finite, row {row} is not; leave rows with a missing feature out")
    return rows


def _checked_names(names: Sequence[str], n: int) -> tuple[str, ...]:
    found = tuple(map(str, names)) or tuple(f"feature {place}" for place in range(n))
    if len(found) != n or len(set(found)) != n:
        raise InputError(f"names must be {n} distinct ones, one for each feature, got {', '.join(found)}")
    return found


def _beliefs(types: ArrayLike, n: int, prior: Array) -> Array:
    """A belief over types for each row, (n, n_types)."""
    if prior.ndim != 1 or not ((prior >= 0).all() and abs(prior.sum() - 1) <= 1e-9):
        raise InputError(f"library_prior must be at least 0 and sum to 1, got shape {prior.shape}")
    given = np.asarray(types)
    if given.shape == (n,) and given.dtype.kind in "iu":
        if given.size and not 0 <= given.min() <= given.max() < len(prior):
            raise NotFoundError(f"unknown type among types; there are 0 to {len(prior) - 1}")
        return np.eye(len(prior))[given]
    if given.shape != (n, len(prior)) or given.dtype.kind not in "fiub":
        raise InputError(f"types must be ({n},) numbers or ({n}, {len(prior)}) beliefs, got {given.shape}")
    beliefs = given.astype(np.float64)
    if not ((beliefs >= 0).all() and (np.abs(beliefs.sum(axis=1) - 1) <= 1e-6).all()):
        raise InputError("types must be beliefs, at least 0, that sum to 1 in each row")
    return beliefs
