"""A long-lived agent on three doors: recognises, reuses, notices a new type, and knows the same from records."""

import numpy as np
import pytest

from lifelore.agent.long_lived.curiosity import context_to_practise, curious_contexts, curious_types
from lifelore.agent.long_lived.explanation import explained, task_document, type_words
from lifelore.agent.long_lived.knowledge import Knowledge, SpanNews, TaskNews
from lifelore.agent.long_lived.live_task import LivingSettings, live_task
from lifelore.agent.long_lived.task_family import AGENTS
from lifelore.core.errors import InputError
from lifelore.core.protocols import Record
from lifelore.domains.task_stream import TaskStream
from tests.agent.long_lived.doors import Doors

LIVING = LivingSettings(n_episodes=6)


def lived(family, n, agent="full", start=0, knowledge=None, robot="r"):
    knowledge = knowledge or Knowledge.empty(family)
    tasks, records = [], []
    for number in range(start, start + n):
        if not AGENTS[agent].memory:
            knowledge = Knowledge.empty(family)
        drawn, task = family.meet(number, AGENTS[agent])
        one, news = live_task(knowledge, drawn, task, AGENTS[agent], LIVING, f"{robot}.{number}")
        tasks.append(one)
        records += news
    return knowledge, tasks, records


@pytest.fixture(scope="module")
def settled():
    family = Doors(TaskStream(("0", "1"), n_contexts=2, loyalty=1.0, zipf=0.0))
    return family, *lived(family, 40)


def test_the_context_tells_the_type_before_the_first_act(settled):
    family, knowledge, tasks, _ = settled
    late = tasks[20:]
    opened = [family.acts[task.decisions[0][0].act] for task in late]
    assert opened == [family.acts[int(task.drawn.hidden_type)] for task in late]
    assert np.mean([task.returns[0] for task in late]) > 8
    assert 2 <= len(knowledge.known_types()) <= 4


def test_scratch_cannot_know(settled):
    family, _, tasks, _ = settled
    _, scratch, _ = lived(family, 40, "scratch")
    full = np.array([task.returns[0] for task in tasks[20:]])
    assert (full - np.array([task.returns[0] for task in scratch[20:]])).mean() > 0.3


def test_effects_overrule_a_wrong_expectation(settled):
    """In a context whose usual type has changed, the agent turns to the other door within the task."""
    family, knowledge, _, _ = settled
    drawn, task = family.meet(0, AGENTS["full"])
    other = str(1 - int(drawn.hidden_type))
    drawn = type(drawn)(400, drawn.context, other)
    task = type(task)(drawn)
    # Learns into a copy: the fixture stays.
    copy = Knowledge.empty(family)
    copy.add({f"type/{n}": t.effects for n, t in knowledge.types.items()})
    copy.add({f"sightings/{n}": t.sightings for n, t in knowledge.types.items()})
    copy.add({"causes": knowledge.shared.causes})
    one, _ = live_task(copy, drawn, task, AGENTS["full"], LIVING, "r.400")
    first, last = one.decisions[0][0], one.decisions[-1][0]
    assert (first.act, last.act) == (1 - int(other), int(other))


def test_a_late_type_is_noticed_learnt_and_recognised():
    family = Doors(TaskStream(("0", "1", "2"), n_contexts=1, loyalty=0.0, arrivals={"2": 30}))
    knowledge, before, _ = lived(family, 30)
    assert sum(task.alarm for task in before[5:]) <= 4
    _, (arrival,), _ = lived(family, 1, start=30, knowledge=knowledge)
    assert arrival.alarm
    assert arrival.learnt == "r.30"
    assert arrival.decisions[-1][0].act == 2
    after = [task for task in lived(family, 20, start=31, knowledge=knowledge)[1] if task.drawn.hidden_type == "2"]
    assert after
    assert np.mean([task.decisions[1][0].act == 2 for task in after]) >= 0.8


def test_records_give_the_same_knowledge_in_any_order(settled):
    family, knowledge, _, records = settled
    sums: dict[str, Record] = {}
    for record in reversed(records):
        earlier = sums.get(record.key)
        if earlier is not None:
            slots = np.concatenate([earlier.slots, record.slots])
            values = np.concatenate([earlier.values, record.values])
            unique, place = np.unique(slots, return_inverse=True)
            total = np.zeros(len(unique), np.int64)
            np.add.at(total, place, values)
            record = Record(record.kind, record.key, record.version, record.merge, unique, total, record.about)
        sums[record.key] = record
    again = Knowledge.from_records(family, sums.values())
    assert again.n_tasks == knowledge.n_tasks == 40
    assert sorted(again.types) == sorted(knowledge.types)
    own = np.zeros((family.n_causes, family.n_effects))
    fresh = Knowledge.from_records(family, sums.values()).known_types()
    np.testing.assert_array_equal(again.known_types().laws(own), fresh.laws(own))
    for name, known in knowledge.types.items():
        np.testing.assert_array_equal(again.types[name].effects.counts(range(3)), known.effects.counts(range(3)))


