"""Several programs at one memory: each outcome counts once, sums and beliefs are those of one program alone."""

import random
import signal
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from contextlib import ExitStack

import pytest

from lifelore.agent.personalise.decisions import Request, choose, decide, forget, observe, update
from lifelore.agent.personalise.past import Line, add_lines
from lifelore.agent.personalise.study import open_study
from lifelore.core.errors import LifeloreError, NotFoundError
from lifelore.memory import open_memory
from lifelore.memory.study_rows import StudyRows

from .studies import study_of, twin

USERS = [f"user {i}" for i in range(12)]


@pytest.fixture
def memories(where):
    """Three programs' own openings of one memory with a study."""
    with ExitStack() as stack:
        opened = [stack.enter_context(open_memory(where)) for _ in range(3)]
        study_of(control=0.3, change=0.1).keep(opened[0])
        yield opened


def side_by_side(memories, work, n):
    """`work(memory, number)` for numbers below n, in a thread for each memory."""

    def own(place):
        return [work(memories[place], number) for number in range(place, n, len(memories))]

    with ThreadPoolExecutor(len(memories)) as pool:
        return [one for part in pool.map(own, range(len(memories))) for one in part]


def assert_beliefs_are_replays(memory, study):
    """Sums of users are those of their decisions, and stored beliefs those of the slow twin."""
    with memory.studies.reading(study.number) as rows:
        users = rows.users(USERS)
        decisions = rows.decisions_of([user.number for user in users.values()])
        past = rows.past_of([user.number for user in users.values()])
    with memory.studies.totals(study.number) as totals:
        sums = totals.by_user()
    ended = [one for own in decisions.values() for one in own if one.outcome is not None]
    for control, number, total in (
        (False, sums.personal, sums.personal_sum),
        (True, sums.control, sums.control_sum),
    ):
        own = [one.outcome for one in ended if one.control == control]
        assert (number.sum(), total.sum()) == (len(own), pytest.approx(sum(own)))
    for name, user in users.items():
        own = [one for one in decisions.get(user.number, []) if one.outcome is not None]
        own.sort(key=lambda one: (one.ended, one.id))
        shown = [*past.get(user.number, []), *((one.policy, one.outcome) for one in own)]
        belief = list(choose(memory, study, name)["belief"].values())
        assert belief == pytest.approx(twin(study, shown).belief.tolist(), abs=1e-9), name
    return len(ended)


def test_decisions_and_outcomes_of_the_same_users(memories, clock):
    study = open_study(memories[0], "s")

    def live(memory, number):
        own = random.Random(number).sample(USERS, 4)
        made = decide(memory, study, [Request(user) for user in own])
        return observe(memory, study, [(one["decision"], float(number % 9)) for one in made])

    answers = [one for batch in side_by_side(memories, live, 30) for one in batch]
    assert all(one["taken"] for one in answers)
    assert assert_beliefs_are_replays(memories[0], study) == 120


def test_an_outcome_that_all_programs_send_counts_once(memories):
    study = open_study(memories[0], "s")
    made = decide(memories[0], study, [Request(user) for user in USERS * 3])
    # Outcomes of the same decisions in another order from each program.
    pairs = [(one["decision"], float(place % 7)) for place, one in enumerate(made)]

    def send(memory, number):
        return observe(memory, study, random.Random(number).sample(pairs, len(pairs)), brief=True)

    answers = [one for batch in side_by_side(memories, send, 6) for one in batch]
    assert sum(one["taken"] for one in answers) == len(pairs)
    with memories[0].studies.totals(study.number) as totals:
        sums = totals.by_user()
    assert sums.personal_sum.sum() + sums.control_sum.sum() == sum(outcome for _, outcome in pairs)


def test_the_same_request_is_one_decision(memories):
    study = open_study(memories[0], "s")

    def ask(memory, number):
        return choose(memory, study, "ann", request=f"r{number // 3}")

    answers = side_by_side(memories, ask, 60)
    assert len({one["decision"] for one in answers}) == 20
    assert sum(not one["repeated"] for one in answers) == 20


