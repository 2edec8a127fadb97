"""Mixtures of signal distributions, and the best to expect after each signal, compiled."""

import numpy as np

from lifelore.core.jit import kernel


@kernel
def mixtures(share, kept, probs, mixed):
    """Σ share F(signal | type, policy) over the types kept.

    share, kept : (k,) float64 and int64
    probs : (n_policies, n_types, n_signals)
    mixed : (n_policies, n_signals) float64, written
    """
    n, n_signals = kept.shape[0], probs.shape[2]
    fours = n - n % 4
    for policy in range(probs.shape[0]):
        row = mixed[policy]
        row[:] = 0.0
        # Four types at a time: the row of sums is read and written a quarter as often.
        for i in range(0, fours, 4):
            w0, w1, w2, w3 = share[i], share[i + 1], share[i + 2], share[i + 3]
            law0, law1 = probs[policy, kept[i]], probs[policy, kept[i + 1]]
            law2, law3 = probs[policy, kept[i + 2]], probs[policy, kept[i + 3]]
            for signal in range(n_signals):
                row[signal] += (w0 * law0[signal] + w1 * law1[signal]) + (w2 * law2[signal] + w3 * law3[signal])
        for i in range(fours, n):
            weight, law = share[i], probs[policy, kept[i]]
            for signal in range(n_signals):
                row[signal] += weight * law[signal]


@kernel
def best_after_signals(worth, kept, probs, best):
    """Σ over signals of the largest of Σ worth F(signal | type, policy) over the types kept.

    worth : (n_candidates, k), the belief times the mean of each candidate on each type kept
    kept : (k,) int64
    probs : (n_policies, n_types, n_signals), of the dtype of `worth`
    best : (n_policies,) float64, written
    """
    n_signals = probs.shape[2]
    after = np.empty((worth.shape[0], n_signals), probs.dtype)
    laws = np.empty((kept.shape[0], n_signals), probs.dtype)
    largest = np.empty(n_signals, probs.dtype)
    everything = kept.shape[0] == probs.shape[1]
    for policy in range(probs.shape[0]):
        if everything:
            np.dot(worth, probs[policy], after)
        else:
            for i in range(kept.shape[0]):
                laws[i] = probs[policy, kept[i]]
            np.dot(worth, laws, after)
        largest[:] = after[0]
        for q in range(1, worth.shape[0]):
            row = after[q]
            for signal in range(n_signals):
                largest[signal] = max(largest[signal], row[signal])
        total = 0.0
        for signal in range(n_signals):
            total += largest[signal]
        best[policy] = total
