"""The stored belief is that of a replay of the evidence, whatever happened; the slow twin is a single agent."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lifelore.agent.personalise.decisions import Request, choose, decide, observe, update
from lifelore.agent.personalise.explanation import explain
from lifelore.agent.personalise.past import Line, add_lines
from lifelore.agent.personalise.study import open_study
from lifelore.memory import open_memory

from .studies import POLICIES, learnt_study, one_more, study_of, twin

FAMILIES = ("gaussian", "student-t", "categorical", "joint-normal")
every_study = pytest.mark.parametrize(
    "study",
    [
        *(pytest.param(learnt_study(model, change=change), id=f"{model} {change}") for model in FAMILIES
          for change in ("learnt", 0.0)),
        pytest.param(learnt_study("gaussian", models="plug-in", change=0.1), id="plug-in"),
        pytest.param(study_of(change=0.1), id="exact"),
    ],
)  # fmt: skip
STEPS = st.lists(
    st.tuples(st.sampled_from(["choose", "end", "past", "retell", "fit"]), st.integers(0, 2), st.integers(0, 1)),
    min_size=4, max_size=18,
)  # fmt: skip


def same_as_twin(memory, study, user, shown, prior=None):
    agent = twin(study, shown, prior)
    made = choose(memory, study, user)
    assert list(made["belief"].values()) == pytest.approx(agent.belief.tolist(), abs=1e-9)
    expected = dict(zip(study.library.policies, agent.expected_utility().tolist(), strict=True))
    assert made["expected"] == pytest.approx({name: expected[name] for name in study.active}, abs=1e-9)
    assert list(explain(memory, study, user)["belief"].values()) == pytest.approx(
        sorted(agent.belief.tolist(), reverse=True), abs=1e-9
    )


@every_study
def test_the_stored_belief_is_that_of_the_slow_twin_in_the_order_of_outcomes(study, new_place, clock):
    with open_memory(new_place("sqlite")) as memory:
        study = study.keep(memory)
        made = decide(memory, study, [Request(user) for user in ("ann", "bo") for _ in range(5)])
        shown = {"ann": [], "bo": []}
        for place in np.random.default_rng(0).permutation(10).tolist():
            one, outcome = made[place], float(place % 2)
            update(memory, study, one["decision"], outcome)
            shown[one["user"]].append((one["policy"], outcome))
        for user, rows in shown.items():
            same_as_twin(memory, study, user, rows)
        # A batch counts in the order of its decisions, whatever order it has.
        more = decide(memory, study, [Request("ann")] * 4)
        observe(memory, study, [(one["decision"], float(place % 2)) for place, one in enumerate(more)][::-1])
        shown["ann"] += [(one["policy"], float(place % 2)) for place, one in enumerate(more)]
        same_as_twin(memory, study, "ann", shown["ann"])
        # After another version, a replay of the evidence gives the same.
        study = replace(study, explore=0.01).keep(memory)
        for user, rows in shown.items():
            same_as_twin(memory, study, user, rows)


@settings(max_examples=12)
@given(steps=STEPS, model=st.sampled_from(["exact", *FAMILIES]), change=st.sampled_from([0.0, 0.1, "learnt"]))
def test_after_any_history_the_belief_is_that_of_a_fresh_replay(steps, model, change, new_place):
    """Decisions, outcomes in any order, lines of the past, contexts that change, and new versions of the study."""
    study = study_of(change=change) if model == "exact" else learnt_study(model, change=change)
    contexts = {"web": np.array([0.7, 0.3] if model == "exact" else [0.7, 0.2, 0.1])}
    users, now = ("ann", "bo", "cy"), [10**18]
    with open_memory(new_place("sqlite")) as memory, pytest.MonkeyPatch.context() as patch:
        patch.setattr("time.time_ns", lambda: now.__setitem__(0, now[0] + 10**7) or now[0])
        study = replace(study, contexts=contexts).keep(memory)
        past, ended = ({user: [] for user in users} for _ in range(2))
        open_now, told = [], dict.fromkeys(users)
        for number, (what, place, value) in enumerate(steps):
            user, outcome = users[place], float(value)
            if what == "choose":
                open_now += decide(memory, study, [Request(user), Request(user)])
            elif what == "end" and open_now:
                one = open_now.pop(place % len(open_now))
                update(memory, study, one["decision"], outcome)
                ended[one["user"]].append((one["policy"], outcome))
            elif what == "past":
                line = Line(user, POLICIES[place], outcome, time=number + 1)
                assert add_lines(memory, study, [line])["rows"] == 1
                past[user].append((POLICIES[place], outcome))
            elif what == "retell":
                told[user] = ("web", "none")[value]
                open_now.append(choose(memory, study, user, context=told[user]))
            else:
                study = replace(study, explore=0.001 * number).keep(memory)
        for user in users:
            prior = contexts["web"] if told[user] == "web" else None
            same_as_twin(memory, study, user, past[user] + ended[user], prior)


def test_a_context_that_changes_later_begins_from_its_prior(memory):
    study = study_of(contexts={"web": np.array([0.1, 0.9])}, change=0.2).keep(memory)
    shown = [(one_more(memory, study, "ann", outcome), outcome) for outcome in (3.0, 5.0)]
    same_as_twin(memory, study, "ann", shown)
    choose(memory, study, "ann", context="web")
    same_as_twin(memory, study, "ann", shown, [0.1, 0.9])
    shown.append((one_more(memory, study, "ann", 6.0), 6.0))
    same_as_twin(memory, study, "ann", shown, [0.1, 0.9])


def test_another_library_means_a_replay(memory):
    shown = []
    for study in (study_of(), learnt_study("categorical"), learnt_study("joint-normal"), study_of(change=0.3)):
        now = study.keep(memory)
        shown.append((one_more(memory, now, "ann", 1.0), 1.0))
        same_as_twin(memory, now, "ann", shown)
    # A program that has not seen the newest version yet writes the belief of its own one.
    old, new = open_study(memory, "s"), study_of(change=0.4).keep(memory)
    shown.append((one_more(memory, old, "ann", 1.0), 1.0))
    same_as_twin(memory, new, "ann", shown)


def test_a_belief_that_an_earlier_lifelore_stored_in_another_form_means_a_replay(file_memory):
    memory, study = file_memory, learnt_study("gaussian").keep(file_memory)
    shown = {user: [(one_more(memory, study, user, 1.0), 1.0)] for user in ("ann", "bo")}
    with memory.studies.writing(study.number) as rows:
        user = rows.users(["ann"])["ann"]
        rows.keep_beliefs([(user.number, user.state[:-8])], study.version)
    more = decide(memory, study, [Request("ann"), Request("bo")])  # both forms at once
    observe(memory, study, [(one["decision"], 3.0) for one in more])
    for one in more:
        shown[one["user"]].append((one["policy"], 3.0))
        same_as_twin(memory, study, one["user"], shown[one["user"]])


def test_a_policy_that_the_library_does_not_know_gives_no_evidence(memory):
    study = study_of(change=0.1).keep(memory)
    add_lines(memory, study, [Line("ann", "gone", 8.0, 1), Line("ann", "big", 8.0, 2)])
    same_as_twin(memory, study, "ann", [("gone", 8.0), ("big", 8.0)])
