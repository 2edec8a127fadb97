"""Tokens: stored as hashes only, in a file for their owner only."""

import pytest

from lifelore.app.service.tokens import TokenFile, add_token
from lifelore.core.errors import InputError, NotFoundError


def test_a_token_is_found_and_never_stored(tmp_path):
    file = tmp_path / "tokens"
    token = add_token(str(file), "shop", ["read", "write"])
    other = add_token(str(file), "desk", ["read"])
    text = file.read_text()
    assert token not in text
    assert other not in text
    assert file.stat().st_mode & 0o777 == 0o600
    tokens = TokenFile(str(file))
    assert (tokens.find(token).name, tokens.find(token).scopes) == ("shop", {"read", "write"})
    assert (tokens.find(other).name, tokens.find(other).scopes) == ("desk", {"read"})
    assert tokens.find(token[:-1]) is None
    assert tokens.find("\udcff") is None


@pytest.mark.parametrize(("name", "scopes"), [("shop", ["owner"]), ("", ["read"]), ("a b", ["read"]), ("x", [])])
def test_a_name_or_scope_that_breaks_its_rule_is_refused(tmp_path, name, scopes):
    with pytest.raises(InputError, match="token must be a name"):
        add_token(str(tmp_path / "tokens"), name, scopes)
    assert not (tmp_path / "tokens").exists()


def test_a_name_comes_once(tmp_path):
    file = str(tmp_path / "tokens")
    add_token(file, "shop", ["read"])
    with pytest.raises(InputError, match="'shop' is in"):
        add_token(file, "shop", ["write"])


def test_a_wrong_line_is_not_repeated(tmp_path):
    file = tmp_path / "tokens"
    file.write_text("# tokens\nshop read my-plain-secret\n")
    with pytest.raises(InputError, match="line 2") as refused:
        TokenFile(str(file))
    assert "my-plain-secret" not in str(refused.value)
    file.write_text("")
    with pytest.raises(InputError, match="must hold a token"):
        TokenFile(str(file))
    with pytest.raises(NotFoundError, match="--add-token"):
        TokenFile(str(tmp_path / "none"))


def test_a_token_may_be_for_some_studies(tmp_path):
    file = str(tmp_path / "tokens")
    token = add_token(file, "shop", ["write"], ["my shop, 2", "Käse@home"])
    found = TokenFile(file).find(token)
    assert (found.scopes, found.studies) == ({"write"}, {"my shop, 2", "Käse@home"})


def test_admin_includes_the_other_scopes(tmp_path):
    file = str(tmp_path / "tokens")
    token = add_token(file, "boss", ["admin"])
    assert TokenFile(file).find(token).scopes == {"read", "write", "admin"}


def test_a_changed_file_is_read_again_within_a_second(tmp_path):
    now = 0.0
    file = tmp_path / "tokens"
    first, second = add_token(str(file), "first", ["read"]), add_token(str(file), "second", ["read"])
    tokens = TokenFile(str(file), clock=lambda: now)
    lines = file.read_text().splitlines()
    file.write_text(lines[1] + "\nbroken\n")
    assert tokens.find(first) is not None, "at most once a second"
    now = 1.1
    assert tokens.find(first) is None
    assert tokens.find(second).name == "second", "a broken line takes no other token away"
    file.unlink()
    now = 2.2
    assert tokens.find(second) is None
