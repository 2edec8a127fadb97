"""Interface adaptation (BEAT) for users in memory: choose an action set for the next step, learn from moves.

An adaptation is a study of its own in memory, of the name ``adapt/NAME``: the library is its version, a user's
belief is the state of the user's row, and holds for one version.

The choice follows from the belief, the seed and the number of the step, so that asking twice changes nothing.
Moves are numbered, so that moves that come twice count once. Thesis: §4.8.4, Alg. 9.
"""

import json
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from lifelore.agent.personalise.registration import library_of
from lifelore.agent.personalise.study import ADAPTATION, check_study_name
from lifelore.core.atomic_write import read_file
from lifelore.core.errors import InputError, NotFoundError, StoreError
from lifelore.core.json_lines import Lines, read_objects
from lifelore.core.streams import stream
from lifelore.interaction.adaptation.beat import Beat, rule_at
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.memory import Memory
from lifelore.memory.record_rules import check_name
from lifelore.memory.study_rows import UserRow

_HEADER = 3
"""Numbers of a state before the log belief: step, episode, surprises."""
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
    number, version : int
        Of the study in memory; the version changes with each other library or ε.
    """

    name: str
    library: PolicyLibrary
    epsilon: Epsilon
    number: int
    version: int


def register_adaptation(memory: Memory, name: str, library: PolicyLibrary, epsilon: Epsilon = 0.0) -> Adaptation:
    """Store a library of action sets; with another library, users start from the prior again.

    Raises
    ------
    InputError
        A name or ε breaks its rule.
    """
    check_study_name(name)
    rule_at(epsilon)
    stored = memory.studies.keep(ADAPTATION + name, {"epsilon": epsilon}, library.to_bytes())
    return Adaptation(name, library, epsilon, stored.number, stored.version)


def open_adaptation(memory: Memory, name: str) -> Adaptation:
    """The adaptation of that name; NotFoundError where there is none."""
    check_study_name(name)
    found = memory.studies.newest(ADAPTATION + name)
    if found is None:
        known = [one.removeprefix(ADAPTATION) for one in memory.studies.states() if one.startswith(ADAPTATION)]
        raise NotFoundError(
            f"no adaptation '{name}'; known: {', '.join(known) or 'none'}; register its library first"
        )
    try:
        library = PolicyLibrary.from_bytes(found.content, f"adaptation '{name}'")
    except InputError as error:
        raise StoreError(f"{error}; register the library again") from None
    return Adaptation(name, library, found.about["epsilon"], found.number, found.version)


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
    check_name("user", user)
    with memory.studies.reading(adaptation.number) as rows:
        beat = _beat(adaptation, rows.users([user]).get(user))
    library, probs = adaptation.library, beat.algorithm.propensities(0, beat.rule)
    generator = stream(seed, "adapt", adaptation.name, adaptation.version, user, beat.step)
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
    check_name("user", user)
    with memory.studies.writing(adaptation.number) as rows:
        known = rows.users([user]).get(user) or rows.add_users([(user, None, None)], 0)[user]
        known = rows.numbered([known.number], lock=True).get(known.number)
        if known is None:
            raise StoreError(f"memory {memory.location}: the user was forgotten at this moment; try again")
        beat = _beat(adaptation, known)
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
        state = np.concatenate([[beat.step, beat.episode, beat.surprises], beat.log_belief]).astype("<f8")
        rows.keep_beliefs([(known.number, state.tobytes())], adaptation.version)
    return {"user": user, "taken": True, **_state(adaptation, beat)}


def forget_adaptation(memory: Memory, adaptation: Adaptation, user: str) -> int:
    """Forget a user; the number of moves forgotten. NotFoundError where nothing is stored."""
    check_name("user", user)
    with memory.studies.writing(adaptation.number) as rows:
        known = rows.users([user]).get(user)
        if known is None or rows.forget(known.number) is None:
            raise NotFoundError(f"nothing is stored of user '{user}' in adaptation '{adaptation.name}'")
    memory.studies.forgotten()
    return _beat(adaptation, known).step


def _beat(adaptation: Adaptation, known: UserRow | None) -> Beat:
    """The learner as the user's stored moves leave it."""
    beat = Beat(adaptation.library, epsilon=adaptation.epsilon)
    if known is not None and known.state is not None and known.version == adaptation.version:
        state = np.frombuffer(known.state, "<f8")
        beat.step, beat.episode, beat.surprises = state[:_HEADER].astype(int).tolist()
        beat.algorithm.restore(0, state[_HEADER:], {})
    return beat


def _state(adaptation: Adaptation, beat: Beat) -> dict[str, Any]:
    belief = dict(zip(adaptation.library.types, beat.belief.tolist(), strict=True))
    return {"step": beat.step, "episode": beat.episode, "surprises": beat.surprises, "belief": belief}
