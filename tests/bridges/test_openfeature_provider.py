"""Studies are flags of the real OpenFeature SDK."""

import asyncio
import importlib
import re
import sys
from pathlib import Path

import pytest

pytest.importorskip("openfeature.track", reason="needs the extra openfeature")

from openfeature import api
from openfeature.evaluation_context import EvaluationContext
from openfeature.exception import ErrorCode, TypeMismatchError
from openfeature.flag_evaluation import Reason
from openfeature.track import TrackingEventDetails

from lifelore.bridges.openfeature_provider import LifeloreProvider
from lifelore.bridges.study_client import StudyClient
from lifelore.core.errors import MissingExtraError

from .service_stand_in import STUDY, StandIn

ADA = EvaluationContext("ada", {"context": "night", "age": 31, "mail": "ada@example.org"})


@pytest.fixture
def service():
    service = StandIn()
    yield service
    service.kill()


@pytest.fixture
def flags(service):
    """An OpenFeature client of a provider with these settings."""

    def flags(timeout=30.0, **settings):
        study = StudyClient(service.url, STUDY, fallback="slow", timeout=timeout)
        api.set_provider(LifeloreProvider(study, **settings))
        return api.get_client()

    yield flags
    api.shutdown()
    api.clear_providers()


def test_a_flag_is_the_policy_of_the_service(service, flags):
    client = flags(features=["age"])
    details = client.get_string_details(STUDY, "none", ADA)
    assert (details.value, details.variant, details.reason) == ("slow", "slow", Reason.TARGETING_MATCH)
    row = service.state.decisions[details.flag_metadata["decision"]]
    assert {name: row[name] for name in ("user", "context", "features")} == {
        "user": "ada", "context": "night", "features": {"age": 31},
    }  # fmt: skip
    assert "ada@example.org" not in str(row)
    assert details.flag_metadata["probability"] == 1.0


def test_a_request_gets_the_same_decision(flags):
    client, session = flags(), EvaluationContext("ada", {"request": 17})
    details = [client.get_string_details(STUDY, "none", session) for _ in range(5)]
    assert len({one.flag_metadata["decision"] for one in details}) == 1


def test_every_type_of_flag_has_the_value_of_its_policy(flags):
    for values, kind, wrong in (
        ({"slow": True}, "boolean", False),
        ({"slow": 3}, "integer", 0),
        ({"slow": 3}, "float", 0.0),
        ({"slow": {"rows": [1, 2]}}, "object", {}),
        ({"slow": "Langsam"}, "string", "none"),
    ):
        client = flags(values={STUDY: values})
        value = getattr(client, f"get_{kind}_value")(STUDY, wrong, ADA)
        assert (value, type(value)) == (values["slow"], type(wrong))


@pytest.mark.parametrize(
    ("policy", "kind", "value"),
    [("on", bool, True), ("off", bool, False), ("true", bool, True), ("3", int, 3), ("3", float, 3.0),
     ("0.5", float, 0.5), ('{"rows": 2}', (dict, list), {"rows": 2}), ("3", str, "3"), ("on", str, "on")],
)  # fmt: skip
def test_a_policys_name_is_its_value(policy, kind, value):
    assert LifeloreProvider()._value("flag", policy, kind) == value


@pytest.mark.parametrize(
    ("policy", "kind"), [("slow", bool), ("true", int), ("1", bool), ("0.5", int), ("3", dict)]
)
def test_a_policy_of_another_type_is_an_error(policy, kind):
    with pytest.raises(TypeMismatchError):
        LifeloreProvider()._value("flag", policy, kind)


def test_errors_are_those_of_openfeature(service, flags):
    client = flags(values={STUDY: {"fast": True}})
    for flag, context, code in (
        ("other", ADA, ErrorCode.FLAG_NOT_FOUND),
        (STUDY, EvaluationContext(), ErrorCode.TARGETING_KEY_MISSING),
        (STUDY, EvaluationContext("a" * 201), ErrorCode.GENERAL),
        (STUDY, ADA, ErrorCode.TYPE_MISMATCH),
    ):
        details = client.get_boolean_details(flag, False, context)
        assert (details.value, details.reason, details.error_code) == (False, Reason.ERROR, code)


def test_without_the_service_reasons_are_cached_and_default(service, flags):
    service.kill()
    details = flags().get_string_details(STUDY, "none", ADA)
    assert (details.value, details.reason) == ("slow", Reason.DEFAULT)
    service.start()
    client = flags()
    client.get_string_details(STUDY, "none", ADA)
    service.kill()
    details = client.get_string_details(STUDY, "none", ADA)
    assert (details.value, details.reason, details.flag_metadata["source"]) == ("slow", Reason.CACHED, "table")


def test_a_tracked_event_is_an_outcome(service, flags):
    client = flags()
    first, last = (client.get_string_details(STUDY, "none", ADA).flag_metadata["decision"] for _ in range(2))
    client.track(STUDY, ADA, TrackingEventDetails(1.0, {"decision": first}))
    client.track(STUDY, ADA, TrackingEventDetails(2.0))
    client.track("page seen", ADA, TrackingEventDetails(3.0, {"decision": "other"}))
    client.track(STUDY, ADA)
    client.track(STUDY, EvaluationContext("nobody"), TrackingEventDetails(4.0))
    service.kill()
    offline = client.get_string_details(STUDY, "none", ADA).flag_metadata["decision"]
    client.track(STUDY, ADA, TrackingEventDetails(5.0, {"decision": offline}))
    service.start()
    api.shutdown()
    assert service.state.outcomes == {first: 1.0, last: 2.0}
    assert {key: row["outcome"] for key, row in service.state.past.items()} == {offline: 5.0}


def test_asynchronous_evaluation_leaves_the_loop_free(service, flags):
    client = flags(timeout=0.2)
    service.mode = "hang"

    async def ticks_meanwhile():
        details, ticks = asyncio.create_task(client.get_string_details_async(STUDY, "none", ADA)), 0
        while not details.done():
            await asyncio.sleep(0.01)
            ticks += 1
        return ticks, details.result().value

    ticks, value = asyncio.run(ticks_meanwhile())
    service.woken.set()
    assert ticks > 1  # some 20 on an idle machine in the timeout of 0.2 s; one where the loop waits
    assert value == "slow"


def test_the_program_of_the_page_runs(service, tmp_path, monkeypatch):
    page = (Path(__file__).parents[2] / "docs" / "service.md").read_text(encoding="utf-8")
    first, flag = re.findall(r"^```python\n(.*?)^```", page, flags=re.S | re.M)
    monkeypatch.chdir(tmp_path)
    names = {"api": api, "EvaluationContext": EvaluationContext, "LifeloreProvider": LifeloreProvider}
    names["TrackingEventDetails"] = TrackingEventDetails
    exec(first.replace("http://127.0.0.1:8321", service.url) + flag, names)
    api.shutdown()
    api.clear_providers()
    assert sorted(service.state.outcomes.values()) == [7.5, 7.5]
    assert names["fast"] == (
        service.state.requests["ada", "session 17"]
        in {key for key, row in service.state.decisions.items() if row["policy"] == "fast"}
    )


def test_without_the_sdk_the_extra_is_named(monkeypatch):
    monkeypatch.delitem(sys.modules, "lifelore.bridges.openfeature_provider")
    monkeypatch.setitem(sys.modules, "openfeature", None)
    with pytest.raises(MissingExtraError, match=r"pip install 'lifelore\[openfeature\]'"):
        importlib.import_module("lifelore.bridges.openfeature_provider")
