from pathlib import Path

import pytest

from lifelore.core.errors import InputError
from lifelore.memory.location import default_path, describe, locate


def test_the_default_lies_in_the_users_data_directory(monkeypatch):
    monkeypatch.setenv("XDG_DATA_HOME", "/data/me")
    assert locate(None) == default_path() == Path("/data/me/lifelore/lifelore.db")


def test_a_path_becomes_absolute(monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    assert locate("here.db") == tmp_path / "here.db"
    assert locate(Path("~/m.db")) == Path.home() / "m.db"


@pytest.mark.parametrize("scheme", ["postgresql", "postgres", "postgresql+psycopg"])
def test_urls_get_the_psycopg_driver_and_hide_the_password(scheme):
    url = locate(f"{scheme}://me:s3cret@host:1/lore?sslmode=require&password=s3cret")
    assert url.drivername == "postgresql+psycopg"
    assert url.password == "s3cret"
    assert describe(url).startswith("postgresql://me:***@host:1/lore?")
    assert "s3cret" not in describe(url)


def test_a_broken_url_is_not_repeated():
    with pytest.raises(InputError) as refused:
        locate("postgresql://me:s3cret@host:port/lore")
    assert "s3cret" not in str(refused.value)
