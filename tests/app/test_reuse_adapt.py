"""`lifelore reuse adapt`: one JSON line out for each move, as the learner in this process, each move once."""

import io
import json

import pytest

from lifelore.interaction import Beat, CategorySignal, PolicyLibrary

FIELDS = {
    "types": ["steady", "shaky"], "policies": ["slow", "fast"],
    "means": [[0.4, 1.0], [0.8, 0.3]], "deviations": 0.1,
    "signals": [[[0.9, 0.1], [0.8, 0.2]], [[0.6, 0.4], [0.2, 0.8]]], "categories": ["hit", "miss"],
}  # fmt: skip
MOVES = [("fast", "miss"), ("fast", "miss"), ("slow", "hit")]


def move(action_set, signal, **fields):
    return {"user": "ada", "action_set": action_set, "signal": signal, **fields}


@pytest.fixture
def adapted(tmp_path, ask, monkeypatch):
    """What the verb answers to lines on stdin, one memory for all calls."""
    path = tmp_path / "game.json"
    path.write_text(json.dumps(FIELDS))

    def adapted(*lines, library=path, options=()):
        text = "".join((line if isinstance(line, str) else json.dumps(line)) + "\n" for line in lines)
        monkeypatch.setattr("sys.stdin", io.StringIO(text))
        return ask("reuse", "adapt", library, "--memory", tmp_path / "lake.db", *options)

    return adapted


def objects(answer):
    assert answer.status == 0, answer
    return [json.loads(line) for line in answer.out.splitlines()]


def test_each_line_has_the_set_that_the_learner_selects(adapted):
    signal = CategorySignal(FIELDS["signals"], FIELDS["categories"])
    beat = Beat(PolicyLibrary.from_means(FIELDS["means"], 0.1, policies=FIELDS["policies"], signal=signal))
    first, *others = objects(adapted({"user": "ada"}, *(move(*one) for one in MOVES)))
    assert (first["action_set"], first["step"]) == ("fast", 0)
    for step, (one, answer) in enumerate(zip(MOVES, others, strict=True), 1):
        beat.update(*one)
        assert list(answer["belief"].values()) == beat.belief.tolist()
        assert (answer["action_set"], answer["step"]) == (FIELDS["policies"][beat.select()], step)
    assert others[0]["action_set"] == "slow"


def test_memory_goes_on_and_counts_numbered_moves_once(adapted):
    once = objects(adapted(move("fast", "miss", step=0), move("fast", "miss", step=1, ends_episode=True)))
    again = objects(adapted(move("fast", "miss", step=1, ends_episode=True), {"user": "ben"}))
    assert again[0] == once[1]
    assert (again[0]["step"], again[0]["episode"], again[1]["step"]) == (2, 1, 0)
    assert objects(adapted(move("fast", "miss")))[0]["step"] == 3


def test_a_forgotten_user_starts_again(adapted):
    gone, again = objects(adapted(move("fast", "miss"), {"user": "ada", "forget": True}, {"user": "ada"}))[1:]
    assert (gone["user"], again["step"], again["belief"]) == ("ada", 0, {"steady": 0.5, "shaky": 0.5})
    assert gone["forgotten"] > 0
    assert "nothing is stored of user 'ben'" in adapted({"user": "ben", "forget": True}).refusal


def test_a_saved_library_and_one_document(adapted, tmp_path):
    signal = CategorySignal(FIELDS["signals"], FIELDS["categories"])
    library = PolicyLibrary.from_means(FIELDS["means"], 0.1, FIELDS["types"], FIELDS["policies"], signal=signal)
    library.save(tmp_path / "game.npz")
    document = adapted(
        {"user": "ada"}, library=tmp_path / "game.npz", options=("--json", "--epsilon", "1/n")
    ).document
    expected = objects(adapted({"user": "ada"}, options=("--name", "other", "--epsilon", "1/n")))
    assert document == {"adaptation": "default", "steps": document["steps"]}
    assert document["steps"][0] | {"action_set": "any"} == expected[0] | {"action_set": "any"}
    assert expected[0]["probability"] == 0.5


@pytest.mark.parametrize(
    ("line", "rule"),
    [
        ("oops", "stdin line 2: not JSON"),
        ({"action_set": "fast", "signal": "miss"}, "line 2: user must be a name, got None"),
        (move("brisk", "hit"), "line 2: unknown policy 'brisk'"),
        (move("fast", "wide"), "line 2: "),
        (move("fast", "hit", step=9), "line 2: step must be 1"),
        (move("fast", "hit", step=-1), "line 2: step must be a whole number from 0, got -1"),
        (move("fast", "hit", ends_episode="no"), "line 2: ends_episode must be true or false"),
        (move("fast", "hit", reward=3), "line 2: a move must have user, action_set, signal"),
    ],
)
def test_a_wrong_line_ends_it_after_the_lines_before(line, rule, adapted):
    answer = adapted(move("fast", "miss"), line)
    assert (answer.status, len(answer.out.splitlines())) == (2, 1)
    assert rule in answer.err
    assert answer.err.count("\n") == 1
    assert objects(adapted({"user": "ada"}))[0]["step"] == 1


@pytest.mark.parametrize(
    ("content", "rule"),
    [
        (b"{oops", "must be one JSON object"),
        (b"PK\x03\x04 torn", "game.bin"),
        (b'{"means": [[1]]}', "must have deviations"),
    ],
)
def test_a_damaged_library_is_refused(content, rule, adapted, tmp_path):
    (tmp_path / "game.bin").write_bytes(content)
    assert rule in adapted({"user": "ada"}, library=tmp_path / "game.bin").refusal
    assert "epsilon must be a number or one of 1/n" in adapted(options=("--epsilon", "often")).refusal
