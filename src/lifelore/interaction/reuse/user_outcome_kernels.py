"""Compiled kernels: statistics of the policies that each user tried, and likelihoods of outcomes given them.

A user's statistics lie in a chain of chunks of 144 bytes. `heads` names the chunk that was added last, `NEXT` in a
chunk the chunk before it. All chunks but the last are full. A chunk is read as 18 float64 (`real`) or as 36 int32
(`whole`), the same memory.

moments   real: SLOTS counts, SLOTS means, SLOTS sums of squared deviations; whole: SLOTS policies
counts    real: CELLS counts; whole: CELLS keys, policy times number of cells plus cell

`state` holds the number of chunks ever taken, the first chunk that was given back, -1 where there is none, and the
number of those given back.
"""

import math

import numpy as np

from lifelore.core.compiled.jit import inlined, kernel
from lifelore.core.compiled.vector_log import plain_log, plain_log1p

WORDS, NEXT = 18, 35
"""Number of float64 in a chunk, and the place of the next chunk among its int32."""
SLOTS, CELLS = 5, 11
"""Number of policies in a chunk of moments, and of cells in a chunk of counts."""
LARGEST_RATIO = 1e300
"""Squared distances from the mean, in units of ν times the variance, count as at most this."""

_POLICIES, _KEYS = 6 * SLOTS, 2 * CELLS
_MEANS, _SQUARES = SLOTS, 2 * SLOTS
_AHEAD = 32
_HALF_LOG_PI = 0.5 * math.log(math.pi)


@inlined
def _touched(users, first, heads, whole):
    """Load the chunks of the next users all at once, as `user_kernels` does with their beliefs."""
    total = 0
    for k in range(first, min(first + _AHEAD, users.shape[0])):
        chunk = heads[users[k]]
        while chunk >= 0:
            total ^= whole[chunk, 0] ^ whole[chunk, WORDS]
            chunk = whole[chunk, NEXT]
    return total


@inlined
def _place_of(key, head, first, n, whole):
    """Chunk and place of a key among n a chunk from `first` on; chunk -1 where the user lacks it."""
    chunk = head
    while chunk >= 0:
        for j in range(n):
            if whole[chunk, first + j] == key:
                return chunk, j
        chunk = whole[chunk, NEXT]
    return -1, 0


@inlined
def _new_place(user, key, first, n, heads, sizes, whole, state):
    """Chunk and place of a new key, in the user's last chunk or in another."""
    place = sizes[user] % n
    if place == 0:
        chunk = state[1]
        if chunk >= 0:
            state[1] = whole[chunk, NEXT]
            state[2] -= 1
        else:
            chunk = state[0]
            state[0] += 1
        whole[chunk, NEXT] = heads[user]
        for j in range(n):
            whole[chunk, first + j] = -1
        heads[user] = chunk
    chunk = heads[user]
    whole[chunk, first + place] = key
    sizes[user] += 1
    return chunk, place


@kernel
def give_back(users, heads, sizes, whole, state):
    """Empty the chains of `users` (k,); their chunks serve other users."""
    for k in range(users.shape[0]):
        user = users[k]
        chunk = heads[user]
        while chunk >= 0:
            after = whole[chunk, NEXT]
            whole[chunk, NEXT] = state[1]
            state[1] = chunk
            state[2] += 1
            chunk = after
        heads[user], sizes[user] = -1, 0


@inlined
def _fade(head, real, whole, keep, n, second):
    """Multiply the first n numbers of a user's chunks by `keep`, and the n from `second` on if that is not 0."""
    chunk = head
    while chunk >= 0:
        for j in range(n):
            real[chunk, j] *= keep
            if second > 0:
                real[chunk, second + j] *= keep
        chunk = whole[chunk, NEXT]


# ---- moments: Student's t ----------------------------------------------------------------------------------


