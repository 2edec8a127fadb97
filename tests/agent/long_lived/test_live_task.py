"""A long-lived agent on three doors: recognises, reuses, notices a new type, and knows the same from records."""

from copy import deepcopy

import numpy as np
import pytest

from lifelore.agent.long_lived.curiosity import context_to_practise, curious_contexts, curious_types
from lifelore.agent.long_lived.explanation import explained, task_document, type_words
from lifelore.agent.long_lived.knowledge import Knowledge, TaskNews
from lifelore.agent.long_lived.live_task import live_task
from lifelore.agent.long_lived.long_life import recalled
from lifelore.agent.long_lived.task_family import AGENTS
from lifelore.core.errors import InputError
from lifelore.domains.task_stream import DrawnTask, TaskStream
from lifelore.memory import open_memory
from tests.agent.long_lived.doors import Doors, DoorTask

FULL = AGENTS["full"]
TWO = Doors(TaskStream(("0", "1"), n_contexts=2, loyalty=1.0, zipf=0.0))
"""Each of two contexts has a type of its own."""


def lived(family, n, agent="full", start=0, knowledge=None, robot="r"):
    knowledge = knowledge or Knowledge.empty(family)
    tasks, records = [], []
    for number in range(start, start + n):
        if not AGENTS[agent].memory:
            knowledge = Knowledge.empty(family)
        drawn, task = family.meet(number, AGENTS[agent])
        one, news = live_task(knowledge, drawn, task, AGENTS[agent], f"{robot}.{number}", n_episodes=4)
        tasks.append(one)
        records.append(knowledge.learn(news))
    return knowledge, tasks, records


@pytest.fixture(scope="module")
def settled():
    """Knowledge, tasks and records of 24 tasks; read only."""
    return lived(TWO, 24)


def test_the_context_tells_the_type_before_the_first_act_and_scratch_cannot_know(settled):
    knowledge, tasks, _ = settled
    late = tasks[12:]
    assert [task.decisions[0][0].act for task in late] == [int(task.drawn.hidden_type) for task in late]
    firsts = np.array([task.returns[0] for task in late])
    assert firsts.mean() > 8
    assert 2 <= len(knowledge.known_types()) <= 4
    scratch = np.array([task.returns[0] for task in lived(TWO, 24, "scratch")[1][12:]])
    assert (firsts - scratch).mean() > 0.3


def test_effects_overrule_a_wrong_expectation(settled):
    """In a context whose usual type has changed, the agent turns to the other door within the task."""
    usual = TWO.meet(0, FULL)[0]
    drawn = DrawnTask(400, usual.context, str(1 - int(usual.hidden_type)))
    one, _ = live_task(settled[0], drawn, DoorTask(drawn), FULL, "r.400", n_episodes=4)
    first, last = one.decisions[0][0], one.decisions[-1][0]
    assert (first.act, last.act) == (int(usual.hidden_type), int(drawn.hidden_type))


def test_a_late_type_is_noticed_learnt_and_recognised():
    family = Doors(TaskStream(("0", "1", "2"), n_contexts=1, loyalty=0.0, arrivals={"2": 20}))
    knowledge, before, _ = lived(family, 20)
    assert sum(task.alarm for task in before[5:]) <= 3
    _, (arrival,), _ = lived(family, 1, start=20, knowledge=knowledge)
    assert (arrival.alarm, arrival.learnt, arrival.decisions[-1][0].act) == (True, "r.20", 2)
    after = [task for task in lived(family, 12, start=21, knowledge=knowledge)[1] if task.drawn.hidden_type == "2"]
    assert after
    assert np.mean([task.decisions[1][0].act == 2 for task in after]) >= 0.75


def test_memory_gives_the_same_knowledge_in_any_order(settled, tmp_path):
    knowledge, _, records = settled
    with open_memory(tmp_path / "m.db") as memory:
        for seq, news in enumerate(reversed(records)):
            memory.contribute("r", news, process="p", seq=seq, task={})
        again = recalled(TWO, memory)
    assert again.n_tasks == knowledge.n_tasks == 24
    assert sorted(again.types) == sorted(knowledge.types)
    own = np.zeros((TWO.n_causes, TWO.n_effects))
    np.testing.assert_array_equal(again.known_types().laws(own), knowledge.known_types().laws(own))
    assert again.known_types().types == knowledge.known_types().types


