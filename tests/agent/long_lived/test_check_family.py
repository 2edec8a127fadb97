"""The checker names each mistake of a family in one line, and `live_long` names those that it meets."""

import itertools
import re
from dataclasses import replace

import numpy as np
import pytest

from lifelore.agent.long_lived.check_family import MOST_ACTS, check_family
from lifelore.agent.long_lived.families.by_name import family_named
from lifelore.agent.long_lived.long_life import live_long
from lifelore.agent.long_lived.task_family import AgentTask, Plan, Step, TaskFamily
from lifelore.core.errors import InputError
from lifelore.domains.task_stream import TaskStream
from tests.agent.long_lived.doors import Doors, DoorTask

STREAM = TaskStream(("0", "1"))


def family(of_family=None, of_task=None):
    """Doors with other attributes of the family or of its tasks."""
    task_class = type("Task", (DoorTask,), of_task or {})

    def meet(self, number, abilities, context=None):
        drawn = self.stream.draw(number, context)
        return drawn, task_class(drawn)

    return type("Family", (Doors,), {"meet": meet, **(of_family or {})})(STREAM)


def step(**changes):
    """Tasks whose every step has some other part."""
    return None, {"act": lambda self, act: replace(DoorTask.act(self, act), **changes)}


def plan(**changes):
    """Tasks whose plans have other parts, as functions of the number of types."""

    def other(self, laws, *given):
        found = DoorTask.plan(self, laws, *given)
        return replace(found, **{name: part(len(laws)) for name, part in changes.items()})

    return None, {"plan": other}


def meet(change):
    """A family that changes what meeting a task returns."""
    return {"meet": lambda self, *given: change(*Doors.meet(self, *given))}, None


def drawn(**changes):
    return meet(lambda drawn, task: (replace(drawn, **changes), task))


def constant(**attributes):
    return attributes, None


HALF, COUNTER = [0.5, 0.5], itertools.count()
ROWS = "rows of possible must be probabilities with sum 1, got"
MET = {  # by the checker, and in a life
    "name must be a text without '/', got ''": constant(name=""),
    "name must be a text without '/', got 'a/b'": constant(name="a/b"),
    "acts must be a tuple of names, at least one, got ()": constant(acts=()),
    "n_causes must be a whole number from 1, got 0": constant(n_causes=0),
    "n_effects must be a whole number from 1, got 2.0": constant(n_effects=2.0),
    "possible must be an array of shape (3, 2), causes × effects, got (2, 3)": constant(possible=np.eye(2, 3)),
    f"{ROWS} [1.0, 1.0] for cause 0": constant(possible=np.ones((3, 2))),
    f"{ROWS} [-1.0, 2.0] for cause 2": constant(possible=np.array([HALF, HALF, [-1.0, 2.0]])),
    f"{ROWS} [nan, 1.0] for cause 0": constant(possible=np.array([[np.nan, 1.0], HALF, HALF])),
    "groups must be an array of shape (3,), a value a cause, got (2,)": constant(groups=np.arange(2)),
    "groups must be numbers from 0, got -1": constant(groups=np.array([-1, 0, 1])),
    "kinds must hold integer values, got float64": constant(kinds=np.zeros(3)),
    "judges must be an array of shape (3,), a value a cause, got (3,)": constant(judges=[True, True, False]),
    "judges must hold bool values, got int64": constant(judges=np.ones(3, int)),
    "constancy must be finite and above 0, got 0.0": constant(constancy=np.zeros(3)),
    "smoothed counts must be an array of shape (1, 3, 2), that of the counts, got (1, 3)": constant(
        smoothed=lambda _, n: n.sum(axis=2)
    ),
    "meet must return (DrawnTask, task), got None": meet(lambda drawn, task: None),
    "meet must return task 0, got task 1": drawn(number=1),
    "a context must lie in 0..1048575, got -1 in task 0": drawn(context=-1),
    "a context must lie in 0..1048575, got 'kitchen' in task 0": drawn(context="kitchen"),
    "best_return must be a finite number, got nan for task 0": constant(best_return=lambda *given: np.nan),
    "plan must return a Plan, got NoneType": (None, {"plan": lambda *given: None}),
    "values of a plan must be an array of shape (%, %), types × behaviours, got (4, 1)": plan(
        values=lambda n: np.eye(4, 1)
    ),
    "values of a plan must be finite, got infinite %": plan(values=lambda n: np.full((n, n), np.inf)),
    "acts of a plan must be an array of shape (%,), an act a behaviour, got (9,)": plan(
        acts=lambda n: np.zeros(9, int)
    ),
    "acts of a plan must lie in 0..3, got %4%": plan(acts=lambda n: np.full(n, 4)),
    "trying of a plan must lie in 0..3, got %-1%": plan(trying=lambda n: np.full(n, -1)),
    "act must return a Step, got tuple for '%'": (None, {"act": lambda self, act: (0.0, (), True)}),
    "a reward must be a finite number, got nan for act '%'": step(reward=float("nan")),
    "a reward must be a finite number, got None for act '%'": step(reward=None),
    "cause must lie in 0..2 (n_causes = 3), got 3 for act '%'": step(effects=((3, 0),)),
    "effect must lie in 0..1 (n_effects = 2), got -1 for act '%'": step(effects=((0, -1),)),
    "effect must lie in 0..1 (n_effects = 2), got 'prize' for act '%'": step(effects=((0, "prize"),)),
    "effects must be pairs (cause, effect), got (0,) for act '%'": step(effects=((0,),)),
}
PLAYED = {  # by the checker alone: they cost time
    "task 0 must be the same task each time, got %": meet(
        lambda drawn, task: (replace(drawn, hidden_type=str(next(COUNTER))), task)
    ),
    f"episode 0 of task 0 must end, got {MOST_ACTS} acts without an end; let the last Step have ended": (
        None,
        {"act": lambda self, act: Step(0.0, (), False)},
    ),
    "describe must return a text, got 3": (None, {"describe": lambda self: 3}),
    "best_acts must be an array of shape (1, 4), contexts × acts, got (1, 3)": (
        None,
        {"best_acts": lambda *given: (np.array([0]), np.ones((1, 3), bool))},
    ),
}


