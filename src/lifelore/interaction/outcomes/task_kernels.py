"""Compiled kernels: the law of a task's outcomes and its evidence on the types, for a single task.

The twins in NumPy are `TaskNormals` and `task_outcomes.evidence_of`; both give the same bits.
"""

import math

import numpy as np

from lifelore.core.compiled.jit import inlined, kernel
from lifelore.core.compiled.vector_log import plain_exp, plain_log, plain_log1p, plain_ndtr

_ROOT_2_PI = math.sqrt(2 * math.pi)
LARGEST_RATIO, LARGEST_SQUARE, LARGEST_VARIANCE = 1e300, 1e300, 1e200


@inlined
def _densities(value, count, average, squares, location, variance, rarity, doubt, spreads, heights, out):
    """Write log densities of `value`, (n_spreads, n_types)."""
    for s in range(spreads.shape[0]):
        spread, row = spreads[s], out[s]
        for i in range(location.shape[0]):
            rare = rarity[i] + spread
            grown = 1 + count * rare
            apart = average - location[i]
            left = np.divide(rare, grown)
            freedom = np.divide(1.0, doubt[i]) + count
            found = variance[i] + doubt[i] * (squares + np.divide(count, grown) * (apart * apart))
            found = min(np.divide(found, 1 + doubt[i] * count), LARGEST_VARIANCE)
            square = min(found * (1 + left), LARGEST_SQUARE)
            gap = value - (location[i] + count * left * apart)
            z2 = np.divide(gap * gap, square)
            normal = freedom == np.inf
            finite = 1.0 if normal else freedom
            tail = 0.5 * (finite + 1) * plain_log1p(min(np.divide(z2, finite), LARGEST_RATIO))
            tail = 0.5 * z2 if normal else tail
            row[i] = heights[i] - 0.5 * plain_log(square) - tail


@kernel
def densities(value, shown, location, variance, rarity, doubt, spreads, heights, out):
    """Write the log densities of an outcome, (n_spreads, n_types); arguments are those of `task_evidence`."""
    _densities(value, shown[0], shown[1], shown[2], location, variance, rarity, doubt, spreads, heights, out)


@kernel
def task_evidence(
    value,
    shown,
    location,
    variance,
    rarity,
    doubt,
    spreads,
    heights,
    new_heights,
    log_weights,
    log_first,
    log_belief,
    log_anew,
    log_likelihood,
    changed,
    gain,
):
    """Write the evidence of an outcome; arguments and results are those of `task_outcomes.evidence_of`.

    shown : (3,) float64, count, mean and squares of the policy's outcomes so far
    location, variance, rarity, doubt : (n_types,) float64, of the policy
    heights, new_heights : (n_types,) float64, log densities at the location, given `shown` and given nothing
    log_anew : (n_types,) float64, or empty where types are static
    log_likelihood, changed : (n_types,) float64, gain : (n_spreads,) float64, written
    """
    n_spreads, n = spreads.shape[0], location.shape[0]
    count = shown[0]
    by = np.empty((n_spreads, n))
    _densities(value, count, shown[1], shown[2], location, variance, rarity, doubt, spreads, heights, by)
    fresh = by
    if log_anew.shape[0] > 0 and (count != 0.0 or shown[2] != 0.0):
        fresh = np.empty((n_spreads, n))
        _densities(value, 0.0, 0.0, 0.0, location, variance, rarity, doubt, spreads, new_heights, fresh)
    _evidence(by, fresh, log_weights, log_first, log_belief, log_anew, log_likelihood, changed, gain)


@kernel
def evidence_of(by, fresh, log_weights, log_first, log_belief, log_anew, log_likelihood, changed, gain):
    """`task_evidence` of an outcome whose log densities, `by` and `fresh` (n_spreads, n_types), are known."""
    _evidence(by, fresh, log_weights, log_first, log_belief, log_anew, log_likelihood, changed, gain)


@inlined
def _evidence(by, fresh, log_weights, log_first, log_belief, log_anew, log_likelihood, changed, gain):
    n_spreads, n = by.shape
    changing = log_anew.shape[0] > 0
    stays, share = np.zeros(n), np.empty(n)
    top, total = np.full(n, -np.inf), np.zeros(n)
    if changing:
        for i in range(n):
            log_share = -np.inf if log_anew[i] == -np.inf else min(log_anew[i] - log_belief[i], 0.0)
            rest = 1.0 - plain_exp(log_share)
            share[i] = log_share
            stays[i] = plain_log(rest) if rest > 0.0 else -np.inf
    for s in range(n_spreads):
        for i in range(n):
            top[i] = max(top[i], by[s, i] + log_weights[s] + stays[i])
    if changing:
        for s in range(n_spreads):
            for i in range(n):
                top[i] = max(top[i], fresh[s, i] + log_first[s] + share[i])
    for i in range(n):
        top[i] = top[i] if top[i] > -np.inf else 0.0
    for s in range(n_spreads):
        for i in range(n):
            total[i] += plain_exp(by[s, i] + log_weights[s] + stays[i] - top[i])
    changed[:] = 0.0
    if changing:
        for s in range(n_spreads):
            for i in range(n):
                changed[i] += plain_exp(fresh[s, i] + log_first[s] + share[i] - top[i])
    for i in range(n):
        total[i] += changed[i]
        possible = total[i] > 0.0
        whole = total[i] if possible else 1.0
        log_likelihood[i] = plain_log(whole) + top[i] if possible else -np.inf
        changed[i] = np.divide(changed[i], whole)
    if n_spreads > 1:
        for i in range(n):
            top[i] = plain_exp(log_belief[i])
        _gain(by, top, gain)


