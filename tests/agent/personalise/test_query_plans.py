"""No statement of a choice or its outcome reads a whole table: the time does not grow with the memory."""

import re
from dataclasses import replace

import pytest

from lifelore.agent.personalise.decisions import Request, choose, decide, forget, observe, update
from lifelore.agent.personalise.explanation import explain
from lifelore.agent.personalise.study import Study
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.memory import open_memory
from lifelore.memory.connection import Connection

WHOLE_TABLE = re.compile(r"\bSCAN lifelore_\w+|\(study=\?\)")
"""Reads all rows of a table, or all of the study."""
MANY = 40
"""Users of a batch: SQLite takes another plan for many values than for a few."""


@pytest.fixture
def asked(monkeypatch):
    """Statements with their parameters, as they are run."""
    found: list[tuple[str, object]] = []
    run = Connection.execute

    def noted(self, sql, parameters=()):
        found.append((sql, parameters))
        return run(self, sql, parameters)

    run_many = Connection.execute_many

    def noted_many(self, sql, rows):
        found.extend((sql, row) for row in rows[:1])
        return run_many(self, sql, rows)

    monkeypatch.setattr(Connection, "execute", noted)
    monkeypatch.setattr(Connection, "execute_many", noted_many)
    return found


def test_a_choice_and_its_outcome_read_no_whole_table(tmp_path, asked):
    library = PolicyLibrary.from_means([[8.0, 1.0], [1.0, 8.0]], 2.0)
    study = Study("s", library, dict.fromkeys(library.policies, "active"), rule="sampling")
    with open_memory(tmp_path / "m.db") as memory:
        study = study.keep(memory)
        choose(memory, study, "gone")
        forget(memory, study, "gone")
        asked.clear()
        for outcome in range(2):
            update(memory, study, choose(memory, study, "ann", request=str(outcome))["decision"], float(outcome))
        for version in (study, replace(study, explore=0.5).keep(memory)):
            users = [Request(f"user {number}", request="first") for number in range(MANY)]
            made = decide(memory, version, users)
            observe(memory, version, [(one["decision"], 1.0) for one in made])
            users = [Request(f"user {number}", context="DE") for number in range(MANY)]
            decide(memory, version, users)
        explain(memory, version, "user 1")
        forget(memory, version, "user 1")
        statements = list(asked)
        with memory._store.pool.connection() as conn:
            plans = {
                sql: [row[3] for row in conn.execute(f"EXPLAIN QUERY PLAN {sql}", parameters).fetchall()]
                for sql, parameters in statements
                if "lifelore_stud" in sql or "lifelore_decisions" in sql
            }
    assert len(plans) >= 7
    assert {sql: plan for sql, plan in plans.items() if WHOLE_TABLE.search(" ".join(plan))} == {}