@inlined
def _gamma_parts(y):
    """Numbers a and b with log Γ(y + ½) - log Γ(y) = ½ log a + b, by Stirling's series at y + 8."""
    over = y * (y + 1) * (y + 2) * (y + 3) * (y + 4) * (y + 5) * (y + 6) * (y + 7)
    under = (y + 0.5) * (y + 1.5) * (y + 2.5) * (y + 3.5) * (y + 4.5) * (y + 5.5) * (y + 6.5) * (y + 7.5)
    shifted, inverse = np.divide(over, under), np.divide(1.0, y + 8)
    q = inverse * inverse
    series = -1 / 640 + q * (17 / 14336 + q * (-31 / 18432 + q * (691 / 180224)))
    return shifted * shifted * (y + 8), inverse * (-1 / 8 + q * (1 / 192 + q * series))


@kernel
def student_tops(half, scale, top):
    """Log density of t at its location: ν / 2 and ν times the squared scale, (n_policies, n_types) each."""
    for j in range(half.shape[0]):
        for i in range(half.shape[1]):
            a, b = _gamma_parts(half[j, i])
            top[j, i] = 0.5 * math.log(a / scale[j, i]) + b - _HALF_LOG_PI


@inlined
def _new_row(value, centre, half, narrow, top, out):
    """Log density of t for a policy never tried."""
    for i in range(out.shape[0]):
        d = value - centre[i]
        ratio = min(d * d * narrow[i], LARGEST_RATIO)
        out[i] = top[i] - (half[i] + 0.5) * plain_log1p(ratio)


@inlined
def _tried_row(value, count, average, squares, centre, doubt, weight, half, out):
    """Log density of t given `count` earlier outcomes."""
    for i in range(out.shape[0]):
        share = np.divide(1.0, 1.0 + count * doubt[i])
        gap = average - centre[i]
        scale = (weight[i] + squares + count * gap * gap * share) * (1.0 + doubt[i] * share)
        d = value - centre[i] - count * doubt[i] * share * gap
        inverse, y = np.divide(1.0, scale), half[i] + 0.5 * count
        a, b = _gamma_parts(y)
        ratio = min(d * d * inverse, LARGEST_RATIO)
        out[i] = 0.5 * plain_log(a * inverse) + b - _HALF_LOG_PI - (y + 0.5) * plain_log1p(ratio)


@inlined
def _alike_row(value, count, average, squares, centre, doubt, weight, half, out):
    """`_tried_row` where `doubt` and `half` are the same for all types: half the time."""
    share = 1.0 / (1.0 + count * doubt)
    wide, pull, spread, y = 1.0 + doubt * share, count * doubt * share, count * share, half + 0.5 * count
    a, b = _gamma_parts(y)
    top = 0.5 * math.log(a) + b - _HALF_LOG_PI
    for i in range(out.shape[0]):
        gap = average - centre[i]
        scale = (weight[i] + squares + spread * gap * gap) * wide
        d = value - centre[i] - pull * gap
        ratio = min(np.divide(d * d, scale), LARGEST_RATIO)
        out[i] = top - 0.5 * plain_log(scale) - (y + 0.5) * plain_log1p(ratio)


@inlined
def _add_moment(user, policy, value, chunk, place, heads, sizes, real, whole, state):
    """Add an outcome of a policy whose slot is found already; chunk -1: the policy is new to the user."""
    if chunk < 0:
        chunk, place = _new_place(user, policy, _POLICIES, SLOTS, heads, sizes, whole, state)
        for first in range(0, 3 * SLOTS, SLOTS):
            real[chunk, first + place] = 0.0
    count, average = real[chunk, place] + 1.0, real[chunk, _MEANS + place]
    gap = value - average
    average += gap / count
    real[chunk, place], real[chunk, _MEANS + place] = count, average
    real[chunk, _SQUARES + place] += gap * (value - average)


