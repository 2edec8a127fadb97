"""Choices among the policies that a user can get now: probability, record, log, and forgetting."""

import csv
import json

import numpy as np
import pytest
from lifelore.agent.reuse.availability import KIND, listed_policies
from lifelore.agent.reuse.history import histories, open_history, user_key

from lifelore.agent.personalise.decisions import add, choose, forget, retire, update
from lifelore.agent.personalise.report import report
from lifelore.agent.personalise.study import Study
from lifelore.core.errors import InputError, NotFoundError
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.selection import RULES, rule_named
from lifelore.memory import open_memory

POLICIES = ("big", "dark", "plain")
MEANS = np.array([[8.0, 1.0, 4.0], [1.0, 8.0, 4.0]])


def study_of(states=("active",) * 3, policies=POLICIES, **settings):
    library = PolicyLibrary.from_means(MEANS, 2.0, ("reader", "skimmer"), policies, prior=[0.6, 0.4])
    settings = {"control": 0.0, "rule": "sampling"} | settings
    return Study("s", library, dict(zip(policies, states, strict=True)), **settings)


@pytest.fixture
def memory(tmp_path):
    with open_memory(tmp_path / "m.db") as opened:
        yield opened


@pytest.mark.parametrize("name", sorted(RULES))
def test_the_probability_is_that_of_a_library_without_the_others(name, memory):
    study = study_of(rule=name, explore=0.2)
    made = choose(memory, study, "ann", available=["plain", "dark"])
    probs = rule_named(name).probabilities(study.library.take(policies=[1, 2]), np.array([0.6, 0.4]))
    assert made["probability"] == pytest.approx(0.8 * probs[("dark", "plain").index(made["policy"])] + 0.1)
    assert made["available"] == ["dark", "plain"]


def test_sampling_among_two_by_hand(memory):
    # The first type's best response among dark and plain is plain, the second type's is dark.
    study, seen = study_of(), set()
    for user in range(12):
        made = choose(memory, study, f"user {user}", available=["dark", "plain"])
        assert made["probability"] == pytest.approx({"plain": 0.6, "dark": 0.4}[made["policy"]])
        seen.add(made["policy"])
    assert seen == {"plain", "dark"}


def test_all_available_chooses_as_without_a_set(memory, tmp_path):
    study = study_of()
    free = [choose(memory, study, f"user {i}") for i in range(20)]
    with open_memory(tmp_path / "other.db") as other:
        masked = [choose(other, study, f"user {i}", available=POLICIES) for i in range(20)]
    assert [one["policy"] for one in free] == [one["policy"] for one in masked]
    assert [one["probability"] for one in free] == [one["probability"] for one in masked]
    assert {str(one["available"]) for one in free} == {"None"}


def test_the_set_is_stored_with_the_decision_and_survives_late_outcomes(memory):
    study = study_of()
    sets = [["dark", "plain"], None, ["big"], ["big", "dark", "plain"]]
    made = [choose(memory, study, "ann", available=one) for one in sets]
    for one in reversed(made):
        update(memory, study, one["decision"], 3.0)
    history = open_history(memory, study, user_key("s", "ann"))
    assert [one.available for one in history.decisions] == [one and tuple(one) for one in sets]
    assert [one.probability for one in history.decisions] == [one["probability"] for one in made]
    assert memory.check() == []


def test_decisions_of_an_earlier_lifelore_have_no_set_and_cost_no_further_record(memory):
    study = study_of()
    choose(memory, study, "ann")
    assert [one.available for one in histories(memory, study)[0].decisions] == [None]
    assert list(memory.keys(KIND)) == []


def test_the_log_names_the_set(memory, tmp_path):
    study = study_of(policies=("big", 'da,"rk', "plain"))
    choose(memory, study, "ann", available=['da,"rk', "plain"])
    choose(memory, study, "ann")
    report(memory, study, log=tmp_path / "log.csv")
    with (tmp_path / "log.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    assert json.loads(rows[0]["available"]) == ['da,"rk', "plain"]
    assert rows[1]["available"] == ""


def test_sets_are_merged_and_forgotten_with_their_user(memory, tmp_path):
    study = study_of()
    study.keep(memory)
    choose(memory, study, "ann", available=["big", "dark"])
    choose(memory, study, "bob", available=["plain"])
    with open_memory(tmp_path / "other.db") as other:
        other.merge_from(memory)
        decisions = open_history(other, study, user_key("s", "ann")).decisions
        assert decisions[0].available == ("big", "dark")
    forget(memory, study, "ann")
    record = memory.recall(KIND, f"s/{user_key('s', 'ann')}", 1)
    assert record is None or not record.slots.size
    assert open_history(memory, study, user_key("s", "bob")).decisions[0].available == ("plain",)
    # A decision after forgetting has a set of its own.
    choose(memory, study, "ann", available=["plain"])
    assert open_history(memory, study, user_key("s", "ann")).decisions[0].available == ("plain",)


def test_the_control_group_gets_available_policies_alike(memory):
    study = study_of(control=0.99)
    made = [choose(memory, study, f"user {i}", available=["big", "plain"]) for i in range(20)]
    assert {one["policy"] for one in made if one["control"]} == {"big", "plain"}
    assert {one["probability"] for one in made if one["control"]} == {0.5}


def test_a_control_group_whose_incumbent_is_not_available_gets_the_others_alike(memory):
    study = study_of(control=0.99, incumbent="dark")
    made = choose(memory, study, "user 0", available=["big", "plain"])
    assert made["control"]
    assert made["probability"] == 0.5
    again = choose(memory, study, "user 0", available=["big", "dark"])
    assert (again["policy"], again["probability"]) == ("dark", 1.0)


def test_retired_policies_are_left_out_and_pilots_are_for_the_control_group(memory):
    study = add(memory, retire(memory, study_of(control=0.01), "plain"), "new")
    made = choose(memory, study, "ann", available=["dark", "plain"])
    assert (made["policy"], made["probability"], made["available"]) == ("dark", 1.0, ["dark"])
    with pytest.raises(InputError, match=r"in use, got plain; in use are big, dark, new"):
        choose(memory, study, "ann", available=["plain"])
    with pytest.raises(InputError, match="got new, which the control group alone gets; in use are big, dark"):
        choose(memory, study, "ann", available=["new"])


@pytest.mark.parametrize(
    ("available", "error", "words"),
    [([], InputError, "got none"), (["big", "x"], NotFoundError, "'x'; there are big, dark, plain")],
)
def test_bad_sets_are_refused_and_nothing_is_stored(available, error, words, memory):
    with pytest.raises(error, match=words):
        choose(memory, study_of(), "ann", available=available)
    assert histories(memory, study_of()) == []


def test_words_of_the_command_line():
    study = study_of(policies=("a", "b,c", "d"))
    assert listed_policies(study, ["a, d"]) == ["a", "d"]
    assert listed_policies(study, ["b,c", "a"]) == ["a", "b,c"]
    with pytest.raises(NotFoundError, match="got 'b'"):
        listed_policies(study, ["a,b"])
