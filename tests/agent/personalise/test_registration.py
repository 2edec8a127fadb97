"""Policies that are retired, brought back and piloted, and sets of policies that a user can get."""

import pytest

from lifelore.agent.personalise.decisions import Request, choose, decide
from lifelore.agent.personalise.registration import add, listed_policies, retire
from lifelore.agent.personalise.study import open_study
from lifelore.core.errors import InputError, NotFoundError

from .studies import belief_of, one_more, study_of


def test_a_retired_policy_is_chosen_no_more_and_stays_evidence(memory):
    study = study_of(change=0.0).keep(memory)
    while one_more(memory, study, "ann", 8.0) != "big":
        pass
    before = belief_of(memory, study, "ann")
    retire(memory, study, "big")
    study = open_study(memory, "s")
    assert (study.states, study.version) == ({"big": "retired", "dark": "active", "plain": "active"}, 1)
    assert belief_of(memory, study, "ann") == before
    made = decide(memory, study, [Request(f"user {i}") for i in range(60)])
    assert {one["policy"] for one in made} == {"dark", "plain"}
    assert [set(one["probabilities"]) for one in made] == [{"dark", "plain"}] * 60
    retire(memory, study, "dark")
    with pytest.raises(InputError, match="'plain' is the last policy in use"):
        retire(memory, open_study(memory, "s"), "plain")
    with pytest.raises(NotFoundError, match="no policy 'none'; there are big, dark, plain"):
        retire(memory, study, "none")
    assert "big" in add(memory, open_study(memory, "s"), "big").active


def test_what_can_not_be_retired_or_added(file_memory):
    with pytest.raises(InputError, match="'plain' is the incumbent"):
        retire(file_memory, study_of(control=0.1, incumbent="plain"), "plain")
    with pytest.raises(InputError, match="'big' is there already"):
        add(file_memory, study_of(), "big")
    for settings in ({"control": 0.0}, {"control": 0.2, "incumbent": "big"}):
        with pytest.raises(InputError, match="'new' has no outcome yet, and there is no control group"):
            add(file_memory, study_of(**settings), "new")


def test_retired_policies_are_left_out_of_sets_and_pilots_are_for_the_control_group(memory):
    study = add(memory, retire(memory, study_of(control=0.01).keep(memory), "plain"), "new")
    made = choose(memory, study, "ann", available=["dark", "plain"])
    assert (made["policy"], made["probability"], made["available"]) == ("dark", 1.0, ["dark"])
    with pytest.raises(InputError, match=r"in use, got plain; in use are big, dark, new"):
        choose(memory, study, "ann", available=["plain"])
    with pytest.raises(InputError, match="got new, which the control group alone gets; in use are big, dark"):
        choose(memory, study, "ann", available=["new"])


def test_words_of_the_command_line():
    study = study_of(policies=("a", "b,c", "d"))
    assert listed_policies(study, ["a, d"]) == ["a", "d"]
    assert listed_policies(study, ["b,c", "a"]) == ["a", "b,c"]
    with pytest.raises(NotFoundError, match="got 'b'"):
        listed_policies(study, ["a,b"])