def test_a_request_that_another_program_answers_at_the_same_moment_is_a_repetition(new_place, monkeypatch):
    """A server runs both transactions; SQLite has one after the other."""
    place = new_place("postgresql")
    with open_memory(place) as memory, open_memory(place) as other:
        study = study_of().keep(memory)
        choose(memory, study, "ann")
        requested, answers = StudyRows.requested, []

        def late(rows, pairs):
            found = requested(rows, pairs)
            if not answers:
                answers.append(None)
                answers[0] = choose(other, study, "ann", request="r")
            return found

        monkeypatch.setattr(StudyRows, "requested", late)
        made = choose(memory, study, "ann", request="r")
        assert (made["repeated"], answers[0]["repeated"]) == (True, False)
        assert made["decision"] == answers[0]["decision"]


def test_batches_in_opposite_orders_after_a_new_version(memories):
    """Each batch stores the beliefs of all users anew; locks in different orders would block each other."""
    study = open_study(memories[0], "s")
    made = decide(memories[0], study, [Request(user) for user in USERS])
    observe(memories[0], study, [(one["decision"], 3.0) for one in made])

    def both(memory, number):
        order = USERS if number % 2 else USERS[::-1]
        study_of(control=0.3, change=0.1, explore=0.001 * number).keep(memory)
        return decide(memory, open_study(memory, "s"), [Request(user, context=f"c{number}") for user in order])

    answers = [one for batch in side_by_side(memories, both, 18) for one in batch]
    assert not [one for one in answers if isinstance(one, LifeloreError)]
    assert_beliefs_are_replays(memories[0], open_study(memories[0], "s"))


def test_lines_of_the_past_that_come_during_decisions_are_learnt(memories, clock):
    study = open_study(memories[0], "s")

    def live(memory, number):
        user = USERS[number % 4]
        if number % 3 == 0:
            return add_lines(memory, study, [Line(user, "big", 2.0, given=f"line {number}")])["rows"]
        study_of(control=0.3, change=0.1, explore=0.001 * number).keep(memory)
        now = open_study(memory, "s")
        return update(memory, now, choose(memory, now, user)["decision"], 5.0)["taken"]

    assert all(side_by_side(memories, live, 36))
    assert assert_beliefs_are_replays(memories[0], open_study(memories[0], "s")) == 24


def test_forgetting_during_decisions_leaves_a_whole_user_or_none(memories):
    study = open_study(memories[0], "s")

    def live(memory, number):
        try:
            if number % 3 == 0:
                return forget(memory, study, "ann")
            made = choose(memory, study, "ann")
            return update(memory, study, made["decision"], 1.0)
        except NotFoundError as error:
            return error

    side_by_side(memories, live, 60)
    with memories[0].studies.reading(study.number) as rows:
        known = rows.users(["ann"])
        own = rows.decisions_of([user.number for user in known.values()])
    with memories[0].studies.totals(study.number) as totals:
        n, _ = totals.n_decisions()
        assert n == sum(map(len, own.values()))
        assert totals.n_users() == len(known)
        sums = totals.by_user()
        assert sums.personal.sum() + sums.control.sum() == n - sum(
            one.outcome is None for part in own.values() for one in part
        )
    assert forget(memories[0], study, "ann") == n if known else True


LIFE = """
import sys
from lifelore.agent.personalise.decisions import choose, update
from lifelore.agent.personalise.study import open_study
from lifelore.memory import open_memory
with open_memory(sys.argv[1]) as memory:
    study = open_study(memory, "s")
    for number in range(10**6):
        made = choose(memory, study, f"user {number % 12}")
        print("chosen", made["decision"], flush=True)
        update(memory, study, made["decision"], float(number % 9))
        print("ended", made["decision"], flush=True)
"""


@pytest.mark.slow
def test_processes_killed_in_between_lose_nothing_they_told(where):
    with open_memory(where) as memory:
        study = study_of(control=0.3, change=0.1).keep(memory)
        command = [sys.executable, "-c", LIFE, where]
        running = [subprocess.Popen(command, stdout=subprocess.PIPE, text=True) for _ in range(2)]
        told = [process.stdout.readline().split() for _ in range(25) for process in running]
        for process in running:
            process.send_signal(signal.SIGKILL)
        for process in running:
            told += [line.split() for line in process.stdout.read().splitlines() if len(line.split()) == 2]
            process.wait()
            process.stdout.close()
        with memory.studies.reading(study.number) as rows:
            users = rows.users(USERS)
            own = rows.decisions_of([user.number for user in users.values()])
        there = {str(one.id.hex()): one.outcome for part in own.values() for one in part}
        for what, decision in told:
            outcome = there[decision.replace("-", "")]
            assert what == "chosen" or outcome is not None
        assert_beliefs_are_replays(memory, study)
