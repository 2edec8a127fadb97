"""`lifelore serve`: where the memory comes from, and tokens of studies."""

import pytest

pytest.importorskip("fastapi", reason="needs the extra web")

from lifelore.app.service.tokens import TokenFile

SECRET = "postgresql://user:word@here/db"


@pytest.fixture
def settings_of(ask, monkeypatch):
    """The settings that the command line would serve with."""
    served = []
    monkeypatch.setattr(
        "lifelore.app.service.server.serve", lambda settings, *rest, **more: served.append(settings)
    )

    def settings_of(*arguments):
        assert ask("serve", *arguments).status == 0
        return served[-1]

    return settings_of


def test_the_memory_comes_from_a_file_or_the_environment(settings_of, tmp_path, monkeypatch):
    (tmp_path / "secret").write_text(SECRET + "\n")
    assert settings_of("--memory-file", tmp_path / "secret").memory == SECRET
    monkeypatch.setenv("LIFELORE_MEMORY", SECRET)
    assert settings_of().memory == SECRET
    assert settings_of("--memory", "own.db").memory == "own.db"


def test_a_memory_file_that_is_none_is_refused(ask, tmp_path):
    assert "memory-file" in ask("serve", "--memory-file", tmp_path / "none").refusal
    (tmp_path / "two").write_text("a\nb\n")
    assert "one line" in ask("serve", "--memory-file", tmp_path / "two").refusal


def test_groups_are_chosen(settings_of, ask):
    assert settings_of("--only", "personalise,memory").only == ["personalise", "memory"]
    assert "got 'all'" in ask("serve", "--only", "all").refusal


def test_a_token_of_a_study(ask, tmp_path):
    file = str(tmp_path / "tokens")
    made = ask(
        "serve", "--token-file", file, "--add-token", "shop", "--scopes", "write", "--study", "my shop", "--json"
    )
    assert TokenFile(file).find(made.document["token"])[1::2] == ({"write"}, {"my shop"})
