"""The lesson of a person: steps against the task's tables, the prior against counts by hand, learning curves."""

import numpy as np
import pytest

from lifelore.action.demonstrations.demonstrations import Demonstration
from lifelore.agent.factory_lesson.lesson import FactoryLesson
from lifelore.agent.factory_lesson.lesson_learners import SELF, SHOWN, WITHOUT, lesson_curves
from lifelore.agent.factory_lesson.lesson_prior import ALPHA0, advice_in, competence_of, prior_of
from lifelore.agent.factory_lesson.lesson_task import lesson_task
from lifelore.core.errors import InputError
from lifelore.domains.factory.contexts import ASSEMBLY_STATION, PROCURE_STATION, terrain
from lifelore.domains.factory.factory import ACTION_NAMES
from lifelore.domains.factory.modified_factory import SIDE


def show_best(lesson: FactoryLesson) -> Demonstration:
    """Demonstrate the present task by an optimal policy."""
    while not lesson.over:
        lesson.act(int(lesson.present.best[lesson.state].argmax()))
    return lesson.demonstration()


def test_an_expert_assembles_all_and_gets_the_optimal_reward():
    lesson = FactoryLesson("ada", 2)
    shown = show_best(lesson)
    assert shown.task == "0"
    assert {item["stage"] for item in lesson.view()["items"]} == {"assembled"}
    # 2 for each move, 10 for each of 4 uses, and 100 at the end.
    moves = int((shown.actions < 4).sum())
    assert lesson.reward == -2 * moves + 10 * 4 + 100
    assert competence_of(shown, lesson.present) == pytest.approx(1.0)
    with pytest.raises(InputError, match="over"):
        lesson.act(0)


def test_the_robot_sees_the_stations_of_other_components_and_so_does_the_person():
    lesson = FactoryLesson("ada", 2)
    view, picture = lesson.view(), terrain(lesson.present.task.factory)
    for kind, sign in (("procure", PROCURE_STATION), ("assemble", ASSEMBLY_STATION)):
        shown = [*view["unused"][kind], *(item[kind] for item in view["items"])]
        assert sorted(shown) == np.argwhere(picture == sign).tolist()


def test_walls_cost_and_do_not_move():
    lesson = FactoryLesson("ada", 1)
    before = lesson.view()["cell"]
    floor = lesson.floor()
    assert (len(floor), len(floor[0])) == (SIDE, SIDE)
    for action, (down, across) in enumerate(((-1, 0), (1, 0), (0, 1), (0, -1))):
        lesson = FactoryLesson("ada", 1)
        lesson.act(action)
        row, column = before[0] + down, before[1] + across
        wall = floor[row][column] == "#"
        view = lesson.view()
        assert view["collision"] is wall
        assert view["cell"] == (before if wall else [row, column])
        assert view["reward"] == (-100 if wall else -2)


@pytest.mark.parametrize("action", [-1, 6, True, "procure", None, 1.0])
def test_a_wrong_action_changes_nothing(action):
    lesson = FactoryLesson("ada", 1)
    with pytest.raises(InputError, match="action"):
        lesson.act(action)
    assert lesson.view()["steps"] == 0


def test_a_task_that_is_not_over_gives_no_demonstration():
    lesson = FactoryLesson("ada", 1)
    lesson.act(0)
    with pytest.raises(InputError, match="not over"):
        lesson.demonstration()
    lesson.go_on()
    assert (lesson.number, lesson.view()["steps"], lesson.shown) == (1, 0, [])
    with pytest.raises(InputError, match="components"):
        FactoryLesson("ada", 5)


def test_factories_differ_and_are_the_same_again():
    first, second = (lesson_task(0, "ada", 1, "shown", number) for number in range(2))
    assert first.task.factory.fingerprint != second.task.factory.fingerprint
    lesson_task.cache_clear()
    assert lesson_task(0, "ada", 1, "shown", 0).task.factory.fingerprint == first.task.factory.fingerprint


def test_the_prior_counts_each_step_by_competence():
    lesson = FactoryLesson("ada", 1)
    shown = show_best(lesson)
    prior = prior_of([shown], lesson.task_of)
    contexts = lesson.present.contexts[shown.states]
    counts = {}
    for context, action in zip(contexts.tolist(), shown.actions.tolist(), strict=True):
        counts.setdefault(context, np.zeros(6))[action] += 1
    assert prior.contexts.tolist() == sorted(counts)
    for context, own in counts.items():
        assert prior.counts([context])[0].tolist() == own.tolist()
    advice, advised = advice_in(prior, lesson.present, int(shown.states[0]))
    own = counts[int(contexts[0])] + ALPHA0
    assert advised
    assert list(advice) == list(ACTION_NAMES)
    assert list(advice.values()) == pytest.approx((own / own.sum()).tolist())
    assert advice_in(prior_of([], lesson.task_of), lesson.present, 0) == (
        dict.fromkeys(ACTION_NAMES, pytest.approx(1 / 6)),
        False,
    )


def test_curves_begin_alike_and_more_episodes_leave_the_first_as_they_are():
    lesson = FactoryLesson("ada", 1)
    shown = [show_best(lesson)]
    short, long = (lesson_curves("ada", 1, 0, shown, n) for n in (5, 15))
    assert list(long["curves"]) == [WITHOUT, SHOWN, SELF]
    for name, curve in long["curves"].items():
        assert len(curve["mean"]) == len(curve["deviation"]) == 15
        assert curve["mean"][:5] == short["curves"][name]["mean"]
    assert list(lesson_curves("ada", 1, 0, [], 5)["curves"]) == [WITHOUT]
    for wrong in (0, 101):
        with pytest.raises(InputError, match="episodes"):
            lesson_curves("ada", 1, 0, shown, wrong)


def test_the_prior_of_an_expert_helps_learners_in_new_factories():
    # Eight factories, fixed seeds: the first ten episodes earn more with the prior in the mean.
    lesson, shown = FactoryLesson("ada", 1), []
    for _ in range(5):
        shown.append(show_best(lesson))
        lesson.accept(shown[-1])
        lesson.go_on()
    curves = lesson_curves("ada", 1, 0, shown, 10)["curves"]
    without, taught, exact = (np.mean(curves[name]["mean"]) for name in (WITHOUT, SHOWN, SELF))
    assert without < 0.8 * taught < 0
    assert taught < exact
