"""Streams: what is steady passes, what flickers does not, and contradictions never stand side by side."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lifelore.core.errors import InputError
from lifelore.perception.relations.hysteresis import RelationFilter
from lifelore.perception.relations.relation import Relation

ON = Relation(2, 3, "on", 0.9, 0.0)
UNDER = Relation(3, 2, "on", 0.9, 0.0)
BESIDE = Relation(2, 3, "adjacent", 0.9, 0.0)


def run(stream, frames):
    return [stream.update(frame) for frame in frames]


@pytest.mark.parametrize("hold", [1, 2, 5])
def test_a_steady_stream_passes_after_hold_frames_and_leaves_after_as_many(hold):
    seen = run(RelationFilter(hold=hold), [[ON]] * 6 + [[]] * 6)
    assert seen == [()] * (hold - 1) + [(ON,)] * 6 + [()] * (7 - hold)


@pytest.mark.parametrize("first", [None, BESIDE])
def test_what_alternates_from_frame_to_frame_never_changes_anything(first):
    stream = RelationFilter(hold=2)
    run(stream, [[first]] * 4 if first else [])
    before = stream.accepted
    # A label that comes every other frame is neither believed nor, if it was, given up.
    frames = [[ON], [first or UNDER]] * 20
    assert all(after == before for after in run(stream, frames))


def test_between_leave_and_enter_nothing_new_comes_and_nothing_old_goes():
    middling = Relation(2, 3, "on", 0.5, 0.0)
    assert run(RelationFilter(0.6, 0.4, 2), [[middling]] * 9)[-1] == ()
    stream = RelationFilter(0.6, 0.4, 2)
    run(stream, [[ON]] * 2)
    assert run(stream, [[middling]] * 9)[-1] == (middling,)
    assert run(stream, [[Relation(2, 3, "on", 0.3, 0.0)]] * 2)[-1] == ()


def test_a_new_label_replaces_the_old_without_a_frame_between():
    stream = RelationFilter(hold=3)
    run(stream, [[ON]] * 3)
    assert run(stream, [[BESIDE]] * 3) == [(ON,), (ON,), (BESIDE,)]


def test_after_a_label_is_given_up_its_challenger_starts_anew():
    stream = RelationFilter(hold=3)
    seen = run(stream, [[ON]] * 3 + [[]] + [[BESIDE]] * 5)
    assert seen[2:] == [(ON,), (ON,), (ON,), (), (), (), (BESIDE,)]


def test_none_is_believed_silently():
    stream = RelationFilter(hold=1)
    run(stream, [[ON]])
    assert stream.update([Relation(2, 3, "none", 0.9, 0.0)]) == ()


def test_a_symmetric_relation_is_the_same_from_either_side():
    stream = RelationFilter(hold=2)
    assert len(run(stream, [[BESIDE], [Relation(3, 2, "adjacent", 0.9, 0.0)]])[-1]) == 1


relations = st.builds(
    Relation,
    st.sampled_from([2, 3, 4]),
    st.sampled_from([2, 3, 4]),
    st.sampled_from(["on", "adjacent", "both", "none"]),
    st.sampled_from([0.1, 0.5, 0.7, 0.9]),
    st.just(0.0),
).filter(lambda r: r.a != r.b)


runs = st.lists(st.tuples(st.lists(relations, max_size=2), st.integers(1, 4)), max_size=12)


@pytest.mark.slow
@settings(deadline=None, max_examples=200)
@given(runs.map(lambda rows: [frame for frame, times in rows for _ in range(times)]), st.integers(1, 4))
def test_a_pair_has_one_label_and_changes_at_most_once_in_hold_frames(frames, hold):
    last_change: dict[frozenset, int] = {}
    before: dict[frozenset, tuple] = {}
    stream = RelationFilter(hold=hold)
    for number, frame in enumerate(frames):
        shown = stream.update(frame)
        now = {frozenset((r.a, r.b)): _label(r) for r in shown}
        assert len(now) == len(shown)
        for pair in {*now, *before}:
            if now.get(pair) != before.get(pair):
                assert number - last_change.get(pair, -1) >= hold
                last_change[pair] = number
        before = now
    assert stream.accepted == (shown if frames else ())


def _label(r):
    return (r.relation, *(sorted((r.a, r.b)) if r.relation == "adjacent" else (r.a, r.b)))


@pytest.mark.parametrize("wrong", [{"enter": 1.1}, {"enter": 0.3, "leave": 0.5}, {"leave": -0.1}, {"hold": 0}])
def test_settings_out_of_range_are_refused(wrong):
    with pytest.raises(InputError):
        RelationFilter(**wrong)