@kernel
def student_rows(
    adds,
    users,
    policies,
    values,
    heads,
    sizes,
    real,
    whole,
    state,
    centre,
    doubt,
    weight,
    half,
    narrow,
    top,
    alike,
    out,
):
    """Write log densities of outcomes given what each user has shown, and add the outcomes; in order.

    adds : bool, False: the outcomes are not added, see `add_moments`
    users, policies : (k,) int64
    values : (k,) float64, at most 1e100 in size
    heads, sizes : (n_users,) int32; real, whole, state: see the module; room for k more chunks
    centre, doubt, weight, half : (n_policies, n_types) float64, m₀, 1 / κ₀, ν₀ v₀ and ν₀ / 2
    narrow, top : (n_policies, n_types) float64, of the policy never tried: 1 / (ν₀ scale²), log density at m₀
    alike : (n_policies,) bool, whether all types share `doubt` and `half`
    out : (k, n_types) float64, written

    Returns a number without meaning, made of the chunks that are loaded ahead.
    """
    ahead = 0
    for k in range(users.shape[0]):
        if k % _AHEAD == 0:
            ahead ^= _touched(users, k, heads, whole)
        user, policy, value, row = users[k], policies[k], values[k], out[k]
        m0, i0, a0, h0 = centre[policy], doubt[policy], weight[policy], half[policy]
        chunk, place = _place_of(policy, heads[user], _POLICIES, SLOTS, whole)
        if chunk < 0:
            _new_row(value, m0, h0, narrow[policy], top[policy], row)
        else:
            count, average = real[chunk, place], real[chunk, _MEANS + place]
            squares = real[chunk, _SQUARES + place]
            if alike[policy]:
                _alike_row(value, count, average, squares, m0, i0[0], a0, h0[0], row)
            else:
                _tried_row(value, count, average, squares, m0, i0, a0, h0, row)
        if adds:
            _add_moment(user, policy, value, chunk, place, heads, sizes, real, whole, state)
    return ahead


@kernel
def new_student_rows(policies, values, centre, half, narrow, top, out):
    """Write log densities of outcomes of users who have shown nothing; arguments as in `student_rows`."""
    for k in range(policies.shape[0]):
        j = policies[k]
        _new_row(values[k], centre[j], half[j], narrow[j], top[j], out[k])


@kernel
def add_moments(users, policies, values, keeps, heads, sizes, real, whole, state):
    """Let what each user has shown count `keeps` (k,) of what it did, then add an outcome; nothing where NaN."""
    for k in range(users.shape[0]):
        if not 0.0 <= keeps[k] <= 1.0:
            continue
        user, policy = users[k], policies[k]
        if keeps[k] < 1.0:
            _fade(heads[user], real, whole, keeps[k], SLOTS, _SQUARES)
        chunk, place = _place_of(policy, heads[user], _POLICIES, SLOTS, whole)
        _add_moment(user, policy, values[k], chunk, place, heads, sizes, real, whole, state)


@kernel
def tried_moments(users, heads, sizes, real, whole, starts, policies, counts, averages):
    """Write the tried policies of `users` (k,) one after another, the count and mean of each.

    starts : (k + 1,) int64, where each user's begin, written
    policies : int64, counts, averages : float64, as many as the users' sizes, written
    """
    at = 0
    for k in range(users.shape[0]):
        starts[k] = at
        chunk, left = heads[users[k]], sizes[users[k]]
        while chunk >= 0:
            here, numbers, names = (left - 1) % SLOTS + 1, real[chunk], whole[chunk]
            for j in range(here):
                policies[at + j], counts[at + j] = names[_POLICIES + j], numbers[j]
                averages[at + j] = numbers[_MEANS + j]
            at += here
            left -= here
            chunk = names[NEXT]
    starts[users.shape[0]] = at


# ---- counts: Dirichlet -------------------------------------------------------------------------------------


@inlined
def _counted_row(prior, totals, seen, total, log_size, out):
    """Log density of a cell seen `seen` times among `total`; minus infinity where it is impossible."""
    for i in range(out.shape[0]):
        share = np.divide(prior[i] + seen, totals[i] + total)
        out[i] = plain_log(share) - log_size if share > 0 else -np.inf


