"""The stored files, unpacked."""

import shutil
from pathlib import Path

import pytest


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """A folder with a folder for each archive."""
    root = tmp_path_factory.mktemp("stored")
    for archive in Path(__file__).parent.glob("*.zip"):
        shutil.unpack_archive(archive, root / archive.stem)
    return root
