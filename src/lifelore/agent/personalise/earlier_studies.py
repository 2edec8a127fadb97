"""Studies that an earlier Lifelore kept as lore: they become rows the first time that they are opened.

    reuse_study/NAME            the library's file, eight bytes in a value; about: settings
    reuse_user/NAME/KEY         slots NUMBER · 8 + field: decisions and outcomes of a user
    reuse_available/NAME/KEY    slots NUMBER · 2^16 + i: hashes of the policies that were available
    reuse_past/NAME[/BUCKET]    compressed JSON of users' outcomes in logs
    reuse_panel/NAME/BATCH      compressed columns of a batch of decisions or outcomes

Names of users in logs and batches were not stored, only their `user_key`: such a user is a row of the name
``earlier KEY`` until the user comes. Old identifiers of decisions stay valid. The old records are then forgotten.
"""

import hashlib
import json
import re
import zlib
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from lifelore.agent.personalise.identifiers import parse_identifier
from lifelore.agent.personalise.past import Line, identities
from lifelore.agent.personalise.study import ACTIVE, Study, earlier_name, study_of
from lifelore.core.errors import StoreError
from lifelore.core.protocols import Record
from lifelore.memory import Memory
from lifelore.memory.byte_words import bytes_of
from lifelore.memory.studies import StudyVersion
from lifelore.memory.study_rows import DecisionRow, PastRow, StudyRows

STUDY, USER, AVAILABLE, PAST, PANEL, VERSION = (
    "reuse_study", "reuse_user", "reuse_available", "reuse_past", "reuse_panel", 1
)  # fmt: skip
_FIELDS, _WIDTH = 8, 1 << 16
_POLICY, _PROBABILITY, _CONTROL, _CHOSEN, _ATTEMPT, _OUTCOME, _ENDED = range(7)
_COLUMNS: dict[str, tuple[tuple[str, str], ...]] = {
    "decisions": (("number", "<i4"), ("probability", "<f4"), ("policy", "<u2"), ("control", "u1")),
    "outcomes": (("outcome", "<f8"), ("place", "<u4")),
}
People = dict[str, dict[str, Any]]
"""By key: name, context, features, type, fitted, past lines and decisions of a user."""


def earlier_studies(memory: Memory) -> list[str]:
    """Names of the studies that are still lore, sorted."""
    return sorted(key for key, version, _ in memory.keys(STUDY) if version == VERSION)


def take_earlier(memory: Memory, name: str) -> bool:
    """Turn the study of that name from lore into rows, in one transaction; whether there was one."""
    record = memory.recall(STUDY, name, VERSION)
    if record is None:
        return False
    with memory.together():
        study = _study(name, record).keep(memory)
        people: People = {}
        try:
            _read_users(memory, study, people)
            _read_past(memory, study, people)
            _read_panel(memory, study, people)
        except (zlib.error, ValueError, LookupError) as error:
            what = f"study '{name}' of an earlier Lifelore"
            raise StoreError(f"{what} is damaged ({error}); restore an export") from None
        with memory.studies.writing(study.number) as rows:
            _store(rows, study, people)
        memory.forget_all([robot for robot in memory.robots() if _wrote(robot, name)])
    return True


def _wrote(robot: str, study: str) -> bool:
    """Whether the contributor is one of the study, and not of another one whose name begins like its own."""
    return re.fullmatch(rf"reuse {re.escape(study)}(: ([0-9a-f]{{16}}|past \d+|panel))?", robot) is not None


def _study(name: str, record: Record) -> Study:
    about = {"models": "plug-in", "rule_settings": {}, "feature_prior": None, **record.about, "earlier": True}
    return study_of(name, StudyVersion(0, ACTIVE, 0, about, bytes_of(record.values, about["bytes"])))


def _person(people: People, key: str) -> dict[str, Any]:
    fresh = {"name": earlier_name(key), "context": None, "features": None, "type": None, "fitted": False}
    return people.setdefault(key, fresh | {"past": [], "decisions": []})


