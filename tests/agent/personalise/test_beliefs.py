"""The stored belief: the bits of a replay after anything that may happen, in a time that does not grow."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from lifelore.agent.reuse import user_belief
from lifelore.agent.reuse.history import KIND, VERSION, Decision, open_history, user_key
from lifelore.agent.personalise.past import PastUser
from lifelore.agent.reuse.user_belief import basis_of, open_belief, replayed
from lifelore.agent.reuse.user_state import from_bytes

from lifelore.agent.personalise.decisions import choose, forget, update
from lifelore.agent.personalise.study import Study
from lifelore.core.errors import InputError
from lifelore.core.protocols import Record
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.reuse.bayesian_policy_reuse import BayesianPolicyReuse
from lifelore.memory import open_memory

POLICIES = ("big", "dark", "plain")
MEANS = np.array([[8.0, 1.0, 4.0], [1.0, 8.0, 4.0], [3.0, 3.0, 5.0]])


def study_of(change=0.0, **settings):
    library = PolicyLibrary.from_means(MEANS, 2.0, policies=POLICIES, prior=[0.5, 0.3, 0.2])
    return Study("s", library, dict.fromkeys(POLICIES, "active"), change=change, control=0.0, **settings)


@pytest.fixture
def memory(tmp_path):
    with open_memory(tmp_path / "m.db") as opened:
        yield opened


@pytest.fixture
def no_replay(monkeypatch):
    """From now on a replay of the whole history is an error."""

    def forbid():
        monkeypatch.setattr(user_belief, "replayed", None)

    return forbid


def stored(memory, user="ann"):
    return memory.recall_state(KIND, f"s/{user_key('s', user)}", VERSION)


def naive(study, decisions):
    """The slow twin: an agent that takes in every decision in its order."""
    agent = BayesianPolicyReuse(study.library, dynamics=study.dynamics)
    for one in decisions:
        if one.outcome is None or one.policy not in study.library.policies:
            agent.end_episode()
        else:
            agent.update(one.policy, one.outcome)
    return agent


def same_as_naive(study, state, decisions):
    agent = naive(study, decisions)
    return np.array_equal(state.head.log_belief, agent.log_belief) and state.head.surprise == agent.surprise


@pytest.mark.parametrize("change", [0.0, 0.05])
def test_the_stored_belief_is_that_of_a_replay_whatever_the_order_of_outcomes(memory, no_replay, change):
    study, generator = study_of(change), np.random.default_rng(0)
    open_now = [choose(memory, study, "ann")["decision"]]
    no_replay()
    for _ in range(60):
        if open_now and generator.random() < 0.5:
            place = generator.integers(len(open_now))
            update(memory, study, open_now.pop(place), float(generator.normal(4, 3)))
        else:
            open_now.append(choose(memory, study, "ann")["decision"])
        known = open_belief(memory, study, user_key("s", "ann"))
        assert stored(memory).content == known.state.to_bytes()
        assert same_as_naive(study, known.state, open_history(memory, study, user_key("s", "ann")).decisions)


@settings(max_examples=40, deadline=None)
@given(st.data())
def test_outcomes_in_any_order_give_the_bits_of_a_replay(data):
    study = study_of(data.draw(st.sampled_from([0.0, 0.1])))
    size = data.draw(st.integers(1, 70))
    decisions = [Decision(i, POLICIES[i % 3], 1.0, False, 0, 0) for i in range(size)]
    state = replayed(study, None, PastUser(), ())
    for one in decisions:
        state = state.after(study, [one], state.head)
    late = data.draw(st.lists(st.integers(0, size - 1), unique=True))
    for place, number in enumerate(late):
        decisions[number] = replace(decisions[number], outcome=float(place % 9))
        start = state.before(number)
        state = state.after(study, decisions[start.number :], start)
        still_open = [one.number for one in decisions if one.outcome is None]
        assert state.first_open == (still_open[0] if still_open else size)
    assert same_as_naive(study, state, decisions)
    again = from_bytes(state.to_bytes())
    assert again.to_bytes() == state.to_bytes()
    assert same_as_naive(study, again, decisions)


def test_checkpoints_stay_few_and_near_every_open_decision():
    """With d decisions after an open one, its outcome costs at most 2 d + 2 steps; 3 log2 n + 3 stay."""
    study = study_of()
    state = replayed(study, None, PastUser(), ())
    for number in range(3000):
        state = state.after(study, [Decision(number, "big", 1.0, False, 0, 0)], state.head)
    assert len(state.checkpoints) <= 3 * np.log2(3000) + 3
    for number in range(3000):
        steps = 3000 - state.before(number).number
        assert steps <= 2 * (3000 - number) + 2
    ended = [Decision(number, "big", 1.0, False, 0, 0, outcome=3.0) for number in range(3000)]
    settled = state.after(study, ended, state.checkpoints[0])
    assert [point.number for point in settled.checkpoints] == [3000]


def test_a_belief_of_earlier_decisions_is_not_read_again(memory, monkeypatch):
    """Each choice and each outcome reads the cells of one decision, however many there are."""
    study, read = study_of(), []
    recall, recall_states = type(memory).recall, type(memory).recall_states

    def counting(self, *name, slots=(0, 0)):
        record = recall(self, *name, slots=slots)
        read.append(0 if record is None else record.slots.size)
        return record

    def counting_states(self, names, *, slots=None):
        states = recall_states(self, names, slots=slots)
        read.extend(one.record.slots.size for one in states if one is not None and one.record is not None)
        return states

    for _ in range(30):
        update(memory, study, choose(memory, study, "ann")["decision"], 3.0)
    monkeypatch.setattr(type(memory), "recall", counting)
    monkeypatch.setattr(type(memory), "recall_states", counting_states)
    update(memory, study, choose(memory, study, "ann")["decision"], 3.0)
    assert read == [5]  # the open decision: five cells, none of the others


def of_earlier_lifelore(memory, study, n=5):
    """Decisions as a Lifelore without stored beliefs left them: no contribution brings a state."""
    history = open_history(memory, study, user_key("s", "ann"), "ann")
    for number in range(n):
        one = Decision(number, POLICIES[number % 3], 0.5, False, 1, 0)
        memory.contribute(history.robot, history.records_of(one), process=f"{number}.0", seq=0, task={})
        if number != 2:
            record = history.outcome_record(one, 2.0 * number, 2)
            memory.contribute(history.robot, [record], process=f"{number}.0", seq=1, task={})


@pytest.mark.parametrize("change", [0.0, 0.05])
def test_users_of_an_earlier_lifelore_go_on(memory, no_replay, change):
    study = study_of(change)
    of_earlier_lifelore(memory, study)
    assert stored(memory).content is None
    key = user_key("s", "ann")
    said = choose(memory, study, "ann")
    agent = naive(study, open_history(memory, study, key).decisions[:5])
    assert said["number"] == 5
    assert list(said["belief"].values()) == agent.belief.tolist()
    no_replay()
    update(memory, study, f"{key}-2", 1.0)
    update(memory, study, said["decision"], 7.0)
    known = open_belief(memory, study, key)
    assert same_as_naive(study, known.state, open_history(memory, study, key).decisions)
    assert memory.check() == []


def test_another_library_another_prior_and_a_merge_mean_a_replay(memory, tmp_path):
    study, key = study_of(contexts={"web": np.array([0.1, 0.1, 0.8])}), user_key("s", "ann")
    of_earlier_lifelore(memory, study, 3)
    update(memory, study, choose(memory, study, "ann")["decision"], 5.0)
    decisions = open_history(memory, study, key).decisions
    other = replace(study, library=PolicyLibrary.from_means(MEANS + 1, 3.0, policies=POLICIES))
    assert same_as_naive(other, open_belief(memory, other, key).state, decisions)
    changing = replace(study, change=0.2)
    assert same_as_naive(changing, open_belief(memory, changing, key).state, decisions)
    on_the_web = open_belief(memory, study, key, context="web").state
    assert on_the_web.basis == basis_of(study, "web", PastUser())
    assert not same_as_naive(study, on_the_web, decisions)
    with open_memory(tmp_path / "other.db") as copy:
        copy.merge_from(memory)
        update(copy, study, f"{key}-2", 3.0)
        memory.merge_from(copy)
    decisions = open_history(memory, study, key).decisions
    assert decisions[2].outcome == 3.0
    assert stored(memory).content is None
    assert same_as_naive(study, open_belief(memory, study, key).state, decisions)


def test_a_damaged_or_foreign_state_is_no_state(memory):
    study, key = study_of(), user_key("s", "ann")
    update(memory, study, choose(memory, study, "ann")["decision"], 5.0)
    good = stored(memory).content
    assert from_bytes(good) is not None
    for bad in (None, b"", good[:-1], good[:20] + b"x" + good[21:], b"\0" * 40):
        assert from_bytes(bad) is None
    history = open_history(memory, study, key)
    foreign = [Record(KIND, f"s/{key}", VERSION, "newest", [8000], [1], {"user": "ann", "context": None})]
    memory.contribute(history.robot, foreign, process="x", seq=0, task={})
    assert same_as_naive(study, open_belief(memory, study, key).state, history.decisions)


def test_a_forgotten_user_leaves_no_belief(memory):
    study = study_of()
    for _ in range(3):
        update(memory, study, choose(memory, study, "ann")["decision"], 9.0)
    forget(memory, study, "ann")
    assert stored(memory) is None
    assert list(choose(memory, study, "ann")["belief"].values()) == pytest.approx([0.5, 0.3, 0.2])


def test_an_outcome_of_absurd_size_is_refused(memory):
    study = study_of()
    made = choose(memory, study, "ann")["decision"]
    with pytest.raises(InputError, match=r"at most 1e\+100 in size, got 1e\+308"):
        update(memory, study, made, 1e308)
    assert update(memory, study, made, 1e99)["taken"]
