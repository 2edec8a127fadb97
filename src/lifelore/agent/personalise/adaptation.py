"""Interface adaptation (BEAT) for users in memory: choose an action set for the next step, learn from moves.

    adapt_library/NAME        the library's file, eight bytes in a value; about: id, bytes, epsilon
    adapt_user/NAME/USER      slots: step, episode, surprises, and the bits of the log belief by type

The choice follows from the belief, the seed and the number of the step, so that asking twice changes nothing.
Moves are numbered, so that moves that come twice count once. Thesis: §4.8.4, Alg. 9.
"""

import hashlib
import json
import time
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from lifelore.agent.personalise.library_document import library_of
from lifelore.agent.personalise.study import check_study_name, user_key
from lifelore.core.atomic_write import read_file
from lifelore.core.errors import InputError, NotFoundError, StoreError
from lifelore.core.json_lines import Lines, read_objects
from lifelore.core.protocols import Record
from lifelore.core.streams import stream
from lifelore.interaction.adaptation.beat import Beat, rule_at
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.memory import Memory
from lifelore.memory.byte_words import bytes_of, words_of
from lifelore.memory.record_rules import check_name

LIBRARY, USER, VERSION = "adapt_library", "adapt_user", 1
_HEADER = 3
ATTEMPTS = 100
Epsilon = float | str


@dataclass(frozen=True, eq=False)
class Adaptation:
    """A registered library of action sets.

    Parameters
    ----------
    name : str
    library : PolicyLibrary
        Its policies are the action sets, its signal is a move.
    epsilon : float or str
        As for `Beat`.
    id : str
        Changes with each other library of this name; a user's belief holds for one of them.
    """

    name: str
    library: PolicyLibrary
    epsilon: Epsilon
    id: str


def register_adaptation(memory: Memory, name: str, library: PolicyLibrary, epsilon: Epsilon = 0.0) -> Adaptation:
    """Store a library of action sets; with another library, users start from the prior again.

    Raises
    ------
    InputError
        A name or ε breaks its rule.
    """
    check_study_name(name)
    rule_at(epsilon)
    content = library.to_bytes()
    digest = hashlib.sha256(content + repr(epsilon).encode()).hexdigest()[:32]
    earlier = memory.recall(LIBRARY, name, VERSION, slots=(0, 0))
    if earlier is not None and earlier.about["digest"] == digest:
        return open_adaptation(memory, name)
    values = words_of(content)
    about = {"bytes": len(content), "epsilon": epsilon, "digest": digest, "id": f"{digest[:8]}-{time.time_ns()}"}
    record = Record(LIBRARY, name, VERSION, "newest", np.arange(len(values)), values, about)
    robot = f"adapt {name}"
    seq = memory.tasks(robot)
    while not memory.contribute(robot, [record], process="library", seq=seq, task={"adaptation": name}):
        seq += 1
    return open_adaptation(memory, name)


def open_adaptation(memory: Memory, name: str) -> Adaptation:
    """The adaptation of that name; NotFoundError where there is none."""
    check_study_name(name)
    record = memory.recall(LIBRARY, name, VERSION)
    if record is None:
        known = ", ".join(key for key, version, _ in memory.keys(LIBRARY) if version == VERSION)
        raise NotFoundError(f"no adaptation '{name}'; known: {known or 'none'}; register its library first")
    about: Mapping[str, Any] = record.about
    # Cells beyond the content are those of an earlier, larger library.
    content = bytes_of(record.values, about["bytes"])
    try:
        library = PolicyLibrary.from_bytes(content, f"adaptation '{name}'")
    except InputError as error:
        raise StoreError(f"{error}; register the library again") from None
    return Adaptation(name, library, about["epsilon"], about["id"])


def read_library(path: str) -> PolicyLibrary:
    """The library of a file: that of `PolicyLibrary.save`, or the JSON fields of `library_of`.

    Raises
    ------
    InputError
        The file cannot be read, or is neither.
    """
    content = read_file(path, "the library")
    if not content.lstrip().startswith(b"{"):
        return PolicyLibrary.from_bytes(content, path)
    try:
        return library_of(json.loads(content))
    except InputError as error:
        raise InputError(f"{path}: {error}") from None
    except (ValueError, RecursionError):
        raise InputError(
            f"{path} must be one JSON object, or a file of PolicyLibrary.save, got other text"
        ) from None


def adapt(
    memory: Memory, adaptation: Adaptation, lines: Lines, name: str = "moves", seed: int = 0
) -> Iterator[dict[str, Any]]:
    """The action set for the next step of a user after each line, as `select` returns it.

    A line is an object: ``{"user": …}`` asks before the first move; ``{"user": …, "action_set": …, "signal": …}``
    stores a move first. ``"step"``, the number of the move from 0, makes a move that comes twice count once.
    ``"ends_episode": true`` ends an episode with the move. ``{"user": …, "forget": true}`` deletes all that is
    stored of the user.

    Raises
    ------
    InputError
        A line is no such object or breaks a rule; the lines before it are stored.
    """
    for number, line in read_objects(lines, name):
        try:
            user = line.pop("user", None)
            if not isinstance(user, str) or not user:
                raise InputError(f"user must be a name, got {user!r}")
            if line == {"forget": True}:
                yield {"user": user, "forgotten": forget_adaptation(memory, adaptation, user)}
                continue
            if line:
                _learn_line(memory, adaptation, user, line)
            yield select(memory, adaptation, user, seed)
        except (InputError, NotFoundError) as error:
            raise type(error)(f"{name} line {number}: {error}") from None


