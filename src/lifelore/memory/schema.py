"""Tables of a memory, created by numbered migrations; a migration and its note are one transaction.

Contributions, tombstones and forgotten records hold the content; lore, mentions and cells are a cache of them.
Leases say which process is at work on which task.
"""

import time

from lifelore.core.errors import StoreError
from lifelore.memory.connection import Connection

APPLICATION_ID = 0x4C4F5245  # "LORE"

_NOTES = """
CREATE TABLE IF NOT EXISTS lifelore_migrations (
    number {int} PRIMARY KEY, name {text} NOT NULL, applied {int} NOT NULL)
"""

_LORE = """
CREATE TABLE lifelore_contributions (
    number {serial},
    robot {text} NOT NULL, process {text} NOT NULL, seq {int} NOT NULL, stamp {int} NOT NULL,
    task {text} NOT NULL, blob {blob} NOT NULL, digest {text} NOT NULL, lore {int},
    UNIQUE (robot, process, seq));
CREATE INDEX lifelore_contributions_stamp ON lifelore_contributions (stamp);
CREATE INDEX lifelore_contributions_lore ON lifelore_contributions (lore, stamp);
CREATE TABLE lifelore_tombstones (
    robot {text} NOT NULL, process {text} NOT NULL, seq {int} NOT NULL,
    PRIMARY KEY (robot, process, seq));
CREATE TABLE lifelore_forgotten_records (
    kind {text} NOT NULL, key {text} NOT NULL, version {int} NOT NULL, stamp {int} NOT NULL,
    PRIMARY KEY (kind, key, version));
CREATE INDEX lifelore_forgotten_records_stamp ON lifelore_forgotten_records (stamp);
CREATE TABLE lifelore_lore (
    number {serial},
    kind {text} NOT NULL, key {text} NOT NULL, version {int} NOT NULL,
    merge {text} NOT NULL, about {text} NOT NULL, origin {int} NOT NULL,
    UNIQUE (kind, key, version));
CREATE TABLE lifelore_mentions (
    contribution {int} NOT NULL, lore {int} NOT NULL,
    PRIMARY KEY (contribution, lore));
CREATE INDEX lifelore_mentions_lore ON lifelore_mentions (lore);
CREATE TABLE lifelore_cells (
    lore {int} NOT NULL, slot {int} NOT NULL, value {int} NOT NULL{whole}, origin {int} NOT NULL, state {blob},
    PRIMARY KEY (lore, slot)){clustered};
CREATE TABLE lifelore_leases (
    robot {text} NOT NULL, number {int} NOT NULL, process {text} NOT NULL, holder {text} NOT NULL,
    until {int} NOT NULL, PRIMARY KEY (robot, number))
"""

_STUDIES = """
CREATE TABLE lifelore_studies (
    number {serial}, name {text} NOT NULL UNIQUE, state {text} NOT NULL, version {int} NOT NULL,
    revision {int} NOT NULL);
CREATE TABLE lifelore_study_versions (
    study {int} NOT NULL, version {int} NOT NULL, created {int} NOT NULL, about {text} NOT NULL,
    content {blob} NOT NULL, PRIMARY KEY (study, version));
CREATE TABLE lifelore_study_users (
    number {serial}, study {int} NOT NULL, name {text} NOT NULL, context {text}, features {text}, type {text},
    fitted {int} NOT NULL, version {int} NOT NULL, state {blob},
    personal {int} NOT NULL, personal_sum {real} NOT NULL, control {int} NOT NULL, control_sum {real} NOT NULL,
    UNIQUE (study, name));
CREATE TABLE lifelore_study_past (
    study {int} NOT NULL, id {blob} NOT NULL, person {int} NOT NULL, policy {text} NOT NULL,
    outcome {real} NOT NULL, time {int} NOT NULL, fitted {int} NOT NULL, PRIMARY KEY (study, id)){clustered};
CREATE INDEX lifelore_study_past_person ON lifelore_study_past (person);
CREATE TABLE lifelore_decisions (
    study {int} NOT NULL, id {blob} NOT NULL, person {int} NOT NULL, policy {text} NOT NULL,
    probability {real} NOT NULL, control {int} NOT NULL, version {int} NOT NULL, context {text}, available {text},
    request {text}, time {int} NOT NULL, outcome {real}, ended {int},
    PRIMARY KEY (study, id)){clustered};
CREATE INDEX lifelore_decisions_person ON lifelore_decisions (person);
CREATE UNIQUE INDEX lifelore_decisions_request ON lifelore_decisions (person, request)
    WHERE request IS NOT NULL;
CREATE INDEX lifelore_decisions_control ON lifelore_decisions (study, policy, person, outcome, control)
    WHERE control = 1
"""