@kernel
def gain_of(by, belief, gain):
    """Write the log likelihoods (n_spreads,) of the spreads; `by` and `belief` as in `task_outcomes.gain_of`."""
    _gain(by, belief, gain)


@inlined
def _gain(by, belief, gain):
    n_spreads, n = by.shape
    highest, term = -np.inf, np.empty(n)
    for s in range(n_spreads):
        for i in range(n):
            highest = max(highest, by[s, i])
    gain[:] = 0.0
    if highest > -np.inf:
        for s in range(n_spreads):
            for i in range(n):
                term[i] = plain_exp(by[s, i] - highest) * belief[i]
            found = 0.0
            for i in range(n):
                found += term[i]
            gain[s] = plain_log(found) if found > 1e-307 else -np.inf


@kernel
def renew_means(policies, shown, location, rarity, spreads, weights, mean):
    """The means of `renew` alone."""
    n = location.shape[1]
    centre = np.empty(n)
    for j in range(policies.shape[0]):
        policy = policies[j]
        count, average = shown[j, 0], shown[j, 1]
        m0, r0 = location[policy], rarity[policy]
        centre[:] = 0.0
        for s in range(spreads.shape[0]):
            spread, weight = spreads[s], weights[s]
            for i in range(n):
                rare = r0[i] + spread
                left = np.divide(rare, 1 + count * rare)
                centre[i] += weight * (m0[i] + count * left * (average - m0[i]))
        for i in range(n):
            mean[i, policy] = centre[i]


@kernel
def renew(policies, shown, location, variance, rarity, doubt, spreads, weights, mean, noise, mean_variance):
    """Write expected means, noise and variances of means, (n_types, n_policies), of `policies` (m,).

    shown : (m, 3) float64, of these policies; the other arrays are those of `TaskNormals`
    """
    n = location.shape[1]
    centre, wide, inner, scatter = np.empty(n), np.empty(n), np.empty(n), np.empty(n)
    places = np.empty((spreads.shape[0], n))
    for j in range(policies.shape[0]):
        policy = policies[j]
        count, average, squares = shown[j, 0], shown[j, 1], shown[j, 2]
        m0, v0, r0, d0 = location[policy], variance[policy], rarity[policy], doubt[policy]
        centre[:], wide[:], inner[:], scatter[:] = 0.0, 0.0, 0.0, 0.0
        for s in range(spreads.shape[0]):
            spread, weight, place = spreads[s], weights[s], places[s]
            for i in range(n):
                rare = r0[i] + spread
                grown = 1 + count * rare
                apart = average - m0[i]
                left = np.divide(rare, grown)
                found = v0[i] + d0[i] * (squares + np.divide(count, grown) * (apart * apart))
                found = min(np.divide(found, 1 + d0[i] * count), LARGEST_VARIANCE)
                place[i] = m0[i] + count * left * apart
                centre[i] += weight * place[i]
                wide[i] += weight * found
                inner[i] += weight * (left * found)
        for s in range(spreads.shape[0]):
            weight, place = weights[s], places[s]
            for i in range(n):
                gap = place[i] - centre[i]
                scatter[i] += weight * (gap * gap)
        for i in range(n):
            freedom = np.divide(1.0, d0[i]) + count
            factor = 1 + np.divide(2.0, max(freedom - 2, 0.5))
            mean[i, policy] = centre[i]
            noise[i, policy] = factor * wide[i]
            mean_variance[i, policy] = factor * inner[i] + scatter[i]


@kernel
def mean_excess(mean, of_runs, of_spread, spread, tried, tried_variance, threshold, out):
    """Write E[max(m − threshold, 0)] of normal m, (n_types, n_policies); 0 where m is ten deviations below.

    m has the variance `of_runs` + `spread` × `of_spread`, of the policies `tried` (m,) `tried_variance`.
    """
    variance = np.empty_like(mean)
    means, runs, spreads, flat = mean.ravel(), of_runs.ravel(), of_spread.ravel(), variance.ravel()
    n = means.shape[0]
    for i in range(n):
        flat[i] = runs[i] + spreads[i] * spread
    for i in range(mean.shape[0]):
        for policy in tried:
            variance[i, policy] = tried_variance[i, policy]
    # Pairs that count are gathered: the long loop over them has no branch, so several turns run at a time.
    found, place, count = out.ravel(), np.empty(n, np.int64), 0
    for i in range(n):
        above = means[i] - threshold
        found[i] = 0.0
        place[count] = i
        count += 1 if above > 0 or above * above < 100 * flat[i] else 0
    excess = np.empty(count)
    for k in range(count):
        excess[k] = means[place[k]] - threshold
        flat[k] = flat[place[k]]
    for k in range(count):
        above, deviation = excess[k], np.sqrt(flat[k])
        z = min(max(np.divide(above, max(deviation, 1e-300)), -1e3), 1e3)
        density = np.divide(plain_exp(-0.5 * z * z), _ROOT_2_PI)
        excess[k] = max(deviation * density + above * plain_ndtr(z), 0.0)
    for k in range(count):
        found[place[k]] = excess[k]


@kernel
def normal_below(policies, cuts, mean, deviation, out):
    """Write P(U ≤ cut | type) of `policies` (m,), taken as normal, (m, n_types, n_cuts).

    cuts : (m, n_cuts) float64
    mean, deviation : (n_types, n_policies) float64
    out : contiguous
    """
    for place in range(policies.shape[0]):
        policy = policies[place]
        for i in range(mean.shape[0]):
            centre, wide = mean[i, policy], deviation[i, policy]
            for j in range(cuts.shape[1]):
                out[place, i, j] = np.divide(cuts[place, j] - centre, wide)
    flat = out.ravel()
    for i in range(flat.shape[0]):
        flat[i] = plain_ndtr(flat[i])
