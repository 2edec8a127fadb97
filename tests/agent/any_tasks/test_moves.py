from collections import Counter

import pytest

from lifelore.agent.any_tasks.moves import MOST_REPEATS, MoveCodes, counted, counts_of, counts_record, totals
from lifelore.agent.external_world.episode import Step


def test_codes_tell_moves_apart():
    codes = MoveCodes()
    state = codes.states[("a", 1)]
    step = Step(state, 0, 2, 0.5, codes.states["b"], False)
    assert codes.cause(state, 2) != codes.cause(state, 3)
    moved, paid = codes.pairs(step)
    assert moved[0] == codes.cause(state, 2)
    assert (moved[0] & 1, paid[0] & 1) == (0, 1)
    for other in (step._replace(ended=True), step._replace(reward=0.51)):
        assert codes.pairs(other)[0] == moved
        assert codes.pairs(other)[1][0] == paid[0]
        assert codes.pairs(other)[1][1] != paid[1]
    assert codes.pairs(step._replace(reward=0.5 + 1e-9)) == (moved, paid)
    elsewhere = codes.pairs(step._replace(following=codes.states["c"]))
    assert elsewhere[0][0] == moved[0]
    assert elsewhere[0][1] != moved[1]
    assert elsewhere[1][0] != paid[0]


def test_counts_survive_a_record_and_add_up():
    largest = 2**47 - 1, 2**16 - 1
    counts = Counter({largest: 1.5})
    counts.update(counts_of(counts_record("moves", "key", Counter({largest: 2, (3, 4): 0.5}), 0.5)))
    assert counts == {largest: 2.5, (3, 4): 0.25}
    assert totals(Counter({(3, 4): 0.25, (3, 5): 1.0, (2, 4): 2.0})) == {3: 1.25, 2: 2.0}


def test_a_task_counts_a_cause_so_often_at_most():
    codes = MoveCodes()
    step = Step(codes.states[0], 0, 1, 0.0, codes.states[1], False)
    other = step._replace(reward=1.0)
    moved, paid = codes.pairs(step)
    found = counted([step] * (3 * MOST_REPEATS) + [other] * MOST_REPEATS, codes)
    shares = {moved: 1.0, paid: 0.75, codes.pairs(other)[1]: 0.25}
    assert found == pytest.approx({pair: share * MOST_REPEATS for pair, share in shares.items()})