def _read_users(memory: Memory, study: Study, people: People) -> None:
    names = {_policy_number(policy): policy for policy in study.states}
    for key, record in _records(memory, USER, study.name):
        own, about = _person(people, key), record.about
        own |= {"name": about["user"], "context": about.get("context"), "features": about.get("features")}
        cells = dict(zip(record.slots.tolist(), record.values.tolist(), strict=True))
        among = memory.recall(AVAILABLE, f"{study.name}/{key}", VERSION)
        available: dict[int, list[str]] = {}
        if among is not None:
            for slot, value in zip(among.slots.tolist(), among.values.tolist(), strict=True):
                available.setdefault(slot // _WIDTH, []).append(names.get(value, ""))
        for number in sorted({slot // _FIELDS for slot in cells}):
            stored = [cells.get(_FIELDS * number + field) for field in range(7)]
            if (policy := stored[_POLICY]) is None:
                continue
            attempt = stored[_ATTEMPT] or 0
            text = f"{key}-{number}" + (f".{attempt}" if attempt else "")
            # Whole seconds were stored; decisions and outcomes of a second come in the order of the decisions.
            decision = DecisionRow(
                parse_identifier(text), 0, names.get(policy, ""), _number(stored[_PROBABILITY]),
                bool(stored[_CONTROL]), study.version, 1000 * (stored[_CHOSEN] or 0) + number, own["context"],
            )  # fmt: skip
            if number in available:
                decision = decision._replace(available=tuple(available[number]))
            if (outcome := stored[_OUTCOME]) is not None:
                ended = 1000 * (stored[_ENDED] or 0) + number
                decision = decision._replace(outcome=_number(outcome), ended=ended)
            own["decisions"].append(decision)


def _read_past(memory: Memory, study: Study, people: People) -> None:
    index = memory.recall(PAST, study.name, VERSION)
    if index is None:
        return
    fitted = {int(number) for number, file in index.about["files"].items() if file[4] == "fit"}
    for bucket in range(index.about["buckets"]):
        record = memory.recall(PAST, f"{study.name}/{bucket:04d}", VERSION)
        if record is None:
            raise ValueError("outcomes in logs are missing")
        document = json.loads(zlib.decompress(bytes_of(record.values, record.about["bytes"])))
        policies = document["policies"]
        for key, (type_, context, files, *features) in document["users"].items():
            own = _person(people, key)
            own["type"], own["context"] = type_, own["context"] or context
            own["features"] = own["features"] or (features[0] if features else None)
            for number, places, values in files:
                by_fit = number in fitted
                own["fitted"] |= by_fit
                names = [policies[place] for place in places]
                own["past"] += [(*pair, by_fit) for pair in zip(names, values, strict=True)]


def _read_panel(memory: Memory, study: Study, people: People) -> None:
    """Batches in the order in which they were stored."""
    start, keys = f"{study.name}/", dict[str, Any]()
    batches: dict[str, list[tuple[str, int]]] = {}
    named = [(about["order"], key, about) for key, _, about in memory.keys(PANEL) if key.startswith(start)]
    for order, key, about in sorted(named, key=lambda one: one[:2]):
        record, name = memory.recall(PANEL, key, VERSION), key.removeprefix(start)
        columns = _batch(b"" if record is None else bytes_of(record.values, about["bytes"]), about)
        time = order // 10**6
        if about["kind"] == "decisions":
            run = name.partition(".")[0]
            known = keys.setdefault(run, np.empty(0, np.uint64))
            keys[run] = np.concatenate([known, columns["keys"]])
            batches[name] = []
            users = [f"{one:016x}" for one in keys[run][np.cumsum(columns["number"])].tolist()]
            told = (columns[one].tolist() for one in ("policy", "probability", "control"))
            for place, (user, policy, probability, control) in enumerate(zip(users, *told, strict=True)):
                own = _person(people, user)["decisions"]
                batches[name].append((user, len(own)))
                id_, named = parse_identifier(f"{name}/{place}"), about["policies"][policy]
                own.append(DecisionRow(id_, 0, named, probability, bool(control), study.version, time))
            continue
        for place, outcome in zip(columns["place"].tolist(), columns["outcome"].tolist(), strict=True):
            user, number = batches[about["batch"]][place]
            own = people[user]["decisions"]
            own[number] = own[number]._replace(outcome=outcome, ended=time)


def _batch(content: bytes, about: Mapping[str, Any]) -> dict[str, Any]:
    content = zlib.decompress(content)
    n, at = about["length"], 8 * about.get("new", 0)
    columns = {"keys": np.frombuffer(content, "<u8", about.get("new", 0)).astype(np.uint64)}
    for column, dtype in _COLUMNS[about["kind"]]:
        columns[column] = np.frombuffer(content, dtype, n, at)
        at += n * np.dtype(dtype).itemsize
    return columns


def _store(rows: StudyRows, study: Study, people: People) -> None:
    users = rows.add_users([(own["name"], own["context"], own["features"]) for own in people.values()], 0)
    numbers = {key: users[own["name"]].number for key, own in people.items()}
    rows.describe(
        (numbers[key], own["context"], own["features"], own["type"]) for key, own in people.items() if own["type"]
    )
    rows.mark_fitted(numbers[key] for key, own in people.items() if own["fitted"])
    past = [
        (numbers[key], Line(own["name"], policy, value), by_fit)
        for key, own in people.items()
        for policy, value, by_fit in own["past"]
    ]
    ids = identities(study.name, [line for _, line, _ in past])
    rows.add_past(
        PastRow(id_, number, line.policy, line.outcome, place, by_fit)
        for place, (id_, (number, line, by_fit)) in enumerate(zip(ids, past, strict=True))
    )
    decisions = [
        decision._replace(person=numbers[key]) for key, own in people.items() for decision in own["decisions"]
    ]
    rows.add_decisions(decisions)
    rows.end_decisions((one.id, one.outcome, one.ended or 0) for one in decisions if one.outcome is not None)
    sums: dict[int, list[Any]] = {}
    for one in decisions:
        if one.outcome is not None:
            own, place = sums.setdefault(one.person, [0, 0.0, 0, 0.0]), 2 * one.control
            own[place] += 1
            own[place + 1] += one.outcome
    rows.learn(((number, None, *own) for number, own in sums.items()), 0)


def _records(memory: Memory, kind: str, study: str) -> Iterator[tuple[str, Record]]:
    start = f"{study}/"
    for key, _, _ in memory.keys(kind):
        record = memory.recall(kind, key, VERSION) if key.startswith(start) else None
        if record is not None and record.slots.size:
            yield key.removeprefix(start), record


def _policy_number(policy: str) -> int:
    return int.from_bytes(hashlib.sha256(policy.encode()).digest()[:7], "big")


def _number(bits: int | None) -> float:
    return float(np.int64(bits or 0).view(np.float64))
