"""Decisions and outcomes over HTTP: as the command line stores them, once for each request."""

import math

from lifelore.agent.personalise.decisions import choose
from lifelore.agent.personalise.study import open_study
from lifelore.interaction.beliefs.learnt_dynamics import HAZARD_WEIGHTS, HAZARDS
from lifelore.memory import open_memory


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


def test_an_outcome_moves_the_belief_by_bayes_rule(client):
    made = decide(client)
    assert made["belief"] == {"calm": 0.5, "lively": 0.5}
    assert made["probability"] == 1.0
    policy = ["slow", "fast"].index(made["policy"])
    after = observe(client, made["decision"], 8.0).json()
    assert after["taken"]
    assert math.isclose(after["belief"]["calm"], belief_after(policy, 8.0), abs_tol=1e-12)


def test_the_same_request_gets_the_same_decision_and_is_stored_once(client, where):
    first = decide(client, request="monday")
    again = decide(client, request="monday")
    other = decide(client, request="tuesday")
    assert (first["repeated"], again["repeated"], other["repeated"]) == (False, True, False)
    for key in ("decision", "policy", "probability", "available", "control", "number"):
        assert again[key] == first[key]
    assert other["decision"] != first["decision"]
    assert client.get("/v1/studies/s/users/ada").json()["decisions"] == 2
    # Another user may use the same identifier.
    assert not decide(client, "ben", request="monday")["repeated"]


def test_a_request_keeps_its_decision_after_a_restart_and_after_others(client, serve, where):
    first = decide(client, request="monday", available=["fast"])
    assert first["policy"] == "fast"
    decide(client)
    again = decide(serve(where), request="monday")
    assert again["repeated"]
    assert (again["decision"], again["policy"], again["available"]) == (first["decision"], "fast", ["fast"])


def test_a_late_outcome_counts_once(client):
    first, second = decide(client), decide(client)
    assert observe(client, second["decision"], 3.0).json()["taken"]
    late = observe(client, first["decision"], 8.0).json()
    assert late["taken"]
    again = observe(client, first["decision"], 8.0).json()
    assert not again["taken"]
    assert again["belief"] == late["belief"]
    refused = observe(client, first["decision"], 7.0)
    assert refused.status_code == 422
    assert "ended with 8 already" in refused.json()["error"]["message"]


def test_only_available_policies_are_chosen(client):
    for policy in ("slow", "fast"):
        made = decide(client, available=[policy])
        assert (made["policy"], made["probability"], made["available"]) == (policy, 1.0, [policy])
    refused = client.post("/v1/studies/s/decisions", json={"user": "ada", "available": ["brisk"]})
    assert refused.status_code == 404
    assert "brisk" in refused.json()["error"]["message"]


def test_the_command_line_sees_the_same_user(client, where):
    made = decide(client)
    observe(client, made["decision"], 8.0)
    with open_memory(where) as memory:
        own = choose(memory, open_study(memory, "s"), "ada")
    assert own["number"] == 1
    assert client.get("/v1/studies/s/users/ada").json()["decisions"] == 2


def test_a_batch_answers_each_item(client):
    items = [{"user": "ada"}, {"user": "ben", "available": ["brisk"]}, {"user": "ada"}]
    answers = client.post("/v1/studies/s/decisions/batch", json={"items": items}).json()["items"]
    assert [answer.get("number") for answer in answers] == [0, None, 1]
    assert answers[1]["error"]["kind"] == "not found"
    outcomes = [{"decision": answer["decision"], "outcome": 8.0} for answer in answers if "decision" in answer]
    taken = client.post("/v1/studies/s/outcomes/batch", json={"items": [*outcomes, outcomes[0]]}).json()["items"]
    assert [answer["taken"] for answer in taken] == [True, True, False]


def test_the_explanation_names_evidence_and_next_choice(client):
    made = decide(client, available=["slow"])
    observe(client, made["decision"], 8.0)
    shown = client.get("/v1/studies/s/users/ada").json()
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


def test_a_forgotten_user_is_a_stranger(client):
    observe(client, decide(client, request="monday")["decision"], 8.0)
    assert client.delete("/v1/studies/s/users/ada").json() == {"user": "ada", "forgotten": 2}
    assert client.get("/v1/studies/s/users/ada").status_code == 404
    assert decide(client, request="monday")["belief"] == {"calm": 0.5, "lively": 0.5}