def test_types_of_two_robots_are_joined_when_read(settled):
    one, two, both = settled[0], lived(TWO, 12, robot="bob")[0], Knowledge.empty(TWO)
    for knowledge in (one, two):
        both.add({f"type/{name}": known.effects for name, known in knowledge.types.items()})
    assert len(both.types) == len(one.types) + len(two.types)
    assert len(both.known_types()) <= max(len(one.known_types()), len(two.known_types()))
    assert any({"r", "bob"} <= {name.split(".")[0] for name in t.members} for t in both.known_types().types)


def test_the_explanation_names_belief_act_and_novelty(settled):
    _, tasks, _ = settled
    text = "\n".join(explained(task_document(tasks[-1], TWO, 8.8)))
    assert f"→ {TWO.acts[int(tasks[-1].drawn.hidden_type)]}, as for type " in text
    assert "known types were not ruled out" in text
    assert "the agent knew no type yet" in "\n".join(explained(task_document(tasks[0], TWO, 8.8)))


def test_types_are_named_by_the_tasks_that_showed_them_first():
    assert type_words("robot.0") == "type 0 of robot"
    assert type_words("ann.0+ann.4+bo.2") == "type 0+4 of ann, 2 of bo"
    assert type_words("big.robot.5") == "type 5 of big.robot"


# ---- curiosity ---------------------------------------------------------------------------------------


def news_of(context, date, belief):
    """A task that showed nothing but how much types were believed at its end."""
    return TaskNews(context, date, belief, [], np.zeros(0, np.int64), np.zeros((0, 4), np.bool_))


def test_spare_time_goes_where_the_type_is_in_doubt(settled):
    knowledge, _, _ = settled
    with pytest.raises(InputError, match="live through some first"):
        context_to_practise(Knowledge.empty(TWO), np.random.default_rng(0))
    drawn = [context_to_practise(knowledge, np.random.default_rng(seed)) for seed in range(60)]
    first, second = curious_contexts(knowledge.type_prior())
    share = first.interest / (first.interest + second.interest)
    assert abs(drawn.count(first.context) / 60 - share) < 0.2


def test_curiosity_tells_disagreement_from_ignorance(settled):
    """A context whose tasks disagree stays in doubt; one that was met once may have any of the known types."""
    knowledge, (one, other, *_) = deepcopy(settled[0]), settled[0].known_types().types
    often = min(found.unsure for found in curious_contexts(knowledge.type_prior()))
    for date in range(24, 44):
        knowledge.learn(news_of(7, date, {(one, other)[date % 2].members[0]: 1.0}))
        knowledge.learn(news_of(8, date, {one.members[0]: 1.0}))
    knowledge.learn(news_of(9, 44, {one.members[0]: 1.0}))
    by_context = {found.context: found for found in curious_contexts(knowledge.type_prior())}
    torn, clear, once = (by_context[context] for context in (7, 8, 9))
    assert torn.interest > 2 * clear.interest
    assert torn.disagreement > torn.unsure
    assert once.disagreement == 0
    assert once.unsure > 1.5 * often
    untried = [found.untried for found in curious_types(knowledge)]
    assert 1 >= untried[0] >= untried[-1] >= 0
    assert untried == sorted(untried, reverse=True)


def test_a_task_in_which_nothing_was_tried_is_no_end_of_the_life():
    knowledge = Knowledge.empty(TWO)
    knowledge.learn(news_of(0, 0, {"r.0": 1.0}))
    assert len(knowledge.known_types()) == 1
    _, (first, *_), _ = lived(TWO, 12, start=1, knowledge=knowledge)
    assert (first.prior.tolist(), first.alarm) == ([1.0], False)
    assert 2 <= len(knowledge.known_types()) <= 3
