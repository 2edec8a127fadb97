"""BEAT over HTTP: as the learner in this process, each move once, also after a restart."""

import numpy as np
import pytest

LIBRARY = {
    "types": ["steady", "shaky"], "policies": ["slow", "fast"],
    "means": [[0.4, 1.0], [0.8, 0.3]], "deviations": 0.1,
    "signals": [[[0.9, 0.1], [0.8, 0.2]], [[0.6, 0.4], [0.2, 0.8]]], "categories": ["hit", "miss"],
}  # fmt: skip
MOVES = [("fast", "miss"), ("fast", "miss"), ("slow", "hit"), ("fast", "miss")]
USER = "/v1/adaptations/game/user?user=ada"


@pytest.fixture
def game(serve, where):
    """A client of a service with the adaptation `game`."""
    client = serve(where)
    answer = client.put("/v1/adaptations/game", json={"library": LIBRARY})
    assert answer.status_code == 200, answer.text
    return client


def move(client, step, moves, **fields):
    listed = [{"action_set": action_set, "signal": signal} for action_set, signal in moves]
    return client.post("/v1/adaptations/game/moves", json={"user": "ada", "step": step, "moves": listed} | fields)


def test_moves_count_once(game, serve, where):
    first = move(game, 0, MOVES, ends_episode=True).json()
    assert (first["taken"], first["step"], first["episode"]) == (True, 4, 1)
    again = serve(where)
    repeated = move(again, 0, MOVES, ends_episode=True).json()
    assert repeated == first | {"taken": False}
    assert "step must be 4" in move(again, 5, MOVES).json()["error"]["message"]
    assert move(again, 3, MOVES).status_code == 422
    assert move(again, 4, [("fast", "hit")]).json()["step"] == 5


@pytest.mark.parametrize("moves", [[("fast", "wide")], [("brisk", "hit")], [("fast", [[0, 1, 2]])], [("fast", 0)]])
def test_a_wrong_move_changes_nothing(game, moves):
    before = game.get(USER).json()
    assert move(game, 0, [*MOVES, *moves]).status_code in (404, 422)
    assert game.get(USER).json() == before


def test_another_library_starts_users_anew_and_the_same_does_not(game):
    move(game, 0, MOVES)
    game.put("/v1/adaptations/game", json={"library": LIBRARY})
    assert game.get(USER).json()["step"] == 4
    game.put("/v1/adaptations/game", json={"library": LIBRARY | {"deviations": 0.2}})
    assert game.get(USER).json()["step"] == 0
    assert move(game, 0, MOVES).json()["taken"]
    # Back to the first library: what was learnt under it belongs to another registration.
    game.put("/v1/adaptations/game", json={"library": LIBRARY})
    assert move(game, 0, MOVES).json()["taken"]


def test_exploration_has_its_probability(game):
    game.put("/v1/adaptations/game", json={"library": LIBRARY, "epsilon": 0.4})
    answers = [game.get(f"/v1/adaptations/game/user?user=user {number}").json() for number in range(60)]
    for answer in answers:
        assert np.isclose(answer["probability"], 0.8 if answer["action_set"] == "fast" else 0.2)
    assert {answer["action_set"] for answer in answers} == {"slow", "fast"}


def test_a_forgotten_user_starts_from_the_prior(game):
    for _ in range(2):
        assert [move(game, step, [one]).json()["taken"] for step, one in enumerate(MOVES)] == [True] * 4
        assert game.delete(USER).json()["forgotten"] == 4
        assert game.delete(USER).status_code == 404
        assert game.get(USER).json()["step"] == 0
