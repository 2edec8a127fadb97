import pytest

from lifelore.agent.any_tasks.moves import MOST_REPEATS, MoveCodes, OutcomeCounts, counted
from lifelore.agent.external_world.episode import Step


def test_codes_tell_moves_apart():
    codes = MoveCodes()
    state = codes.state(("a", 1))
    step = Step(state, 0, 2, 0.5, codes.state("b"), False)
    assert codes.cause(state, 2) != codes.cause(state, 3)
    moved, paid = codes.pairs(step)
    assert moved[0] == codes.cause(state, 2)
    assert (moved[0] & 1, paid[0] & 1) == (0, 1)
    for other in (step._replace(ended=True), step._replace(reward=0.51)):
        assert codes.pairs(other)[0] == moved
        assert codes.pairs(other)[1][0] == paid[0]
        assert codes.pairs(other)[1][1] != paid[1]
    assert codes.pairs(step._replace(reward=0.5 + 1e-9)) == (moved, paid)
    elsewhere = codes.pairs(step._replace(following=codes.state("c")))
    assert elsewhere[0][0] == moved[0]
    assert elsewhere[0][1] != moved[1]
    assert elsewhere[1][0] != paid[0]


def test_counts_survive_a_record_and_add_up():
    first, second = OutcomeCounts(), OutcomeCounts()
    first.add(2**47 - 1, 2**16 - 1, 1.5)
    second.add(2**47 - 1, 2**16 - 1)
    second.add(3, 4, 0.25)
    first.merge(OutcomeCounts.from_record(second.to_record("moves", "key")))
    assert dict(first.by_cause) == {2**47 - 1: {2**16 - 1: 2.5}, 3: {4: 0.25}}
    assert first.total(3) == 0.25
    assert first.total(5) == 0.0


def test_a_task_counts_a_cause_so_often_at_most():
    codes = MoveCodes()
    step = Step(codes.state(0), 0, 1, 0.0, codes.state(1), False)
    other = step._replace(reward=1.0)
    counts = counted([step] * (3 * MOST_REPEATS) + [other] * MOST_REPEATS, codes).scaled(0.5)
    moved, paid = codes.pairs(step)
    assert counts.by_cause[moved[0]] == {moved[1]: pytest.approx(0.5 * MOST_REPEATS)}
    assert counts.total(paid[0]) == pytest.approx(0.5 * MOST_REPEATS)
    assert counts.by_cause[paid[0]][paid[1]] == pytest.approx(0.75 * 0.5 * MOST_REPEATS)
