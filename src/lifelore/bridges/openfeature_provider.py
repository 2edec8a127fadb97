"""Studies as flags of OpenFeature (extra ``openfeature``): a flag's value is the policy chosen for the user."""

import asyncio
import contextlib
import json
from collections.abc import Callable, Mapping, Sequence
from typing import Any

from lifelore.bridges.study_client import REMEMBERED, Choice, Recent, StudyClient
from lifelore.core.errors import MissingExtraError

try:
    from openfeature import exception
    from openfeature.flag_evaluation import FlagResolutionDetails, Reason
    from openfeature.provider import AbstractProvider, Metadata
except ImportError as error:
    raise MissingExtraError(
        f"openfeature-sdk comes with the extra openfeature: pip install 'lifelore[openfeature]' ({error})"
    ) from None
REASONS = {"service": Reason.TARGETING_MATCH, "table": Reason.CACHED, "fallback": Reason.DEFAULT}


def _resolvers(kind: type | tuple[type, ...]) -> tuple[Callable[..., Any], Callable[..., Any]]:
    """The method that resolves a flag of this type, and the asynchronous one."""

    def resolve(self: Any, flag_key: str, default_value: Any, evaluation_context: Any = None) -> Any:
        return self._resolved(flag_key, evaluation_context, kind)

    async def resolve_async(self: Any, flag_key: str, default_value: Any, evaluation_context: Any = None) -> Any:
        return await asyncio.to_thread(self._resolved, flag_key, evaluation_context, kind)

    return resolve, resolve_async


class LifeloreProvider(AbstractProvider):
    """A provider of OpenFeature: a flag has the name of its study, and the targeting key is the user.

    Parameters
    ----------
    *clients : StudyClient
        One for each flag. ``shutdown`` closes them.
    values : mapping, optional
        For a flag the value of each policy, such as ``{"checkout": {"new": True, "old": False}}``. Default: the
        policy's name for a flag of text; else its name read as JSON, or ``on`` or ``off``.
    features : sequence of str
        Names of the attributes that are numbers known of the user. Besides them, the service gets the attributes
        ``context`` (of the user) and ``request``.

    Notes
    -----
    Each evaluation is a decision; with a ``request``, such as the session, the same one. Its details hold the
    policy as ``variant``, and in ``flag_metadata`` the ``decision``, its ``probability`` and ``source``.
    """

    resolve_boolean_details, resolve_boolean_details_async = _resolvers(bool)
    resolve_string_details, resolve_string_details_async = _resolvers(str)
    resolve_integer_details, resolve_integer_details_async = _resolvers(int)
    resolve_float_details, resolve_float_details_async = _resolvers(float)
    resolve_object_details, resolve_object_details_async = _resolvers((dict, list))

    def __init__(
        self,
        *clients: StudyClient,
        values: Mapping[str, Mapping[str, Any]] | None = None,
        features: Sequence[str] = (),
    ) -> None:
        super().__init__()
        self._clients, self._values = {client.study: client for client in clients}, values or {}
        self._features, self._last = features, Recent(REMEMBERED)

    def get_metadata(self) -> Metadata:
        return Metadata("Lifelore")

    def shutdown(self) -> None:
        for client in self._clients.values():
            client.close()

    def track(
        self, tracking_event_name: str, evaluation_context: Any = None, tracking_event_details: Any = None
    ) -> None:
        """Queue the value of an event, which has the name of the flag, as an outcome.

        The event's attribute ``decision`` names the decision; without it, the user's last one in this process
        counts. An event of another name or without a value is no outcome.
        """
        client, details = self._clients.get(tracking_event_name), tracking_event_details
        if client and details and details.value is not None:
            last = self._last.get((tracking_event_name, evaluation_context and evaluation_context.targeting_key))
            choice = details.attributes.get("decision") or last
            if isinstance(choice, str | Choice):
                client.observe(choice, details.value)

    def _resolved(self, flag: str, context: Any, kind: Any) -> Any:
        if flag not in self._clients:
            raise exception.FlagNotFoundError(f"no client has a study of the name {flag!r}")
        if not (context and context.targeting_key):
            raise exception.TargetingKeyMissingError("the targeting key must be the name of the user")
        known, user = context.attributes, context.targeting_key
        texts = {name: str(known[name]) for name in ("context", "request") if name in known}
        numbers = {name: known[name] for name in self._features if name in known}
        try:
            choice = self._clients[flag].decide(user, features=numbers or None, **texts)
        except ValueError as error:
            raise exception.GeneralError(str(error)) from error
        self._last.put((flag, user), choice)
        metadata = {"decision": choice.decision, "probability": choice.probability, "source": choice.source}
        value, reason = self._value(flag, choice.policy, kind), REASONS[choice.source]
        return FlagResolutionDetails(value, reason=reason, variant=choice.policy, flag_metadata=metadata)

    def _value(self, flag: str, policy: str, kind: Any) -> Any:
        """The value of a policy, of this type."""
        value: Any = self._values[flag].get(policy) if flag in self._values else policy
        if flag not in self._values and kind is not str:
            with contextlib.suppress(ValueError):
                value = policy == "on" if policy in ("on", "off") else json.loads(policy)
        value = float(value) if kind is float and type(value) is int else value
        if not isinstance(value, kind) or (kind is int and isinstance(value, bool)):
            raise exception.TypeMismatchError(f"policy {policy!r} of flag {flag!r} has the value {value!r}")
        return value