def _learn_line(memory: Memory, adaptation: Adaptation, user: str, line: dict[str, Any]) -> None:
    """Store the move of a line of `adapt`."""
    step, ends = line.pop("step", None), line.pop("ends_episode", False)
    if line.keys() != {"action_set", "signal"}:
        fields = "user, action_set, signal[, step, ends_episode]"
        raise InputError(f"a move must have {fields}, got {', '.join(['user', *line])}")
    if step is not None and (isinstance(step, bool) or not isinstance(step, int) or step < 0):
        raise InputError(f"step must be a whole number from 0, got {step!r}")
    if not isinstance(ends, bool):
        raise InputError(f"ends_episode must be true or false, got {ends!r}")
    moves = [(line["action_set"], line["signal"])]
    learn_moves(memory, adaptation, user, step, moves, ends_episode=ends)


def select(memory: Memory, adaptation: Adaptation, user: str, seed: int = 0) -> dict[str, Any]:
    """The action set for a user's next step; nothing is stored.

    Returns
    -------
    dict
        ``user``, ``action_set``, its ``probability``, ``step`` (number of moves so far), ``episode``,
        ``surprises`` (moves that no type explains), ``belief`` and ``expected`` value of each action set.
    """
    beat = _beat(memory, adaptation, user)
    library, probs = adaptation.library, beat.algorithm.propensities(0, beat.rule)
    generator = stream(seed, "adapt", adaptation.name, adaptation.id, user, beat.step)
    chosen = int(generator.choice(len(probs), p=probs))
    expected = beat.belief @ library.performance.mean
    return {
        "user": user,
        "action_set": library.policies[chosen],
        "probability": float(probs[chosen]),
        **_state(adaptation, beat),
        "expected": dict(zip(library.policies, expected.tolist(), strict=True)),
    }


def learn_moves(
    memory: Memory,
    adaptation: Adaptation,
    user: str,
    step: int | None,
    moves: Sequence[tuple[str, Any]],
    *,
    ends_episode: bool = False,
) -> dict[str, Any]:
    """Learn from moves of a user, in one transaction.

    Parameters
    ----------
    step : int, optional
        Number of the first of the moves, from 0; None: they follow those that are stored.
    moves : sequence of (action set, signal)
    ends_episode : bool
        Whether the last of the moves ends an episode.

    Returns
    -------
    dict
        ``user``; ``taken``: False where the moves were stored before; and the state as in `select`.

    Raises
    ------
    InputError
        Moves before `step` are missing, some of the moves are stored and others are not, there is no move, or a
        signal breaks its rule; nothing is stored.
    NotFoundError
        There is no such action set.
    """
    if not moves:
        raise InputError("moves must hold at least one move, got none")
    for _ in range(ATTEMPTS):
        beat = _beat(memory, adaptation, user)
        first = beat.step if step is None else step
        if first + len(moves) <= beat.step:
            return {"user": user, "taken": False, **_state(adaptation, beat)}
        if first != beat.step:
            raise InputError(
                f"step must be {beat.step}, the number of moves so far, got {first}; give the moves from there"
            )
        for action_set, signal in moves:
            beat.update(action_set, signal)
        if ends_episode:
            beat.end_episode()
        record = _record(adaptation, user, beat)
        robot, task = _robot(adaptation, user), {"adaptation": adaptation.name, "moves": len(moves)}
        process = _process(memory, adaptation, robot)
        if memory.contribute(robot, [record], process=process, seq=first, task=task):
            return {"user": user, "taken": True, **_state(adaptation, beat)}
    raise StoreError(f"memory {memory.location}: too many programs move for one user at once; try again")


def forget_adaptation(memory: Memory, adaptation: Adaptation, user: str) -> int:
    """Forget a user; the number of contributions removed. NotFoundError where nothing is stored."""
    check_name("user", user)
    robot = _robot(adaptation, user)
    if not memory.tasks(robot):
        raise NotFoundError(f"nothing is stored of user '{user}' in adaptation '{adaptation.name}'")
    return memory.forget(robot)


def _robot(adaptation: Adaptation, user: str) -> str:
    return f"adapt {adaptation.name}: {user_key(adaptation.name, user)}"


def _process(memory: Memory, adaptation: Adaptation, robot: str) -> str:
    """A name for each time that a user was forgotten, since memory stores nothing forgotten again."""
    process, number = adaptation.id, 0
    while memory.times_forgotten(robot, process):
        number += 1
        process = f"{adaptation.id} {number}"
    return process


def _beat(memory: Memory, adaptation: Adaptation, user: str) -> Beat:
    """The learner as the user's stored moves leave it."""
    check_name("user", user)
    beat = Beat(adaptation.library, epsilon=adaptation.epsilon)
    key = f"{adaptation.name}/{user_key(adaptation.name, user)}"
    record = memory.recall(USER, key, VERSION)
    if record is not None and record.slots.size and record.about["id"] == adaptation.id:
        beat.step, beat.episode, beat.surprises = record.values[:_HEADER].tolist()
        log_belief = record.values[_HEADER : _HEADER + adaptation.library.n_types].view(np.float64)
        beat.algorithm.restore(0, log_belief, {})
    return beat


def _record(adaptation: Adaptation, user: str, beat: Beat) -> Record:
    values = np.concatenate([[beat.step, beat.episode, beat.surprises], beat.log_belief.view(np.int64)])
    key = f"{adaptation.name}/{user_key(adaptation.name, user)}"
    about = {"adaptation": adaptation.name, "user": user, "id": adaptation.id}
    return Record(USER, key, VERSION, "newest", np.arange(len(values)), values.astype(np.int64), about)


def _state(adaptation: Adaptation, beat: Beat) -> dict[str, Any]:
    belief = dict(zip(adaptation.library.types, beat.belief.tolist(), strict=True))
    return {"step": beat.step, "episode": beat.episode, "surprises": beat.surprises, "belief": belief}
