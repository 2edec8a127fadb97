"""Mixtures of signal distributions, and the best to expect after each signal, compiled."""

import numpy as np

from lifelore.core.compiled.jit import inlined, kernel


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
def class_mixtures(share, kept, classes, probs, mixed):
    """`mixtures` with the shares of types of one class (n_policies, n_types) summed first."""
    n_signals = probs.shape[2]
    weights = np.empty(kept.shape[0], probs.dtype)
    shown = np.empty(kept.shape[0], np.int64)
    slots = np.empty(probs.shape[1], np.int64)
    for policy in range(probs.shape[0]):
        own = classes[policy]
        slots[:] = -1
        n = 0
        for i in range(kept.shape[0]):
            slot = slots[own[kept[i]]]
            if slot < 0:
                slots[own[kept[i]]] = n
                weights[n] = share[i]
                shown[n] = kept[i]
                n += 1
            else:
                weights[slot] += share[i]
        row = mixed[policy]
        row[:] = 0.0
        for j in range(n):
            weight, law = weights[j], probs[policy, shown[j]]
            for signal in range(n_signals):
                row[signal] += weight * law[signal]


@kernel
def best_after_signals(worth, kept, classes, number, probs, best):
    """Σ over signals of the largest of Σ worth F(signal | type, policy) over the types kept.

    worth : (k, n_candidates), the belief times the mean of each candidate on each type kept
    kept : (k,) int64
    classes, number : (n_policies, n_types) int32 and (n_policies,) int64, types whose laws are equal, as
        in `TypeClasses`
    probs : (n_policies, n_types, n_signals), of the dtype of `worth`
    best : (n_policies,) float64, written
    """
    n_types, n_signals, n_candidates = probs.shape[1], probs.shape[2], worth.shape[1]
    after = np.empty((n_candidates, n_signals), probs.dtype)
    laws = np.empty((kept.shape[0], n_signals), probs.dtype)
    sums = np.empty((kept.shape[0], n_candidates), probs.dtype)
    largest = np.empty(n_signals, probs.dtype)
    slots = np.empty(n_types, np.int64)
    by_candidate = np.ascontiguousarray(worth.T)
    everything = kept.shape[0] == n_types
    for policy in range(probs.shape[0]):
        if number[policy] < n_types:
            n = _summed_by_class(worth, kept, classes[policy], probs[policy], slots, sums, laws)
            np.dot(sums[:n].T, laws[:n], after)
        elif everything:
            np.dot(by_candidate, probs[policy], after)
        else:
            for i in range(kept.shape[0]):
                _copied(probs[policy, kept[i]], laws[i])
            np.dot(by_candidate, laws, after)
        largest[:] = after[0]
        for q in range(1, n_candidates):
            row = after[q]
            for signal in range(n_signals):
                largest[signal] = max(largest[signal], row[signal])
        total = 0.0
        for signal in range(n_signals):
            total += largest[signal]
        best[policy] = total


@inlined
def _copied(source, target):
    # A loop, for assigning a row takes three times as long.
    for i in range(source.shape[0]):
        target[i] = source[i]


@inlined
def _summed_by_class(worth, kept, own, probs, slots, sums, laws):
    """Rows of `worth` summed by the class of their type, and each class's law; returns the number of classes."""
    slots[:] = -1
    n = 0
    for i in range(kept.shape[0]):
        slot = slots[own[kept[i]]]
        if slot < 0:
            slots[own[kept[i]]] = n
            _copied(worth[i], sums[n])
            _copied(probs[kept[i]], laws[n])
            n += 1
        else:
            for q in range(worth.shape[1]):
                sums[slot, q] += worth[i, q]
    return n