def test_types_of_two_robots_are_joined_when_read():
    family = Doors(TaskStream(("0", "1"), n_contexts=2, loyalty=1.0, zipf=0.0))
    one, _, _ = lived(family, 25, robot="ada")
    two, _, _ = lived(family, 25, robot="bob")
    both = Knowledge.empty(family)
    for knowledge in (one, two):
        both.add({f"type/{name}": known.effects for name, known in knowledge.types.items()})
    assert len(both.types) == len(one.types) + len(two.types)
    assert len(both.known_types()) <= max(len(one.known_types()), len(two.known_types()))
    assert any({"ada", "bob"} <= {m.split(".")[0] for m in t.members} for t in both.known_types().types)


def test_the_explanation_names_belief_act_and_novelty(settled):
    family, _, tasks, _ = settled
    document = task_document(tasks[-1], family, 8.8)
    text = "\n".join(explained(document))
    assert f"→ {family.acts[int(tasks[-1].drawn.hidden_type)]}, as for type " in text
    assert "known types were not ruled out" in text
    assert "the agent knew no type yet" in "\n".join(explained(task_document(tasks[0], family, 8.8)))


def test_types_are_named_by_the_tasks_that_showed_them_first():
    assert type_words("robot.0") == "type 0 of robot"
    assert type_words("ann.0+ann.4+bo.2") == "type 0+4 of ann, 2 of bo"
    assert type_words("big.robot.5-3") == "type 5-3 of big.robot"  # a type that began in episode 3 of the task


def test_spare_time_goes_where_the_type_is_in_doubt():
    family = Doors(TaskStream(("0", "1"), n_contexts=2, loyalty=1.0, zipf=0.0))
    knowledge = lived(family, 30)[0]
    with pytest.raises(InputError, match="live through some first"):
        context_to_practise(Knowledge.empty(family), np.random.default_rng(0))
    drawn = [context_to_practise(knowledge, np.random.default_rng(seed)) for seed in range(60)]
    first, second = curious_contexts(knowledge)
    share = first.interest / (first.interest + second.interest)
    assert abs(drawn.count(first.context) / 60 - share) < 0.2


def test_curiosity_tells_disagreement_from_ignorance():
    mixed = Doors(TaskStream(("0", "1"), n_contexts=1, loyalty=0.0))
    sure = Doors(TaskStream(("0", "1"), n_contexts=1, loyalty=1.0))
    (torn,) = curious_contexts(lived(mixed, 30)[0])
    (clear,) = curious_contexts(lived(sure, 30)[0])
    assert torn.interest > 2 * clear.interest
    assert torn.disagreement > torn.unsure
    assert torn.learnable == torn.unsure * torn.frequency
    types = curious_types(lived(mixed, 30)[0])
    assert all(0 <= one.untried <= 1 for one in types)
    assert [one.untried for one in types] == sorted((one.untried for one in types), reverse=True)


def test_few_tasks_are_a_cause_of_doubt_of_their_own():
    """A context that was met once may have any of the known types; met often, it has its own."""
    family = Doors(TaskStream(("0", "1"), n_contexts=2, loyalty=1.0, zipf=0.0))
    knowledge = lived(family, 30)[0]
    often = min(one.unsure for one in curious_contexts(knowledge))
    kind = knowledge.known_types().types[0].members[0]
    seldom = {kind: 1.0}
    nothing = np.zeros((0, 4), np.bool_)
    knowledge.learn(TaskNews(7, 31, [SpanNews(seldom, [])], np.zeros(0, np.int64), nothing))
    (once,) = [one for one in curious_contexts(knowledge) if one.context == 7]
    assert once.disagreement == 0
    assert once.unsure > 1.5 * often


def test_a_task_in_which_nothing_was_tried_is_no_end_of_the_life():
    family = Doors(TaskStream(("0", "1"), n_contexts=1))
    knowledge = Knowledge.empty(family)
    knowledge.learn(TaskNews(0, 0, (SpanNews({"r.0": 1.0}, []),), np.zeros(0, np.int64), np.zeros((0, 4), bool)))
    assert len(knowledge.known_types()) == 1
    _, (first, *_), _ = lived(family, 30, start=1, knowledge=knowledge)
    assert first.prior.tolist() == [1.0]
    assert not first.alarm
    assert 2 <= len(knowledge.known_types()) <= 3
