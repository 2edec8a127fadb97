"""Compiled kernels: log likelihoods of many signals under normals and under tables of probabilities."""

from lifelore.core.compiled.jit import kernel


@kernel
def normal_rows(policies, values, mean, precision, log_height, log_likelihood):
    """Write log densities of `values` (k,) into `log_likelihood` (k, n_types).

    mean, precision, log_height : (n_policies, n_types), see `Normals`
    """
    n = log_likelihood.shape[1]
    for k in range(policies.shape[0]):
        policy, value = policies[k], values[k]
        centre, tight, top, out = mean[policy], precision[policy], log_height[policy], log_likelihood[k]
        for i in range(n):
            z = (value - centre[i]) * tight[i]
            out[i] = top[i] - 0.5 * (z * z)


@kernel
def table_rows(policies, signals, log_probs, log_likelihood):
    """Write rows of `log_probs` (n_policies, n_signals, n_types) into `log_likelihood` (k, n_types)."""
    for k in range(policies.shape[0]):
        log_likelihood[k] = log_probs[policies[k], signals[k]]
