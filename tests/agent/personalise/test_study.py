"""A study in memory: it comes back bit for bit, is listed, archived, deleted, and refused where it is damaged."""

from dataclasses import replace

import numpy as np
import pytest

from lifelore.agent.personalise.decisions import choose
from lifelore.agent.personalise.study import open_study, study_states
from lifelore.app.service.study_watch import OpenStudies
from lifelore.core.errors import InputError, NotFoundError, StoreError
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.memory import open_memory
from lifelore.memory.studies import TABLES

from .studies import learnt_study, one_more, study_of


def test_a_study_comes_back_bit_for_bit(memory):
    kept = study_of(control=0.25, explore=0.1, change=0.05, contexts={"web": np.array([0.1, 0.9])}).keep(memory)
    found = open_study(memory, "s")
    assert found.library.to_bytes() == kept.library.to_bytes()
    assert found.contexts["web"].tolist() == [0.1, 0.9]
    assert found.selection == kept.selection
    for name in ("states", "control", "explore", "change", "models", "rule", "incumbent", "number", "version"):
        assert getattr(found, name) == getattr(kept, name)


@pytest.mark.parametrize("model", ["gaussian", "student-t", "categorical", "joint-normal"])
def test_a_study_from_memory_decides_as_before_it_was_stored(model, file_memory):
    study = learnt_study(model, rule="information-directed").keep(file_memory)
    said = []
    for one in (study, open_study(file_memory, "s")):
        one_more(file_memory, one, "ann", 1.0, request="r")
        said.append({key: choose(file_memory, one, "ann", seed=1)[key] for key in ("belief", "expected")})
    for key in ("belief", "expected"):
        assert said[0][key] == pytest.approx(said[1][key], rel=1e-12)


def test_a_version_for_each_change_but_of_states(memory):
    study = study_of().keep(memory)
    assert study_of().keep(memory).version == study.with_state("big", "retired").keep(memory).version == 1
    again = study_of(explore=0.1).keep(memory)
    assert (again.version, again.number) == (2, study.number)
    assert {version: about["explore"] for version, about in memory.studies.settings(study.number).items()} == {
        1: 0.0, 2: 0.1,
    }  # fmt: skip


def test_studies_are_listed_archived_and_deleted_alone(memory):
    first, other = study_of("one").keep(memory), study_of("two").keep(memory)
    for study in (first, other):
        one_more(memory, study, "ann", 3.0)
    assert memory.studies.set_state("one", "archived")
    assert not memory.studies.set_state("three", "archived")
    assert study_states(memory) == {"one": "archived", "two": "active"}
    assert memory.studies.delete("one")
    assert not memory.studies.delete("one")
    assert study_states(memory) == {"two": "active"}
    with memory._store.reading() as conn:
        for table in TABLES:
            assert conn.value(f"SELECT COUNT(*) FROM {table} WHERE study = ?", (first.number,)) == 0
    assert choose(memory, other, "ann")["belief"]["reader"] != pytest.approx(0.6)
    # Another study of the name has another number, so that nothing of the old one comes back.
    assert study_of("one").keep(memory).number > other.number


def test_a_change_by_another_program_is_seen(where):
    now = [0.0]
    with open_memory(where) as memory, open_memory(where) as other:
        study_of().keep(memory)
        studies = OpenStudies(memory, lambda: now[0])
        assert studies.get("s").version == 1
        study_of(explore=0.5).keep(other)
        other.studies.set_state("s", "archived")
        now[0] += 1.5
        assert (studies.get("s").explore, studies.get("s").archived) == (0.5, True)
        other.studies.delete("s")
        now[0] += 1.5
        with pytest.raises(NotFoundError, match="no study 's'"):
            studies.get("s")


def test_a_study_that_is_not_there_or_damaged(memory):
    study = study_of("one").keep(memory)
    with pytest.raises(NotFoundError, match=r"no study 'two' in .*; known: one\. Begin with .* --name"):
        open_study(memory, "two")
    with memory._store.writing() as conn:
        content = study.library.to_bytes()[:-20]
        conn.execute("UPDATE lifelore_study_versions SET content = ? WHERE study = ?", (content, study.number))
    with pytest.raises(StoreError, match="fit the study anew"):
        open_study(memory, "one")


@pytest.mark.parametrize(
    ("settings", "said"),
    [
        ({"control": 1.0}, "control must lie between 0 and 1, 1 left out, got 1"),
        ({"control": -0.1}, "control must lie"),
        ({"control": np.nan}, "control must lie"),
        ({"explore": 1.1}, "explore must lie between 0 and 1, got 1.1"),
        ({"change": -1}, "change must lie"),
        ({"change": "often"}, "change must be 'learnt' or a probability, got 'often'"),
        ({"rule": "magic"}, "rule must be one of"),
        ({"models": "exact"}, "models must be one of"),
        ({"incumbent": "none"}, "incumbent must be a policy in use, got 'none'"),
        ({"name": "a/b"}, "name must be at most 60 characters without '/'"),
        ({"name": ""}, "name must be 1 to 200 printable"),
    ],
)
def test_bad_settings(settings, said):
    with pytest.raises((InputError, NotFoundError), match=said):
        study_of(**settings)


def test_a_larger_library_before_leaves_nothing_in_a_later_study(file_memory):
    large = PolicyLibrary.from_means(np.random.default_rng(0).normal(size=(9, 30)), 1.0)
    replace(study_of(), library=large, states=dict.fromkeys(large.policies, "active")).keep(file_memory)
    assert study_of().keep(file_memory).version == 2
    assert open_study(file_memory, "s").library.policies == study_of().library.policies


def test_a_study_whose_rule_had_a_setting_that_is_gone_is_opened(file_memory):
    study = replace(learnt_study("gaussian"), rule="information-directed", rule_settings={"mass": 0.9}).keep(
        file_memory
    )
    found = file_memory.studies.newest("s")
    earlier = found.about | {"rule_settings": found.about["rule_settings"] | {"trials": False}}
    assert file_memory.studies.keep("s", earlier, found.content).version == 2
    assert open_study(file_memory, "s").selection == study.selection
