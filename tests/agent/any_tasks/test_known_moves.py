from collections import Counter
from math import exp, lgamma, log

import numpy as np
import pytest

from lifelore.agent.any_tasks.known_moves import KnownMoves
from lifelore.agent.types.same_type import joined_types


def counts_of(rows):
    return Counter({(cause, outcome): n for cause, outcomes in rows.items() for outcome, n in outcomes.items()})


def drawn(random, laws, n):
    """Counts of n outcomes of each cause, by its law."""
    rows = {cause: random.multinomial(n, law).tolist() for cause, law in enumerate(laws)}
    return counts_of({cause: {o: count for o, count in enumerate(row) if count} for cause, row in rows.items()})


def log_dm(counts, base):
    """Log probability of a sequence, outcome by outcome."""
    total = lgamma(sum(base)) - lgamma(sum(base) + sum(counts))
    return total + sum(lgamma(b + c) - lgamma(b) for b, c in zip(base, counts, strict=True))


FIRST = counts_of({10: {1: 6}, 11: {1: 2, 2: 2}, 12: {5: 3}})
SECOND = counts_of({10: {2: 6}, 11: {1: 3, 2: 1}})


def test_laws_are_those_of_the_formula():
    moves = KnownMoves([FIRST, SECOND])
    assert moves.codes == [10, 11, 12]
    for place, (first, second) in enumerate([((6, 0, 0), (0, 6, 0)), ((2, 2, 0), (3, 1, 0))]):
        base, total = moves.base[place].tolist(), moves.base[place].sum()
        pooled = [a + b for a, b in zip(first, second, strict=True)]
        evidence = log_dm(first, base) + log_dm(second, base) - log_dm(pooled, base)
        q = moves.apart[place]
        odds = log(q / (1 - q)) - evidence
        assert 0.01 < 1 / (1 + exp(-odds)) < 0.9  # the learnt share, the same in both causes
        for type_, own in enumerate((first, second)):
            own_base = moves.own_base[type_, place].tolist()
            law = [
                (1 - q) * (p + b) / (sum(pooled) + total) + q * (c + mine) / (sum(own) + sum(own_base))
                for p, c, b, mine in zip(pooled, own, base, own_base, strict=True)
            ]
            assert moves.laws[type_, place] == pytest.approx(law)
    assert moves.apart[0] > 0.9 > 0.5 > moves.apart[1]
    # What a type has not shown is expected to be as in the other, mostly.
    place, effect = moves.place(12, 5)
    assert 0.6 < moves.laws[1, place, effect] < moves.laws[0, place, effect]
    assert moves.laws.sum(axis=2) == pytest.approx(np.ones((2, 3)))


def test_a_noisy_type_leaves_another_certain():
    certain = {cause: {1: 10} for cause in range(2, 42, 2)}
    noisy = {cause: {1: 4, 2: 3, 3: 3} for cause in range(2, 42, 2)}
    moves = KnownMoves([counts_of(certain | {50: {1: 1}}), counts_of(noisy | {50: {2: 1}})])
    (place, first), (_, second) = moves.place(50, 1), moves.place(50, 2)
    assert moves.laws[0, place, first] > moves.laws[1, place, second] + 0.1


def test_a_noisy_cause_leaves_the_others_certain():
    certain = {cause: {1: 10} for cause in range(2, 42, 2)}
    noisy = {cause: {1: 4, 2: 3, 3: 3} for cause in range(42, 82, 2)}
    moves = KnownMoves([counts_of(certain | noisy)])
    one, other = moves.place(2, 1)[0], moves.place(42, 1)[0]
    assert moves.laws[0, other, -1] > 5 * moves.laws[0, one, -1]
    assert moves.laws[0, one, 0] > 0.97


def test_own_outcomes_of_the_task_teach_every_type():
    moves = KnownMoves([FIRST, SECOND])
    own = np.zeros(moves.base.shape[1])
    own[1] = 50
    law = moves.law(0, own)
    assert law[:, 1].min() > 0.85
    assert law.sum(axis=1) == pytest.approx(np.ones(2))


def test_unknown_causes_and_outcomes_have_their_place():
    moves = KnownMoves([FIRST, SECOND])
    assert moves.place(99, 1) is None
    place, effect = moves.place(12, 77)
    assert moves.laws[:, place, effect].max() < 0.35


def test_types_that_nothing_tells_apart_are_joined():
    random = np.random.default_rng(0)
    laws = {"left": random.dirichlet([0.3] * 3, 60), "right": random.dirichlet([0.3] * 3, 60)}

    moves = KnownMoves([drawn(random, laws[name], 6) for name in ("left", "right", "left", "right")])
    assert sorted(moves.joined()) == [[0, 2], [1, 3]]


def test_a_task_of_another_type_is_told_from_a_known_one():
    random = np.random.default_rng(1)
    law = random.dirichlet([0.3] * 3, 40)
    moves = KnownMoves([drawn(random, law, 8), drawn(random, random.dirichlet([0.3] * 3, 40), 8)])
    assert moves.evidence_of_another(0, moves.own(drawn(random, law, 8))) < 0
    other = law.copy()
    other[:8] = random.dirichlet([0.3] * 3, 8)  # differs in a fifth of its causes
    found = [moves.evidence_of_another(0, moves.own(drawn(random, other, 8))) for _ in range(5)]
    assert min(found) > 0


def test_worlds_that_surprise_are_expected_to_surprise():
    steady = KnownMoves([counts_of({cause: {1: 20} for cause in range(30)})])
    random = np.random.default_rng(0)
    noisy = {}
    for cause in range(30):  # each of a thousand rare outcomes has a ten-thousandth
        rare = int((random.random(20) < 0.1).sum())
        noisy[cause] = {1: 20 - rare} | {100 + n: 1 for n in range(rare)}
    noisy = KnownMoves([counts_of(noisy)])
    assert steady.laws[0, :, -1].max() < 0.03
    shown = [len(row) - 1 for row in noisy._effects]
    assert np.mean(shown) > 1
    assert 0.05 < noisy.laws[0, :, -1].mean() < 0.2  # truly 0.1


@pytest.mark.parametrize("seed", range(4))
def test_the_two_least_apart_are_joined_first_as_a_plain_loop_does(seed):
    random = np.random.default_rng(seed)
    laws, base = random.dirichlet([0.3] * 3, (3, 5)), np.full((5, 3), 0.4)
    counts = random.multinomial(2, laws[random.integers(3, size=12)]).astype(float)

    def apart(one, other):
        pairs = zip(one.tolist(), other.tolist(), strict=True)
        return sum(log_dm(a, [0.4] * 3) + log_dm(b, [0.4] * 3) - log_dm(np.add(a, b), [0.4] * 3) for a, b in pairs)

    groups = {number: (counts[number], [number]) for number in range(12)}
    while len(groups) > 1:
        found = {(i, j): apart(groups[i][0], groups[j][0]) for i in groups for j in groups if i < j}
        i, j = min(found, key=found.__getitem__)
        if found[i, j] >= 0:
            break
        second = groups.pop(j)
        groups[i] = groups[i][0] + second[0], groups[i][1] + second[1]
    joined = joined_types(counts, base, lambda evidence: evidence.sum(axis=-1), 0.0)
    assert joined == [sorted(members) for _, members in groups.values()]
    assert 1 < len(joined) < 12
    assert joined_types(np.ones((3, 5, 3)), base, lambda evidence: evidence.sum(axis=-1), 0.0) == [[0, 1, 2]]
