"""The verb `reuse fit`: a log becomes a policy library, its types named in the log or found from outcomes."""

import time
from collections import Counter
from collections.abc import Mapping
from dataclasses import asdict, dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lifelore.agent.personalise.fitting.fit_notes import fit_notes, personalised_by
from lifelore.agent.personalise.fitting.library_from_log import Fitted, TypedRows, library_of, typed_rows
from lifelore.agent.personalise.fitting.model_choice import Kind, chosen_model
from lifelore.agent.personalise.fitting.types_by_context import by_context, contexts_differ, priors_by_context
from lifelore.agent.personalise.log.log import ReuseLog, read_log
from lifelore.agent.personalise.log.log_format import LogFormat
from lifelore.agent.personalise.past import each_line_once, keep_fitted_past
from lifelore.agent.personalise.study import (
    ACTIVE,
    CHOOSING,
    LEARNT,
    Change,
    Study,
    check_study_name,
    newest_version,
    states_after,
)
from lifelore.core.errors import InputError, NotFoundError
from lifelore.core.streams import stream
from lifelore.interaction.beliefs.feature_prior import FeaturePrior
from lifelore.interaction.selection import DEFAULT_RULE, printed_rule, rule_named
from lifelore.interaction.selection.rule import check_variant
from lifelore.memory import Memory

MODELS = ("auto", "gaussian", "student-t", "categorical", "joint-normal")


@dataclass(frozen=True)
class FitSettings:
    """Settings of `fit`.

    Parameters
    ----------
    name : str
        Of the study.
    model : {"auto", "gaussian", "student-t", "categorical", "joint-normal"}
        Of outcomes; ``auto``: the one that serves users best who are held out, see `model_choice`.
    types : int, optional
        How many types to look for where the log names none; by default the number that serves held-out users
        best, 1 where there are too few users for that.
    control, incumbent, rule, explore, change, models
        As in `Study`.
    seed : int
        For finding types.
    variant : {"standard", "thesis"}
        ``thesis``: the rule in its printed form, see `printed_rule`.

    Examples
    --------
    >>> FitSettings(types=3, incumbent="calm").control
    0.1
    """

    name: str = "default"
    model: str = "auto"
    types: int | None = None
    control: float = 0.1
    incumbent: str | None = None
    rule: str = DEFAULT_RULE
    explore: float = 0.0
    change: Change = LEARNT
    models: str = "uncertain"
    seed: int = 0
    variant: str = "standard"

    def __post_init__(self) -> None:
        check_study_name(self.name)
        check_variant(self.variant)
        if self.variant == "thesis":
            printed_rule(self.rule)
        if self.model not in MODELS:
            raise NotFoundError(f"model must be one of {', '.join(MODELS)}, got '{self.model}'")
        if self.types is not None and self.types < 1:
            raise InputError(f"types must be at least 1, got {self.types}")


