from pathlib import Path

import pytest

from lifelore.core.errors import InputError
from lifelore.memory.location import Server, default_path, describe, locate


def test_the_default_lies_in_the_users_data_directory(monkeypatch):
    monkeypatch.setenv("XDG_DATA_HOME", "/data/me")
    assert locate(None) == default_path() == Path("/data/me/lifelore/lifelore.db")


def test_a_path_becomes_absolute(monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    assert locate("here.db") == tmp_path / "here.db"
    assert locate(Path("~/m.db")) == Path.home() / "m.db"


@pytest.mark.parametrize("scheme", ["postgresql", "postgres", "postgresql+psycopg"])
def test_urls_are_taken_apart_and_hide_the_password(scheme):
    server = locate(f"{scheme}://me:s3cr%65t@host:1/lore?sslmode=require&sslp%61ssword=s3cret")
    assert isinstance(server, Server)
    assert server.options == {
        "user": "me", "password": "s3cret", "host": "host", "port": "1", "dbname": "lore", "sslmode": "require",
        "sslpassword": "s3cret",
    }  # fmt: skip
    assert describe(server) == "postgresql://me:***@host:1/lore?sslmode=require&sslpassword=***"
    assert "s3cr" not in repr(server)


def test_a_database_without_a_file_is_refused():
    with pytest.raises(InputError, match=r"memory must be stored, got ':memory:'; name a file"):
        locate(":memory:")


@pytest.mark.parametrize(
    ("url", "options"),
    [
        ("postgresql://", {}),
        ("postgresql:///lore?host=/run/pg", {"dbname": "lore", "host": "/run/pg"}),
        ("postgresql://[::1]:5432/lore", {"host": "::1", "port": "5432", "dbname": "lore"}),
        ("postgresql://me@host", {"user": "me", "host": "host"}),
        ("postgresql://me:a%23b@host/l", {"user": "me", "password": "a#b", "host": "host", "dbname": "l"}),
    ],
)
def test_every_part_of_a_url_may_be_missing(url, options):
    server = locate(url)
    assert isinstance(server, Server)
    assert server.options == options


def test_a_broken_url_is_not_repeated():
    with pytest.raises(InputError) as refused:
        locate("postgresql://me:s3cret?#/@host/lore")
    assert "s3cret" not in str(refused.value)
    assert refused.value.__cause__ is None