_NO_STATES = """
DELETE FROM lifelore_cells WHERE lore < 0;
ALTER TABLE lifelore_cells DROP COLUMN state
"""

_MENTIONED = """
INSERT INTO lifelore_mentions (contribution, lore)
    SELECT number, lore FROM lifelore_contributions WHERE lore IS NOT NULL;
DROP INDEX lifelore_contributions_lore;
ALTER TABLE lifelore_contributions DROP COLUMN lore
"""

_TURNS = """
ALTER TABLE lifelore_decisions ADD COLUMN turn {int};
DROP INDEX lifelore_decisions_person;
CREATE INDEX lifelore_decisions_person ON lifelore_decisions (person, turn)
"""

MIGRATIONS = {
    6: ("contributions, tombstones, forgotten records, cache and leases", _LORE),
    7: ("studies: library versions, users, their past, decisions with outcomes", _STUDIES),
    8: ("no states beside the cells, which only users of studies had", _NO_STATES),
    9: ("no key of a contribution beside it, which only users of studies needed", _MENTIONED),
    10: ("number of a decision among those of its user, which are not counted any more", _TURNS),
}
OLDEST, LATEST = min(MIGRATIONS), max(MIGRATIONS)
READABLE = 9
"""Oldest schema that is read as it is: later steps concern what is written alone."""

_HAS_NOTES = {
    True: "SELECT MAX(name) FROM sqlite_master WHERE name = 'lifelore_migrations'",
    False: "SELECT to_regclass('lifelore_migrations')",
}
"""By `Connection.is_sqlite`: NULL where no migration has run."""

# SQLite turns an overflowing sum into a float; the CHECK makes this an error, as it is in PostgreSQL.
# PostgreSQL must compare names byte by byte, as SQLite and Python do, so that the order is the same.
_WORDS = {
    "sqlite": {
        "int": "INTEGER", "text": "TEXT", "blob": "BLOB", "real": "REAL",
        "serial": "INTEGER PRIMARY KEY AUTOINCREMENT",
        "whole": " CHECK (typeof(value) = 'integer')", "clustered": " WITHOUT ROWID",
    },
    "postgresql": {
        "int": "BIGINT", "text": 'TEXT COLLATE "C"', "blob": "BYTEA", "real": "DOUBLE PRECISION",
        "serial": "BIGINT GENERATED ALWAYS AS IDENTITY PRIMARY KEY", "whole": "", "clustered": "",
    },
}  # fmt: skip


def version(conn: Connection) -> int:
    """The number of the last migration; 0 for an empty database."""
    if conn.value(_HAS_NOTES[conn.is_sqlite]) is None:
        return 0
    return int(conn.value("SELECT COALESCE(MAX(number), 0) FROM lifelore_migrations"))


def refuse_unknown(location: str, found: int) -> None:
    """Raise StoreError if a newer Lifelore made the memory, or one so old that no migration leads on from it."""
    if found > LATEST:
        raise StoreError(
            f"memory {location} was made by a newer Lifelore (schema {found}, this one knows {LATEST});"
            " nothing was changed: upgrade lifelore, or name another memory"
        )
    if 0 < found < OLDEST:
        raise StoreError(
            f"memory {location} was made by an early Lifelore (schema {found}, this one reads {OLDEST} and later);"
            " nothing was changed: name another memory"
        )


def take_step(conn: Connection, number: int) -> None:
    """Run migration `number` and note it, in the caller's transaction; do nothing if it was run before."""
    words = _WORDS["sqlite" if conn.is_sqlite else "postgresql"]
    conn.execute(_NOTES.format(**words))
    if version(conn) >= number:
        return
    if conn.is_sqlite:
        conn.execute(f"PRAGMA application_id = {APPLICATION_ID}")
    name, statements = MIGRATIONS[number]
    for statement in statements.format(**words).split(";"):
        conn.execute(statement)
    note = "INSERT INTO lifelore_migrations (number, name, applied) VALUES (?, ?, ?)"
    conn.execute(note, (number, name, time.time_ns()))
