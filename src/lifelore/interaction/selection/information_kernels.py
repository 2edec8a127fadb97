"""Compiled kernels: supports of beliefs, mixtures of signal distributions, the best policy after each signal."""

import numpy as np

from lifelore.core.compiled.jit import inlined, kernel


@kernel
def least_kept(belief, mass, least):
    """The least belief among the likeliest types that together hold `mass` of each belief.

    belief : (n, n_types) float64
    least : (n,) float64, written
    """
    for user in range(belief.shape[0]):
        rising = np.sort(belief[user])
        total = 0.0
        for i in range(rising.shape[0]):
            total += rising[i]
        left_out, least[user] = 0.0, rising[-1]
        # From below: the types left out may not exceed 1 - mass, and small numbers are summed first.
        for i in range(rising.shape[0]):
            left_out += rising[i]
            if rising[i] > 0 and left_out > (1.0 - mass) * total:
                least[user] = rising[i]
                break


@kernel
def mixtures(share, support, policies, probs, mixed):
    """Σ share F(signal | type, policy) over the types of a support, for some policies.

    share, support : (k,) float64 and int64
    policies : (n,) int64
    probs : (n_policies, n_types, n_signals)
    mixed : (n, n_signals) float64, written
    """
    n, n_signals = support.shape[0], probs.shape[2]
    fours = n - n % 4
    for place in range(policies.shape[0]):
        policy, row = policies[place], mixed[place]
        row[:] = 0.0
        # Four types at a time: the row of sums is read and written a quarter as often.
        for i in range(0, fours, 4):
            w0, w1, w2, w3 = share[i], share[i + 1], share[i + 2], share[i + 3]
            law0, law1 = probs[policy, support[i]], probs[policy, support[i + 1]]
            law2, law3 = probs[policy, support[i + 2]], probs[policy, support[i + 3]]
            for signal in range(n_signals):
                row[signal] += (w0 * law0[signal] + w1 * law1[signal]) + (w2 * law2[signal] + w3 * law3[signal])
        for i in range(fours, n):
            weight, law = share[i], probs[policy, support[i]]
            for signal in range(n_signals):
                row[signal] += weight * law[signal]


@kernel
def class_mixtures(share, support, classes, policies, probs, mixed):
    """`mixtures` with the shares of types of one class (n_policies, n_types) summed first."""
    n_signals = probs.shape[2]
    weights = np.empty(support.shape[0], probs.dtype)
    shown = np.empty(support.shape[0], np.int64)
    slots = np.empty(probs.shape[1], np.int64)
    for place in range(policies.shape[0]):
        policy = policies[place]
        own = classes[policy]
        slots[:] = -1
        n = 0
        for i in range(support.shape[0]):
            slot = slots[own[support[i]]]
            if slot < 0:
                slots[own[support[i]]] = n
                weights[n] = share[i]
                shown[n] = support[i]
                n += 1
            else:
                weights[slot] += share[i]
        row = mixed[place]
        row[:] = 0.0
        for j in range(n):
            weight, law = weights[j], probs[policy, shown[j]]
            for signal in range(n_signals):
                row[signal] += weight * law[signal]


@kernel
def best_after_signals(weighted, support, classes, number, policies, probs, best):
    """Σ over signals of the largest of Σ weighted F(signal | type, policy) over the types of a support.

    weighted : (k, n_candidates), the belief times the mean of each candidate on each type of the support
    support : (k,) int64
    classes, number : (n_policies, n_types) int32 and (n_policies,) int64, types whose laws are equal, as
        in `TypeClasses`
    policies : (n,) int64
    probs : (n_policies, n_types, n_signals), of the dtype of `weighted`
    best : (n,) float64, written
    """
    n_types, n_signals, n_candidates = probs.shape[1], probs.shape[2], weighted.shape[1]
    after = np.empty((n_candidates, n_signals), probs.dtype)
    laws = np.empty((support.shape[0], n_signals), probs.dtype)
    sums = np.empty((support.shape[0], n_candidates), probs.dtype)
    largest = np.empty(n_signals, probs.dtype)
    slots = np.empty(n_types, np.int64)
    by_candidate = np.ascontiguousarray(weighted.T)
    everything = support.shape[0] == n_types
    for place in range(policies.shape[0]):
        policy = policies[place]
        if number[policy] < n_types:
            n = _summed_by_class(weighted, support, classes[policy], probs[policy], slots, sums, laws)
            np.dot(sums[:n].T, laws[:n], after)
        elif everything:
            np.dot(by_candidate, probs[policy], after)
        else:
            for i in range(support.shape[0]):
                _copied(probs[policy, support[i]], laws[i])
            np.dot(by_candidate, laws, after)
        largest[:] = after[0]
        for q in range(1, n_candidates):
            row = after[q]
            for signal in range(n_signals):
                largest[signal] = max(largest[signal], row[signal])
        total = 0.0
        for signal in range(n_signals):
            total += largest[signal]
        best[place] = total


@inlined
def _copied(source, target):
    # A loop, for assigning a row takes three times as long.
    for i in range(source.shape[0]):
        target[i] = source[i]


@inlined
def _summed_by_class(weighted, support, own, probs, slots, sums, laws):
    """Sum rows of `weighted` by the class of their type, copy each class's law; returns the number of classes."""
    slots[:] = -1
    n = 0
    for i in range(support.shape[0]):
        slot = slots[own[support[i]]]
        if slot < 0:
            slots[own[support[i]]] = n
            _copied(weighted[i], sums[n])
            _copied(probs[support[i]], laws[n])
            n += 1
        else:
            for q in range(weighted.shape[1]):
                sums[slot, q] += weighted[i, q]
    return n