def fit(
    sources: Any,
    memory: Memory,
    settings: FitSettings | None = None,
    form: LogFormat | None = None,
) -> dict[str, Any]:
    """Learn a study from logs, and store it in memory in place of an earlier study of its name.

    Users' decisions in memory stay; beliefs follow the new library. Policies retired stay so, and those that the
    logs no longer know are retired; a pilot that the logs know becomes active.

    Parameters
    ----------
    sources : sequence of paths or tables, or a table
        Files of CSV, or tables of pandas, polars or Arrow; see `read_log`.
    form : LogFormat, optional
        How the logs are written.

    Returns
    -------
    dict
        Plain data: ``study``; ``rows`` learnt from, ``left_out`` (of users whose type the log does not name);
        ``pending`` (lines left out without an outcome), ``filled_outcomes``, ``filled_policies``,
        ``without_policy`` (see `ReuseLog`); ``repeated`` (lines left out that an earlier log has, too);
        ``users``; ``model``; ``types_found``, ``held_out``: how models
        were compared on users held out (None where they were not): number of ``users`` and mean ``value`` of the
        chosen model's choices, its difference and 95 % interval to the best single policy (``over_single``) and
        to counting a user's own outcomes with a prior worth two (``over_counting``), and all ``candidates``;
        ``personalised_by``: "types", "context" (types by context), "items" (what a policy shows tells of others),
        several, or nothing; ``notes``: sentences for the reader; ``context`` (None without contexts):
        ``column`` of the log, ``users`` with one, ``several`` (users with more than one; the last counts),
        ``differ`` (whether outcomes differ between contexts beyond chance), ``types_of`` (number of contexts
        with types of their own; 0: types are everybody's), ``worth``: gain of choices for held-out users whose
        contexts are known over choices without a look at them, with its 95 % interval (None where nobody was
        held out);
        ``types`` (name, users, prior, best policy);
        ``policies`` (name, state, mean); ``means`` and ``outcomes`` by type and policy; ``borrowed`` (pairs
        without an outcome, which got the policy's outcomes on all types); ``contexts``; ``features`` (None
        without them): their ``names``, ``users`` who have all, chosen ``strength`` and held-out ``gain`` in nats
        a user, see `FeaturePrior`; ``control``,
        ``incumbent``, ``rule``, ``explore``, ``change``; ``changed``: settings that are not what they were in an
        earlier fit, by name what they were; ``kept`` (None for a new study): ``users`` and ``decisions`` of the
        study in memory, ``pending`` ones without an outcome, and those that are lines of the log (``in_log``).
        They all stay, and beliefs follow the new library.

    Raises
    ------
    InputError, NotFoundError
        A log or setting breaks its rule; memory is as it was.

    Examples
    --------
    >>> import tempfile
    >>> from lifelore import open_memory
    >>> names = ["ann", "ben", "carl", "dora"]
    >>> log = {"user": names * 2, "policy": ["calm"] * 4 + ["jazz"] * 4, "outcome": [8, 2, 9, 3, 2, 9, 1, 8]}
    >>> with tempfile.TemporaryDirectory() as folder, open_memory(f"{folder}/songs.db") as memory:
    ...     found = fit(log, memory, FitSettings(types=2, model="gaussian"))
    >>> [policy["name"] for policy in found["policies"]]
    ['calm', 'jazz']
    """
    settings = settings or FitSettings()
    log = each_line_once(read_log(sources, form))
    found = newest_version(memory, settings.name)  # its library need not be readable
    earlier = found.about if found else {}
    study, typed, counts, held_out = study_of_log(log, settings, dict(earlier.get("states", {})))
    with memory.together():
        study = replace(study, earlier=bool(earlier.get("earlier"))).keep(memory)
        past = keep_fitted_past(memory, study, log)
    document = _document(study, log, typed, counts) | {"changed": _changed(study, earlier), "held_out": held_out}
    document["kept"] = _kept(memory, study, past) if earlier else None
    document |= {"context": _context(log, typed, held_out, form), "personalised_by": personalised_by(study, typed)}
    return document | {"notes": fit_notes(study, document, log, settings.model)}


def study_of_log(
    log: ReuseLog, settings: FitSettings, earlier: dict[str, str] | None = None
) -> tuple[Study, TypedRows, NDArray[np.float64], dict[str, Any] | None]:
    """The study that a log gives, its typed rows, the number of outcomes of each type and policy, and `held_out`.

    Parameters
    ----------
    log : ReuseLog
    settings : FitSettings
    earlier : dict of str to str, optional
        What each policy is in an earlier study of the name.
    """
    generator = stream(settings.seed, "reuse types", settings.name)

    def fitted(part: ReuseLog, kind: Kind) -> Fitted:
        typed = typed_rows(part, kind.model, kind.types, generator)
        return (by_context if kind.by_context else library_of)(part, typed, kind.model)

    choice = chosen_model(log, settings.model, settings.types, fitted, generator)
    found = fitted(log, choice.kind)
    # Computed once and stored with the library.
    found.library.performance.spread  # noqa: B018  # pyright: ignore
    return _study(log, found, settings, earlier or {}), found.typed, found.counts, choice.held_out


