"""Panels: batches by the batched engine, stored before they are answered, each request and outcome once."""

import math

import pytest


def decide(client, users, status=200, **fields):
    answer = client.post("/v1/studies/s/panel/decisions", json={"users": users} | fields)
    assert answer.status_code == status, answer.text
    return answer.json()


def observe(client, batch, outcomes, **fields):
    return client.post("/v1/studies/s/panel/outcomes", json={"batch": batch, "outcomes": outcomes} | fields)


def beliefs(client, users):
    return client.post("/v1/studies/s/panel/beliefs", json={"users": users}).json()["beliefs"]


def test_a_batch_learns_as_one_user_does(client):
    """The beliefs of the batched engine are those of the routes for a single user."""
    single = client.post("/v1/studies/s/decisions", json={"user": "ada", "available": ["slow"]}).json()
    after = client.post("/v1/studies/s/outcomes", json={"decision": single["decision"], "outcome": 8.0}).json()
    made = decide(client, ["ada", "ben"], available=["slow"])
    assert (made["policies"], made["chosen"]) == (["slow", "fast"], [0, 0])
    assert observe(client, made["batch"], [8.0, 3.0]).json() == {"taken": 2, "known": 0}
    ada, ben = beliefs(client, ["ada", "ben"])
    assert math.isclose(ada["calm"], after["belief"]["calm"], abs_tol=1e-12)
    assert ben["lively"] > 0.9


def test_a_request_and_an_outcome_count_once_also_after_a_restart(client, serve, where):
    made = decide(client, ["ada", "ben"], request="monday")
    assert observe(client, made["batch"], [8.0], places=[0]).json() == {"taken": 1, "known": 0}
    before = beliefs(client, ["ada", "ben", "carl"])
    for one in (client, serve(where)):
        again = decide(one, ["ada", "ben"], request="monday")
        assert again == made | {"repeated": True}
        assert observe(one, made["batch"], [8.0], places=[0]).json() == {"taken": 0, "known": 1}
        assert beliefs(one, ["ada", "ben", "carl"]) == before
        assert one.get("/v1/studies/s/panel").json()["users"] == 2
    assert before[1] == before[2] == {"calm": 0.5, "lively": 0.5}


def test_masks_hold_for_each_user(client):
    made = decide(client, ["ada", "ben", "carl"], masks=[[True, False], [False, True], [True, True]])
    assert made["chosen"][:2] == [0, 1]
    assert made["probability"] == [1.0, 1.0, 1.0]
    assert "leave every user" in decide(client, ["ada"], 422, masks=[[False, False]])["error"]["message"]
    assert "row of 2" in decide(client, ["ada"], 422, masks=[[True]])["error"]["message"]
    assert "row of 2" in decide(client, ["ada", "ben"], 422, masks=[[True, False], [True]])["error"]["message"]
    decide(client, ["ada"], 404, available=["brisk"])
    decide(client, ["a\nb"], 422)


@pytest.mark.parametrize(
    ("fields", "status"),
    [
        ({"outcomes": [1.0]}, 422),
        ({"outcomes": [1.0], "places": [2]}, 422),
        ({"outcomes": [1.0], "places": [-1]}, 422),
        ({"outcomes": [1.0, 2.0], "places": [0, 0]}, 422),
        ({"outcomes": [1e200, 1.0]}, 422),
        ({"batch": "none", "outcomes": [1.0]}, 404),
    ],
)
def test_a_wrong_outcome_changes_nothing(client, fields, status):
    made = decide(client, ["ada", "ben"])
    before = beliefs(client, ["ada"])
    assert observe(client, **({"batch": made["batch"]} | fields)).status_code == status
    assert beliefs(client, ["ada"]) == before


def test_the_share_of_choices_is_their_probability(client, study):
    """Of 20,000 choices with 40 % exploration, within four standard errors of a binomial share."""
    client.put("/v1/studies/s", json=study | {"explore": 0.4, "control": 0.0})
    n = 20_000
    made = decide(client, [f"user {number}" for number in range(n)])
    assert set(made["probability"]) == {0.800000011920929, 0.20000000298023224}
    share = sum(place == 0 for place in made["chosen"]) / n
    assert abs(share - 0.8) < 4 * math.sqrt(0.8 * 0.2 / n)


def test_the_control_group_is_a_share_of_the_users(client, study):
    client.put("/v1/studies/s", json=study | {"control": 0.25, "incumbent": "fast"})
    n = 10_000
    made = decide(client, [f"user {number}" for number in range(n)])
    control = [place for place, held in zip(made["chosen"], made["control"], strict=True) if held]
    assert abs(len(control) / n - 0.25) < 4 * math.sqrt(0.25 * 0.75 / n)
    assert set(control) == {1}
