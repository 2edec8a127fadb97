"""Arrays with a JSON header as one npz archive without pickle; equal content gives equal bytes.

The header is the archive's array ``about``: UTF-8 JSON as uint8, with format and version. Archives come from
anywhere: too large, of another format, newer or damaged ones raise an InputError of one line.
"""

import io
import json
import zipfile
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, BinaryIO

import numpy as np
from numpy.typing import NDArray

from lifelore.core.errors import InputError

Arrays = dict[str, NDArray[Any]]


@dataclass(frozen=True)
class PackedFormat:
    """A kind of archive.

    Parameters
    ----------
    name : str
        The header's ``format``.
    version : int
    what, writer : str
        For error messages: "action prior", and the function that writes one.
    largest : int
        Largest size in bytes after unpacking, so that no file fills the memory.
    oldest : int, optional
        Oldest version that the caller can read; by default only `version`.
    """

    name: str
    version: int
    what: str
    writer: str
    largest: int = 2**33
    oldest: int | None = None

    def pack(self, header: Mapping[str, Any], arrays: Mapping[str, NDArray[Any]]) -> bytes:
        """The archive's bytes, compressed; see `write`."""
        stream = io.BytesIO()
        self.write(stream, header, arrays)
        return stream.getvalue()

    def write(
        self, file: BinaryIO, header: Mapping[str, Any], arrays: Mapping[str, NDArray[Any]], compress: bool = True
    ) -> None:
        """Write the archive into an open file.

        Raises
        ------
        InputError
            The header holds something that is not JSON; nothing is written.
        """
        try:
            fields = {"format": self.name, "version": self.version, **header}
            text = json.dumps(fields, sort_keys=True, allow_nan=False).encode()
        except (TypeError, ValueError) as error:
            raise InputError(f"{self.what}: header fields must be JSON values: {error}; convert them") from None
        save = np.savez_compressed if compress else np.savez
        save(file, about=np.frombuffer(text, np.uint8), **arrays)  # pyright: ignore[reportArgumentType]

    def unpack(self, content: bytes | BinaryIO, where: str) -> tuple[dict[str, Any], Arrays]:
        """Header and arrays; errors name `where`.

        Raises
        ------
        InputError
            The archive has another format or version, is too large, or damaged.
        """
        source = io.BytesIO(content) if isinstance(content, bytes) else content
        try:
            with zipfile.ZipFile(source) as packed:
                if (size := sum(entry.file_size for entry in packed.infolist())) > self.largest:
                    raise ValueError(f"it unpacks to {size} bytes, more than {self.largest}")
            source.seek(0)
            with np.load(source, allow_pickle=False) as packed:
                arrays = {name: np.asarray(packed[name]) for name in packed.files}
            header = json.loads(arrays.pop("about").tobytes())
            if not isinstance(header, dict) or header.get("format") != self.name:
                raise ValueError("another kind of file")
        except Exception as error:  # a damaged archive raises what its parsers raise: zlib, struct, tokenize, …
            raise self.damaged(where, error) from None
        version, oldest = header.get("version"), self.oldest or self.version
        if not (isinstance(version, int) and oldest <= version <= self.version):
            raise InputError(f"{where} has version {version}, this Lifelore reads {self.version}; update it")
        return header, arrays

    def damaged(self, where: str, error: Exception) -> InputError:
        """The error for an archive that cannot be read."""
        reason = " ".join(str(error).split())[:200]
        return InputError(
            f"{where} is no {self.what} that can be read ({reason}); write it anew with {self.writer}"
        )
