"""Compiled kernels: choices by the mean outcomes that are expected given what each user has shown.

Of a policy that a user tried, with k outcomes of mean x̄, a type expects m₀ + (k / (κ₀ + k)) (x̄ − m₀); of the
others, the library's mean m₀. The tried policies of the users stand one after another: those of user k from
`starts[k]` on, with `policies`, `counts` and `averages`.
"""

import numpy as np

from lifelore.core.compiled.jit import inlined, kernel
from lifelore.interaction.selection.ties import ROUNDING


@inlined
def _expected(count, average, mean, doubt):
    """The mean outcome expected after `count` outcomes, with doubt 1 / κ₀."""
    pull = count * doubt
    return mean + pull / (1.0 + pull) * (average - mean)


@inlined
def _tied(k, row, type_, bar, uniform, starts, policies, available, mean, order, owner, found):
    """One of the policies of at least `bar`: they are counted, then the one that `uniform` names is taken."""
    tied, taken = 0, -1
    for turn in range(2):
        left = int(uniform * tied)
        for j in range(starts[k], starts[k + 1]):
            policy = policies[j]
            if available[row, policy] and found[policy] >= bar:
                if turn and left == 0:
                    taken = policy
                left -= turn
                tied += 1 - turn
        for policy in order[type_]:
            if owner[policy] == k or not available[row, policy]:
                continue
            if mean[type_, policy] < bar:
                break
            if turn and left == 0:
                taken = policy
            left -= turn
            tied += 1 - turn
    return taken


@kernel
def respond(drawn, uniforms, starts, policies, counts, averages, available, mean, doubt, order, tolerance, chosen):
    """The best response of each user to the type drawn, equals at random, into `chosen` (k,).

    drawn : (k,) int64, types
    uniforms : (k,) float64 in [0, 1), decide among equals
    available : (k, n_policies) or (1, n_policies) bool
    mean, doubt : (n_types, n_policies) float64, m₀ and 1 / κ₀
    order : (n_types, n_policies) int32, policies by falling mean
    chosen : (k,) int64, written; -1 where no policy is available
    """
    n_policies = mean.shape[1]
    owner, found = np.full(n_policies, -1), np.empty(n_policies)
    for k in range(drawn.shape[0]):
        type_, row = drawn[k], min(k, available.shape[0] - 1)
        m0, i0, falling, may = mean[type_], doubt[type_], order[type_], available[row]
        best, second, at = -np.inf, -np.inf, -1
        for j in range(starts[k], starts[k + 1]):
            policy = policies[j]
            owner[policy] = k
            if may[policy]:
                value = _expected(counts[j], averages[j], m0[policy], i0[policy])
                found[policy] = value
                second = max(second, min(best, value))
                at = policy if value > best else at
                best = max(best, value)
        # The two best of the others: they stand in order.
        others = 0
        for policy in falling:
            if owner[policy] != k and may[policy]:
                value, others = m0[policy], others + 1
                second = max(second, min(best, value))
                at = policy if value > best else at
                best = max(best, value)
                if others == 2 or value < best:
                    break
        size = max(abs(best), abs(m0[falling[n_policies - 1]]))
        bar = best - (tolerance * abs(best) + ROUNDING * size)
        chosen[k] = at
        if second >= bar and at >= 0:
            chosen[k] = _tied(
                k, row, type_, bar, uniforms[k], starts, policies, available, mean, order, owner, found
            )


@kernel
def correct_scores(belief, starts, policies, counts, averages, mean, doubt, scores):
    """Replace the expected outcomes of tried policies in `scores` (k, n_policies) by those given their outcomes.

    belief : (k, n_types) float
    mean, doubt : (n_policies, n_types) float64
    """
    n = belief.shape[1]
    terms = np.empty(n)
    for k in range(belief.shape[0]):
        row = belief[k]
        for j in range(starts[k], starts[k + 1]):
            policy, count, average = policies[j], counts[j], averages[j]
            m0, i0 = mean[policy], doubt[policy]
            for i in range(n):
                pull = count * i0[i]
                terms[i] = row[i] * (m0[i] + np.divide(pull, 1.0 + pull) * (average - m0[i]))
            scores[k, policy] = terms.sum()
