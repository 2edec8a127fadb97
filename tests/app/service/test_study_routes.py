"""Decisions and outcomes over HTTP: as the command line stores them, once for each request."""

import csv
import io
import json
import math

from lifelore.interaction.beliefs.learnt_dynamics import HAZARD_WEIGHTS, HAZARDS

LIBRARY = {"types": ["calm", "lively"], "means": [[8.0, 2.0], [3.0, 8.5]], "deviations": 2.0}


def decide(client, user="ada", **fields):
    answer = client.post("/v1/studies/s/decisions", json={"user": user} | fields)
    assert answer.status_code == 200, answer.text
    return answer.json()


def observe(client, decision, outcome):
    return client.post("/v1/studies/s/outcomes", json={"decision": decision, "outcome": outcome})


def belief_after(policy: int, outcome: float) -> float:
    """β(calm) after an outcome and an episode, by Bayes' rule from a uniform prior, worked by hand."""
    change = HAZARDS @ HAZARD_WEIGHTS / HAZARD_WEIGHTS.sum()
    means = ((8.0, 2.0), (3.0, 8.5))
    weights = [math.exp(-((outcome - means[kind][policy]) ** 2) / (2 * 2.0**2)) for kind in (0, 1)]
    posterior = weights[0] / sum(weights)
    return (1 - change) * posterior + change * 0.5


def test_a_request_keeps_its_decision_after_a_restart_and_after_others(client, serve, place):
    first = decide(client, request="monday", available=["fast"])
    assert first["policy"] == "fast"
    decide(client)
    again = decide(serve(place), request="monday", available=["fast"])
    assert again["repeated"]
    assert (again["decision"], again["policy"], again["available"]) == (first["decision"], "fast", ["fast"])


def test_a_batch_answers_each_item(client):
    items = [{"user": "ada"}, {"user": "ben", "available": ["brisk"]}, {"user": "ada"}]
    answers = client.post("/v1/studies/s/decisions/batch", json={"items": items}).json()["items"]
    assert answers[1]["error"]["kind"] == "not found"
    assert answers[0]["decision"] != answers[2]["decision"]
    outcomes = [{"decision": answer["decision"], "outcome": 8.0} for answer in answers if "decision" in answer]
    taken = client.post("/v1/studies/s/outcomes/batch", json={"items": [*outcomes, outcomes[0]]}).json()["items"]
    assert [answer["taken"] for answer in taken] == [True, True, False]


def test_the_explanation_names_evidence_and_next_choice(client):
    made = decide(client, available=["slow"])
    observe(client, made["decision"], 8.0)
    shown = client.get("/v1/studies/s/user?name=ada").json()
    assert list(shown["belief"]) == ["calm", "lively"]
    assert math.isclose(shown["belief"]["calm"], belief_after(0, 8.0), abs_tol=1e-12)
    assert shown["probabilities"] == {"slow": 1.0, "fast": 0.0}
    (evidence,) = shown["evidence"]
    # Log densities of 8 under Normal(8, 2²) and Normal(3, 2²) differ by 25 / 8.
    assert evidence["policy"] == "slow"
    assert evidence["types"]["calm"] == 0.0
    assert math.isclose(evidence["types"]["lively"], -25 / 8, abs_tol=1e-12)
    assert shown["last"][0]["probability"] == 1.0
    assert shown["last"][0]["outcome"] == 8.0


def test_names_of_any_characters_can_be_read_and_forgotten(client):
    for name in ("google-oauth2/117", "50% off", "ада ☃", "a&b=c?#", "../x"):
        decide(client, name)
        assert client.get("/v1/studies/s/user", params={"name": name}).json()["decisions"] == 1
        forgotten = client.delete("/v1/studies/s/user", params={"name": name}).json()
        assert forgotten == {"user": name, "forgotten": 1}
        assert client.get("/v1/studies/s/user", params={"name": name}).status_code == 404