@pytest.mark.parametrize("message", [*MET, *PLAYED])
def test_mistakes_are_named(message):
    """In a message % stands for anything."""
    pattern = "family '.*': " + ".*".join(re.escape(part) for part in message.split("%"))
    wrong = family(*(MET | PLAYED)[message])
    for refuse in (check_family, live_long) if message in MET else (check_family,):
        with pytest.raises(InputError) as refused:
            refuse(wrong, tasks=2)
        assert re.fullmatch(pattern, str(refused.value)), refused.value


def test_the_values_of_a_plan_may_be_lists():
    listed = family(*plan(values=lambda n: np.eye(n).tolist()))
    check_family(listed)
    assert live_long(listed, tasks=2)["tasks"]


@pytest.mark.parametrize("name", ["factory-customers", "building-days"])
def test_our_families_pass(name):
    check_family(family_named(name, 0))


def test_what_is_missing_is_named():
    with pytest.raises(InputError, match="family must derive from TaskFamily, got Stranger"):
        check_family(type("Stranger", (), {})())  # type: ignore[arg-type]
    nameless = type("Nameless", (Doors,), {})(STREAM)
    with pytest.MonkeyPatch.context() as patch:
        patch.delattr(Doors, "n_effects")
        with pytest.raises(InputError, match="family Nameless must have an attribute n_effects"):
            check_family(nameless)
    with pytest.raises(TypeError, match="best_return"):
        type("Half", (Doors,), {"best_return": TaskFamily.best_return})(STREAM)


def test_a_late_mistake_is_found_in_the_task_that_has_it():
    """A context that is wrong in task 5 alone: three tasks do not show it, six do."""
    late = family(*meet(lambda drawn, task: (replace(drawn, context=-(drawn.number == 5)), task)))
    check_family(late)
    with pytest.raises(InputError, match="got -1 in task 5"):
        check_family(late, tasks=6)


def test_defaults_by_hand():
    bare = family({name: getattr(TaskFamily, name) for name in ("cause_name", "effect_name")})
    assert bare.possible.tolist() == [HALF] * 3
    assert (bare.groups.tolist(), bare.kinds.tolist(), bare.judges.tolist()) == ([0, 1, 2], [0] * 3, [True] * 3)
    assert bare.constancy.tolist() == [*HALF, 0.5]
    counts = np.arange(6.0).reshape(1, 3, 2)
    assert bare.smoothed(counts) is counts
    assert (bare.domain, bare.cause_name(2), bare.effect_name(2, 1)) == ("doors", "cause 2", "effect 1")
    assert type("Three", (type(bare),), {"acts": ("a", "b", "c")})(STREAM).cause_name(2) == "c"


def test_a_task_has_defaults_too():
    class Short(AgentTask):
        def begin(self):
            self.tries = 0

        def act(self, act):
            self.tries += 1
            return Step(0.0, (), self.tries == 2)

        def plan(self, laws, tried, new, shared):
            acts = np.zeros(len(laws), np.int64)
            return Plan(np.zeros((len(laws), len(laws))), acts, acts)

    short = family(*meet(lambda drawn, task: (drawn, Short())))
    check_family(short)
    assert (Short().context, Short().describe()) == (0, "")
    assert len(live_long(short, tasks=2)["tasks"]) == 2
