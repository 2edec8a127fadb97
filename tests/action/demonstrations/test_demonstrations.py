"""Demonstrations: the file format by hand, bad lines by number, and counting."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lifelore.action.demonstrations.demonstrations import (
    Demonstration,
    count_demonstrations,
    demonstration_lines,
    demonstrations_from_lines,
    read_demonstrations,
    write_demonstrations,
)
from lifelore.action.priors.action_prior import ActionPrior
from lifelore.core.errors import InputError, StoreError

texts = st.text(st.characters(categories=["L", "N", "P", "S"], include_characters=" \u2028"), min_size=1)
steps = st.lists(st.tuples(st.integers(0, 2**61), st.integers(0, 99)), min_size=1, max_size=5)
shown = st.lists(st.tuples(texts, texts, steps), max_size=5)


def demonstration(task, agent, done) -> Demonstration:
    states, actions = np.array(done, np.int64).T
    return Demonstration(task, agent, states, actions)


def plain(demonstrations) -> list:
    return [(one.task, one.agent, one.states.tolist(), one.actions.tolist()) for one in demonstrations]


def test_lines_by_hand():
    lines = [
        '{"task": "t1", "agent": "ann", "state": 4, "action": 2}',
        '{"task": "t1", "agent": "bob", "state": 9, "action": 0, "comment": "hello"}',
        '{"action": 1, "state": 5, "agent": "ann", "task": "t1"}',
        "",
        '{"task": "t1", "agent": "ann", "state": 7, "action": 3}',
        '{"task": 2, "agent": "ann", "state": 0, "action": 0}',
    ]
    assert plain(demonstrations_from_lines(lines)) == [
        ("t1", "ann", [4, 5], [2, 1]),
        ("t1", "bob", [9], [0]),
        ("t1", "ann", [7], [3]),  # the empty line ended her first one
        ("2", "ann", [0], [0]),
    ]


@pytest.mark.slow
@settings(max_examples=25)
@given(shown)
def test_what_is_written_is_read(told):
    demonstrations = [demonstration(*one) for one in told]
    text = "\n".join(demonstration_lines(demonstrations))
    assert plain(demonstrations_from_lines(text.split("\n"))) == plain(demonstrations)


GOOD = '{"task": "t", "agent": "a", "state": 1, "action": 0}'


@pytest.mark.parametrize(
    ("line", "reason"),
    [
        ("not JSON", "must be JSON, got other text"),
        ("[" * 100_000, "must be JSON, got other text"),
        ("[1, 2]", "must be an object with task, agent, state, action, got list"),
        ('{"task": "t", "agent": "a", "state": 1}', "field 'action' is missing"),
        (
            '{"task": "t", "agent": "a", "state": -1, "action": 0}',
            "field 'state' must be a whole number from 0, got -1",
        ),
        ('{"task": "t", "agent": "a", "state": 1.0, "action": 0}', "field 'state' must be .*, got 1.0"),
        ('{"task": "t", "agent": "a", "state": true, "action": 0}', "field 'state' must be .*, got true"),
        ('{"task": "t", "agent": "a", "state": 1e999, "action": 0}', "field 'state' must be .*, got Infinity"),
        (f'{{"task": "t", "agent": "a", "state": {2**62}, "action": 0}}', "field 'state' must be"),
        ('{"task": "t", "agent": "a", "state": 1, "action": "left"}', "field 'action' must be .*, got \"left\""),
        ('{"task": "", "agent": "a", "state": 1, "action": 0}', "field 'task' must be a text or a whole number"),
        ('{"task": "t", "agent": null, "state": 1, "action": 0}', "field 'agent' must be .*, got null"),
    ],
)
def test_a_bad_line_is_named_by_its_number(tmp_path, line, reason):
    path = tmp_path / "shown.jsonl"
    path.write_text(f"{GOOD}\n\n{line}\n{GOOD}\n")
    with pytest.raises(InputError, match=rf"shown\.jsonl, line 3: {reason}"):
        read_demonstrations(path)


def test_files_that_cannot_be(tmp_path):
    with pytest.raises(InputError, match="cannot be read: No such file"):
        read_demonstrations(tmp_path / "gone")
    (tmp_path / "bytes").write_bytes(GOOD.encode() + b"\xff")
    with pytest.raises(InputError, match="must be UTF-8 text, got a bad byte at 52"):
        read_demonstrations(tmp_path / "bytes")
    with pytest.raises(StoreError, match="cannot be written to"):
        write_demonstrations(tmp_path / "no" / "where", [])
    (tmp_path / "empty").touch()
    assert read_demonstrations(tmp_path / "empty") == []


def test_counting_weighs_every_step_of_its_agent():
    # State's percept is its parity. Ann: 1→0, 3→0, 2→1 with weight 1; bob: 3→1 with weight ½.
    ann, bob = demonstration("t", "ann", [(1, 0), (3, 0), (2, 1)]), demonstration("t", "bob", [(3, 1)])
    prior = ActionPrior(2)
    count_demonstrations(prior, [ann, bob], lambda one: one.states % 2, {"ann": 1.0, "bob": 0.5})
    assert prior.counts([0, 1]).tolist() == [[0.0, 1.0], [2.0, 0.5]]
    alike = ActionPrior(2)
    count_demonstrations(alike, [ann, bob], lambda one: one.states % 2)
    assert alike.counts([1]).tolist() == [[2.0, 1.0]]
    with pytest.raises(InputError, match="got none for 'bob'"):
        count_demonstrations(prior, [bob], lambda one: one.states, {"ann": 1.0})
