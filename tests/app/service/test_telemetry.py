"""Metrics of studies, and of requests as Prometheus reads them."""

from prometheus_client.parser import text_string_to_metric_families

from lifelore.app.service import telemetry
from lifelore.app.service.telemetry import Metrics

ARM = ("study", "policy", "group")


def samples(metrics: Metrics, name: str, *labels: str) -> dict[tuple[str, ...], float]:
    families = text_string_to_metric_families(metrics.text().decode())
    return {
        tuple(sample.labels[label] for label in labels or ARM): sample.value
        for family in families
        for sample in family.samples
        if sample.name == name
    }


def test_decisions_and_outcomes_are_counted_by_arm():
    metrics = Metrics()
    metrics.decided("s", "slow", False)
    metrics.decided("s", "slow", False, 2)
    metrics.decided("s", "slow", True, 5)
    metrics.observed("s", "slow", False, 2, 7.5)
    metrics.observed("s", "slow", True, 1, -9.0)
    assert samples(metrics, "lifelore_study_decisions_total") == {
        ("s", "slow", "treated"): 3, ("s", "slow", "control"): 5,
    }  # fmt: skip
    assert samples(metrics, "lifelore_study_outcome_sum") == {
        ("s", "slow", "treated"): 7.5, ("s", "slow", "control"): -9.0,
    }  # fmt: skip


def test_arms_have_a_largest_number(monkeypatch):
    monkeypatch.setattr(telemetry, "MOST_ARMS", 2)
    metrics = Metrics()
    for number in range(5):
        metrics.decided("s", f"policy {number}", False)
    metrics.decided("s", "policy 1", False)
    assert samples(metrics, "lifelore_study_decisions_total") == {
        ("s", "policy 0", "treated"): 1, ("s", "policy 1", "treated"): 2, ("other", "other", "treated"): 3,
    }  # fmt: skip


def test_times_fall_into_their_buckets():
    metrics = Metrics()
    for seconds in (0.0005, 0.001, 0.0011, 0.3, 100.0):
        metrics.count("GET", "/a", 200, seconds)
    buckets = {le: count for (le,), count in samples(metrics, "lifelore_request_seconds_bucket", "le").items()}
    assert (buckets["0.001"], buckets["0.002"], buckets["0.25"], buckets["0.5"]) == (2, 3, 3, 4)
    assert (buckets["60.0"], buckets["+Inf"]) == (4, 5)
    assert samples(metrics, "lifelore_request_seconds_count", "route")[("/a",)] == 5
    assert abs(samples(metrics, "lifelore_request_seconds_sum", "route")[("/a",)] - 100.3026) < 1e-9
    assert samples(metrics, "lifelore_requests_total", "method", "route", "status")[("GET", "/a", "200")] == 5
