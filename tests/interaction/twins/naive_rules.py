"""Rules for selecting a policy as plain loops over types, policies, signals and posteriors: slow twins.

`mean`, `deviation` and `mean_deviation` are [type][policy]: the mean of an outcome, the deviation of an outcome,
and that of the mean itself where it is not known. `laws` are [policy][type][signal].
"""

from math import exp, inf, log, pi, sqrt

from scipy.integrate import quad
from scipy.stats import norm


def posterior(belief, law, signal):
    """Bayes' rule for one policy's `law` [type][signal]; None where no type explains the signal."""
    joint = [b * row[signal] for b, row in zip(belief, law, strict=True)]
    total = sum(joint)
    return [x / total for x in joint] if total > 0 else None


def chance(belief, law, signal):
    return sum(b * row[signal] for b, row in zip(belief, law, strict=True))


def entropy(belief):
    return -sum(b * log(b) for b in belief if b > 0)


def utility(belief, mean, policy):
    return sum(b * row[policy] for b, row in zip(belief, mean, strict=True))


def utilities(belief, mean):
    return [utility(belief, mean, policy) for policy in range(len(mean[0]))]


def expected_entropy(belief, laws):
    """Entropy of every posterior, weighted by how likely its signal is; `laws` [policy][type][signal]."""
    found = []
    for law in laws:
        total = 0.0
        for signal in range(len(law[0])):
            after = posterior(belief, law, signal)
            if after is not None:
                total += chance(belief, law, signal) * entropy(after)
        found.append(total)
    return found


def belief_entropy(belief, mean, laws, kappa):
    """The rule as meant, up to a constant: utility less κ times the entropy to expect."""
    worth, entropies = utilities(belief, mean), expected_entropy(belief, laws)
    return [u - kappa * h for u, h in zip(worth, entropies, strict=True)]


def knowledge_gain(belief, mean, laws, candidates=None):
    """How much better the best utility is expected to be after the signal, by every posterior."""
    candidates = range(len(mean[0])) if candidates is None else candidates
    now = max(utility(belief, mean, q) for q in candidates)
    found = []
    for law in laws:
        total = 0.0
        for signal in range(len(law[0])):
            after = posterior(belief, law, signal)
            if after is not None:
                total += chance(belief, law, signal) * max(utility(after, mean, q) for q in candidates)
        found.append(total - now)
    return found


def printed_gain(belief, mean, laws):
    """Eq. 4.6 as printed: signals are averaged before the maximum is taken."""
    now = max(utilities(belief, mean))
    found = []
    for law in laws:
        after = [0.0] * len(mean[0])
        for signal in range(len(law[0])):
            new = posterior(belief, law, signal)
            if new is not None:
                for q in range(len(after)):
                    after[q] += chance(belief, law, signal) * utility(new, mean, q)
        found.append(max(after) - now)
    return found


def printed_posterior(belief, law):
    """The thesis's expected posterior: each type's entry averaged under that type's own signals."""
    found = []
    for i in range(len(belief)):
        total = 0.0
        for signal in range(len(law[0])):
            after = posterior(belief, law, signal)
            if after is not None:
                total += law[i][signal] * after[i]
        found.append(total)
    return found


def density(value, mean, deviation):
    return exp(-0.5 * ((value - mean) / deviation) ** 2) / (deviation * sqrt(2 * pi))


def expected_improvement(belief, mean, deviation):
    """The integral of how much is gained, over everything above the best utility."""
    best = max(utilities(belief, mean))

    def gained(u, m, s):
        return (u - best) * density(u, m, s)

    found = []
    for policy in range(len(mean[0])):
        total = 0.0
        for b, means, deviations in zip(belief, mean, deviation, strict=True):
            m, s = means[policy], deviations[policy]
            end = max(best, m) + 12 * s
            total += b * quad(gained, best, end, args=(m, s), points=[m] if best < m else None, limit=200)[0]
        found.append(total)
    return found


def mean_excess(mean, deviation, threshold):
    """E[max(m − threshold, 0)] of a normal m; of a known m where the deviation is 0."""
    if deviation == 0:
        return max(mean - threshold, 0.0)
    end = max(threshold, mean) + 12 * deviation
    points = [mean] if threshold < mean else None
    return quad(lambda m: (m - threshold) * density(m, mean, deviation), threshold, end, points=points, limit=200)[
        0
    ]


def excess_of_means(belief, mean, mean_deviation, policy, threshold):
    """Σ β E[max(m − threshold, 0)] of a policy's mean pay m."""
    return sum(
        b * mean_excess(mean[i][policy], 0.0 if mean_deviation is None else mean_deviation[i][policy], threshold)
        for i, b in enumerate(belief)
    )


def mean_improvement(belief, mean, mean_deviation=None):
    """How much the mean pays exceed the best utility, weighted by the belief; the utilities where none does."""
    now = utilities(belief, mean)
    best = max(now)
    gained = [excess_of_means(belief, mean, mean_deviation, policy, best) for policy in range(len(now))]
    every = [value for row in mean for value in row]
    return gained if max(gained) > 1e-9 * (max(every) - min(every)) else now


def probability_above(belief, mean, deviation, target):
    return [
        sum(
            b * norm.sf(target, means[policy], deviations[policy])
            for b, means, deviations in zip(belief, mean, deviation, strict=True)
        )
        for policy in range(len(mean[0]))
    ]


def density_at(belief, mean, deviation, target):
    return [
        sum(
            b * density(target, means[policy], deviations[policy])
            for b, means, deviations in zip(belief, mean, deviation, strict=True)
        )
        for policy in range(len(mean[0]))
    ]


def information_ratio(belief, mean, laws):
    """Δ² over the information, which is what the entropy is expected to fall by."""
    best = sum(b * max(row) for b, row in zip(belief, mean, strict=True))
    before, after = entropy(belief), expected_entropy(belief, laws)
    worth = utilities(belief, mean)
    return [
        (best - u) ** 2 / (before - h) if before - h > 1e-9 else inf for u, h in zip(worth, after, strict=True)
    ]


def perfect_gain(belief, mean, mean_deviation=None):
    """Expected rise of the best utility if a single policy's mean pay became known, by every type it may have."""
    now = utilities(belief, mean)
    best = max(range(len(now)), key=now.__getitem__)
    found = []
    for policy in range(len(now)):
        others = [u for q, u in enumerate(now) if q != policy]
        if not others:
            return [0.0]
        # The better of m and the best other policy, on average, less the best utility now.
        known = max(others) + excess_of_means(belief, mean, mean_deviation, policy, max(others))
        found.append(known - now[best])
    return found


# ---- scores, the support of a belief, and the choice ------------------------------------------------------------


def tied_shares(scores, tolerance=1e-9):
    """Probability that the choice takes each policy: equals at random, relative to the best score."""
    best, least = max(scores), min((s for s in scores if s > -inf), default=0.0)
    bar = best
    if abs(best) < inf:
        bar -= tolerance * abs(best) + 1e-15 * max(abs(best), abs(least))
    tied = [score >= bar for score in scores]
    return [1 / sum(tied) if one else 0.0 for one in tied]
