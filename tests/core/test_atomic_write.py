"""A file written in one step is there as a whole, or as it was."""

import pytest

from lifelore.core.atomic_write import atomic_write


def test_the_file_takes_its_place_when_the_block_ends(tmp_path):
    path = tmp_path / "kept"
    path.write_bytes(b"old")
    with atomic_write(path) as file:
        file.write(b"new")
        file.flush()
        assert path.read_bytes() == b"old"
    assert path.read_bytes() == b"new"
    assert list(tmp_path.iterdir()) == [path]


@pytest.mark.parametrize("why", [ValueError, KeyboardInterrupt])
def test_a_block_that_ends_badly_changes_nothing(tmp_path, why):
    path = tmp_path / "kept"
    path.write_bytes(b"old")

    def half(file):
        file.write(b"half")
        raise why

    with pytest.raises(why), atomic_write(path) as file:
        half(file)
    assert path.read_bytes() == b"old"
    assert list(tmp_path.iterdir()) == [path]


def test_a_link_stays_one(tmp_path):
    path, link = tmp_path / "kept", tmp_path / "link"
    path.write_bytes(b"old")
    link.symlink_to(path)
    with atomic_write(link) as file:
        file.write(b"new")
    assert link.is_symlink()
    assert path.read_bytes() == b"new"