def test_policies_of_any_name_can_be_retired(client):
    library = LIBRARY | {"policies": ["50% off / sale", "fast"]}
    assert client.put("/v1/studies/shop", json={"library": library}).status_code == 200
    change = {"policy": "50% off / sale", "state": "retired"}
    assert client.put("/v1/studies/shop/policies", json=change).json()["state"] == "retired"
    made = client.post("/v1/studies/shop/decisions", json={"user": "ada"}).json()
    assert made["policy"] == "fast"


def test_only_numbers_are_outcomes_and_only_one_is_taken(client):
    made = decide(client)["decision"]
    for outcome in ("7", True, None, [1], 1e200):
        refused = observe(client, made, outcome)
        assert (refused.status_code, "outcome" in refused.json()["error"]["message"]) == (422, True), outcome
    assert [observe(client, made, 8.0).json()["taken"] for _ in range(2)] == [True, False]
    refused = observe(client, made, 7.0)
    assert (refused.status_code, "ended with 8 already" in refused.json()["error"]["message"]) == (422, True)


def test_outcomes_of_another_system_count_once(client):
    lines = [
        {"user": "ada", "policy": "slow", "outcome": 8.0, "time": 1.7e9},
        {"user": "ada", "policy": "fast", "outcome": 2.0, "time": 1.7e9 + 60},
        {"id": "order 7", "user": "ben", "policy": "slow", "outcome": 3.0},
    ]
    for items, rows, known in ((lines[:2], 2, 0), (lines, 1, 2)):
        answer = client.post("/v1/studies/s/past", json={"items": items}).json()
        assert (answer["rows"], answer["known"]) == (rows, known)
    assert client.post("/v1/studies/s/past", json={"items": lines[::-1]}).json()["rows"] == 0
    belief = client.get("/v1/studies/s/user?name=ada").json()["belief"]
    assert max(belief, key=belief.get) == "calm"


def test_strangers_get_what_the_table_says(client):
    table = client.get("/v1/studies/s/table").json()
    made = decide(client, "stranger")
    assert table["default"] == made["probabilities"]
    assert table["contexts"] == {}


def test_the_log_pages_by_a_cursor(client):
    made = [decide(client, f"user {number}")["decision"] for number in range(5)]
    first = client.get("/v1/studies/s/log?format=ndjson&limit=2").text.splitlines()
    rest = client.get(
        "/v1/studies/s/log", params={"format": "ndjson", "cursor": json.loads(first[-1])["decision"]}
    ).text.splitlines()
    assert sorted(json.loads(line)["decision"] for line in [*first, *rest]) == sorted(made)
    text = client.get("/v1/studies/s/log").text
    assert len(list(csv.DictReader(io.StringIO(text)))) == 5
    assert client.get("/v1/studies/s/log?cursor=nonsense").status_code == 422


def test_an_archived_study_takes_no_decisions_and_a_deleted_one_is_gone(client):
    made = decide(client)
    assert client.put("/v1/studies/s/state", json={"state": "archived"}).json()["state"] == "archived"
    assert {"name": "s", "state": "archived"} in client.get("/v1/studies").json()["studies"]
    assert client.post("/v1/studies/s/decisions", json={"user": "ada"}).status_code == 422
    assert observe(client, made["decision"], 8.0).json()["taken"]
    assert client.delete("/v1/studies/s").status_code == 200
    assert client.get("/v1/studies/s").status_code == 404


def test_metrics_count_by_study_and_policy(client):
    client.put("/v1/studies/counted", json={"library": LIBRARY | {"policies": ["slow", "fast"]}, "control": 0.0})
    made = client.post("/v1/studies/counted/decisions", json={"user": "ada"}).json()
    for _ in range(2):
        outcome = {"decision": made["decision"], "outcome": 8.0}
        assert client.post("/v1/studies/counted/outcomes", json=outcome).status_code == 200
    text = client.get("/metrics").text
    labels = f'{{group="treated",policy="{made["policy"]}",study="counted"}}'
    assert f"lifelore_study_decisions_total{labels} 1.0" in text
    assert f"lifelore_study_outcomes_total{labels} 1.0" in text
    assert f"lifelore_study_outcome_sum{labels} 8.0" in text