def _study(log: ReuseLog, found: Fitted, settings: FitSettings, earlier: dict[str, str]) -> Study:
    library, typed = found.library, found.typed
    states = states_after(library.policies, earlier)
    if ACTIVE not in states.values():
        raise InputError("the logs must hold a policy that is not retired, got none")
    fitted = {"rows": _used(log, typed), "users": len(typed.users(log)[0]), "found": typed.found}
    fitted["time"] = int(time.time())
    rule = printed_rule(settings.rule) if settings.variant == "thesis" else rule_named(settings.rule)
    return Study(
        settings.name, library, states, priors_by_context(log, found), fitted=fitted,
        **{name: getattr(settings, name) for name in CHOOSING},
        rule_settings=asdict(rule),  # pyright: ignore[reportArgumentType]
        feature_prior=_feature_prior(log, typed, library.prior, settings.seed),
    )  # fmt: skip


def _feature_prior(log: ReuseLog, typed: TypedRows, prior: NDArray[np.float64], seed: int) -> FeaturePrior | None:
    """Prior over types from the log's features, by its users with all of them; None without features."""
    if not log.feature_names:
        return None
    users, types = typed.users(log)
    rows = log.features_of_user[users]
    whole = ~np.isnan(rows).any(axis=1)
    if not whole.any():
        raise InputError(
            f"features must all be known of a user, no user has all of {', '.join(log.feature_names)}"
        )
    return FeaturePrior.fit(rows[whole], types[whole], prior, log.feature_names, seed=seed)


def _kept(memory: Memory, study: Study, past: Mapping[str, int]) -> dict[str, int]:
    """What was there of the study before this fit, and stays."""
    with memory.studies.totals(study.number) as totals:
        decisions, pending = totals.n_decisions()
        users = totals.n_users()
    return {"users": users, "decisions": decisions, "pending": pending, "in_log": past["decisions"]}


def _changed(study: Study, earlier: Mapping[str, Any]) -> dict[str, Any]:
    """Settings that are another than before, and what they were."""
    return {name: earlier[name] for name, now in study.choosing.items() if earlier.get(name, now) != now}


def _document(study: Study, log: ReuseLog, typed: TypedRows, counts: NDArray[np.float64]) -> dict[str, Any]:
    library = study.library
    mean = library.performance.mean
    members = Counter(typed.users(log)[1].tolist())
    active = study.active_numbers
    return {
        "study": study.name,
        "rows": _used(log, typed),
        **log.counts,
        "left_out": len(log) - _used(log, typed),
        "users": len(log.user.names),
        "model": library.performance.kind,  # type: ignore[attr-defined]
        "types_found": typed.found,
        "types": [
            {
                "name": name,
                "users": members[number],
                "prior": float(library.prior[number]),
                "best": library.policies[active[int(mean[number, active].argmax())]],
            }
            for number, name in enumerate(library.types)
        ],
        "policies": [
            {"name": policy, "state": state, "mean": study.expected(policy)}
            for policy, state in sorted(study.states.items())
        ],
        "means": mean.tolist(),
        "outcomes": counts.astype(int).tolist(),
        "borrowed": int((counts == 0).sum()),
        "contexts": sorted(study.contexts),
        "features": _features(study, log),
        **study.choosing,
    }


def _context(
    log: ReuseLog, typed: TypedRows, held_out: Mapping[str, Any] | None, form: LogFormat | None
) -> dict[str, Any] | None:
    if not any(log.context.names):
        return None
    named = np.array([bool(name) for name in log.context.names])[log.context.codes]
    pairs = np.unique(np.stack([log.user.codes, log.context.codes])[:, named], axis=1)
    return {
        "column": form.columns.get("context", "context") if form else "context",
        "users": int((log.context_of_user >= 0).sum()),
        "several": int((np.bincount(pairs[0]) > 1).sum()),
        "differ": contexts_differ(log),
        "types_of": typed.contexts,
        "worth": held_out["over_unknown_context"] if held_out else None,
    }


def _used(log: ReuseLog, typed: TypedRows) -> int:
    """Number of rows learnt from; types by context learn from users without a context too."""
    return len(log) if typed.found else len(typed.rows)


def _features(study: Study, log: ReuseLog) -> dict[str, Any] | None:
    found = study.feature_prior
    if found is None:
        return None
    users = int((~np.isnan(log.features_of_user).any(axis=1)).sum())
    return {"names": list(found.names), "users": users, "strength": found.strength, "gain": found.gain}
