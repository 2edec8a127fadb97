"""Lessons in memory: coming back, one prior of all lessons, export, forgetting."""

import pytest

from lifelore.action.demonstrations.demonstrations import demonstrations_from_lines
from lifelore.action.priors.action_prior import ActionPrior
from lifelore.agent.factory_lesson.lesson import FactoryLesson
from lifelore.agent.factory_lesson.lesson_prior import KEY, prior_of
from lifelore.agent.factory_lesson.lesson_records import (
    demonstrations_in,
    export_lesson,
    forget_lesson,
    open_lesson,
    open_new_lesson,
    store_demonstration,
)
from lifelore.core.errors import NotFoundError
from lifelore.memory import Memory, open_memory


@pytest.fixture
def memory(tmp_path):
    with open_memory(tmp_path / "m.db") as memory:
        yield memory


def taught(memory: Memory, tasks: int = 2) -> FactoryLesson:
    """A lesson with stored demonstrations; the last factory has been begun."""
    lesson = open_new_lesson(memory, 1)
    for _ in range(tasks):
        while not lesson.over:
            lesson.act(int(lesson.present.best[lesson.state].argmax()))
        shown = lesson.demonstration()
        assert store_demonstration(memory, lesson, shown)
        assert not store_demonstration(memory, lesson, shown)
        lesson.accept(shown)
        lesson.go_on()
    return lesson


def test_a_lesson_comes_back_as_it_was(memory):
    lesson = taught(memory)
    again = open_lesson(memory, lesson.name)
    assert again.view() == lesson.view()
    assert [one.actions.tolist() for one in again.shown] == [one.actions.tolist() for one in lesson.shown]


def test_lessons_add_up_to_one_prior_and_forgetting_takes_a_share_out(memory):
    first, second = taught(memory), taught(memory)
    assert demonstrations_in(memory) == {"demonstrations": 4, "lessons": 2}

    def stored() -> ActionPrior:
        record = memory.recall("action_prior", KEY, 1)
        assert record is not None
        return ActionPrior.from_record(record, 6)

    own = [prior_of(lesson.shown, lesson.task_of) for lesson in (first, second)]
    both = ActionPrior.merged(own)
    assert (stored().counts(both.contexts) == both.counts(both.contexts)).all()
    assert len(stored()) == len(both)
    assert forget_lesson(memory, first.name) == 3
    assert (stored().counts(both.contexts) == own[1].counts(both.contexts)).all()
    for read in (open_lesson, export_lesson, forget_lesson):
        with pytest.raises(NotFoundError, match="lesson"):
            read(memory, first.name)


def test_an_export_is_read_as_demonstrations(memory):
    lesson = taught(memory)
    read = demonstrations_from_lines(export_lesson(memory, lesson.name).splitlines())
    assert [one.actions.tolist() for one in read] == [one.actions.tolist() for one in lesson.shown]
    assert [one.states.tolist() for one in read] == [one.states.tolist() for one in lesson.shown]
    assert len({one.task for one in read}) == 2


@pytest.mark.parametrize("name", ["", "../x", "nobody", "a/b"])
def test_an_unknown_lesson_is_an_error(memory, name):
    with pytest.raises(NotFoundError, match="lesson"):
        open_lesson(memory, name)
