"""Small libraries as rules read them: normal outcomes by SciPy, and a table of categories for signals."""

import numpy as np
from scipy.stats import norm

from lifelore.core.errors import InputError
from lifelore.interaction.finite_signals.signal_bins import normal_table
from lifelore.interaction.finite_signals.signal_table import SignalTable


class NormalOutcomes:
    """Normal outcomes (T, P), or of users (k, T, P), whose means are taken as exact."""

    mean_variance = None

    def __init__(self, mean, deviation):
        self.mean = np.array(mean, float)
        self.deviation = np.broadcast_to(np.asarray(deviation, float), self.mean.shape)

    def mean_on(self, types):
        return self.mean[types] if self.mean.ndim == 2 else self.mean[np.arange(len(self.mean)), types]

    def expected(self, belief):
        return np.einsum("...t,...tp->...p", belief, self.mean)

    def density(self, value):
        return norm.pdf(_over_pairs(value), self.mean, self.deviation)

    def exceedance(self, threshold):
        return norm.sf(_over_pairs(threshold), self.mean, self.deviation)

    def expected_excess(self, threshold):
        z = (self.mean - _over_pairs(threshold)) / self.deviation
        return self.deviation * (z * norm.cdf(z) + norm.pdf(z))

    def expected_mean_excess(self, threshold):
        return np.maximum(self.mean - _over_pairs(threshold), 0)


class SmallLibrary:
    """A library that all users share; without `probs` (T, P, S) the signal is the outcome, in bins."""

    def __init__(self, mean, deviation=1.0, probs=None, has_table=True):
        self.performance = NormalOutcomes(mean, deviation)
        self.n_types, self.n_policies = self.performance.mean.shape[-2:]
        self.prior = np.full(self.n_types, 1 / self.n_types)
        self.probs, self.has_table = None if probs is None else np.array(probs, float), has_table

    def table(self, n_bins=8):
        if not self.has_table:
            raise InputError("no finite alphabet of signals")
        if self.probs is not None:
            return SignalTable(self.probs)
        return normal_table(self.performance.mean, self.performance.deviation, n_bins)[1]

    def take(self, policies):
        """The library of some policies, made anew."""
        model = self.performance
        probs = None if self.probs is None else self.probs[:, policies]
        return SmallLibrary(model.mean[:, policies], model.deviation[:, policies], probs, self.has_table)


class UserLibrary(SmallLibrary):
    """Libraries of k users, on one axis: means and deviations (k, T, P), probs (k, T, P, S)."""

    def row(self, user):
        """A user's library alone."""
        model = self.performance
        return SmallLibrary(model.mean[user], model.deviation[user], self.probs[user])

    def part(self, rows, policies):
        """The libraries of some users, with some of the policies."""
        model = self.performance
        return UserLibrary(
            model.mean[rows][..., policies],
            model.deviation[rows][..., policies],
            self.probs[rows][..., policies, :],
        )


def problem(seed, n_types=5, n_policies=4, n_signals=6):
    """A library with categories for signals, some of them impossible, and a belief with a type ruled out."""
    users, beliefs = user_problem(seed, 1, n_types, n_policies, n_signals)
    return users.row(0), beliefs[0]


def user_problem(seed, k=5, n_types=5, n_policies=4, n_signals=6):
    """Libraries of k users as in `problem`, and a belief (k, T) of each."""
    random = np.random.default_rng(seed)
    mean = random.normal(scale=50, size=(k, n_types, n_policies))
    deviation = random.uniform(5, 30, (k, n_types, n_policies))
    probs = random.dirichlet(np.full(n_signals, 0.4), (k, n_types, n_policies))
    probs[random.random(probs.shape) < 0.2] = 0
    probs[..., 0] += 1e-3
    probs /= probs.sum(axis=-1, keepdims=True)
    belief = random.dirichlet(np.full(n_types, 0.7), k)
    belief[np.arange(k), random.integers(n_types, size=k)] = 0
    return UserLibrary(mean, deviation, probs), belief / belief.sum(axis=1, keepdims=True)


def as_lists(library):
    """Means and deviations [type][policy], and laws of signals [policy][type][signal]."""
    model = library.performance
    return model.mean.tolist(), model.deviation.tolist(), library.table(8).probs.transpose(1, 0, 2).tolist()


def _over_pairs(values):
    return np.asarray(values, float)[..., None, None]