@inlined
def _add_count(user, key, heads, sizes, real, whole, state):
    chunk, place = _place_of(key, heads[user], _KEYS, CELLS, whole)
    if chunk < 0:
        chunk, place = _new_place(user, key, _KEYS, CELLS, heads, sizes, whole, state)
        real[chunk, place] = 0.0
    real[chunk, place] += 1.0


@kernel
def counted_rows(adds, users, policies, cells, heads, sizes, real, whole, state, prior, totals, log_sizes, out):
    """Write log densities of cells given the cells that each user has shown, and add them; in order.

    adds : bool, False: the cells are not added, see `add_counts`
    cells : (k,) int64, -1 for an outcome in no cell, which is impossible and is not added
    prior : (n_policies, n_cells, n_types) float64, counts of the library
    totals : (n_policies, n_types) float64, their sums
    log_sizes : (n_cells,) float64
    out : (k, n_types) float64, written
    The other arguments, and the return value, are as in `student_rows`.
    """
    n_cells, ahead = prior.shape[1], 0
    for k in range(users.shape[0]):
        if k % _AHEAD == 0:
            ahead ^= _touched(users, k, heads, whole)
        user, policy, cell, row = users[k], policies[k], cells[k], out[k]
        if cell < 0:
            row[:] = -np.inf
            continue
        key = policy * n_cells + cell
        seen, total = 0.0, 0.0
        chunk = heads[user]
        while chunk >= 0:
            for j in range(CELLS):
                other = whole[chunk, _KEYS + j]
                if other >= 0 and other // n_cells == policy:
                    total += real[chunk, j]
                    seen += real[chunk, j] if other == key else 0.0
            chunk = whole[chunk, NEXT]
        _counted_row(prior[policy, cell], totals[policy], seen, total, log_sizes[cell], row)
        if adds and row.max() > -np.inf:
            _add_count(user, key, heads, sizes, real, whole, state)
    return ahead


@kernel
def new_counted_rows(policies, cells, prior, totals, log_sizes, out):
    """Write log densities of cells of users who have shown nothing; arguments as in `counted_rows`."""
    for k in range(policies.shape[0]):
        j, cell = policies[k], cells[k]
        if cell < 0:
            out[k] = -np.inf
        else:
            _counted_row(prior[j, cell], totals[j], 0.0, 0.0, log_sizes[cell], out[k])


@kernel
def add_counts(users, policies, cells, keeps, n_cells, heads, sizes, real, whole, state):
    """As `add_moments`, for cells; -1 adds nothing."""
    for k in range(users.shape[0]):
        if cells[k] < 0 or not 0.0 <= keeps[k] <= 1.0:
            continue
        if keeps[k] < 1.0:
            _fade(heads[users[k]], real, whole, keeps[k], CELLS, 0)
        _add_count(users[k], policies[k] * n_cells + cells[k], heads, sizes, real, whole, state)


@kernel
def tried_counts(users, heads, sizes, real, whole, means, n_policies, starts, policies, counts, averages):
    """As `tried_moments`, from the cells that users have shown; `means` (n_cells,) are those of the cells."""
    n_cells, at = means.shape[0], 0
    owner, position = np.full(n_policies, -1), np.zeros(n_policies, np.int64)
    for k in range(users.shape[0]):
        starts[k] = at
        chunk, left = heads[users[k]], sizes[users[k]]
        while chunk >= 0:
            here = (left - 1) % CELLS + 1
            for j in range(here):
                policy, cell = divmod(whole[chunk, _KEYS + j], n_cells)
                if owner[policy] != k:
                    owner[policy], position[policy] = k, at
                    policies[at], counts[at], averages[at] = policy, 0.0, 0.0
                    at += 1
                own, weight = position[policy], real[chunk, j]
                counts[own] += weight
                averages[own] += weight * means[cell]
            left -= here
            chunk = whole[chunk, NEXT]
        for own in range(starts[k], at):
            averages[own] /= counts[own]
    starts[users.shape[0]] = at
