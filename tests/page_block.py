"""Blocks of a page run as a reader would, in a folder and with a memory of the reader's own."""

import io
import os
import re
import shlex
import subprocess
import sys
from contextlib import redirect_stderr, redirect_stdout
from pathlib import Path

import pytest

from lifelore.app.command_line import run

OF_A_SHELL = re.compile(r"^(?!lifelore )|[<>|&]|--(watch|serve)\b", re.MULTILINE)
"""What makes a block more than commands of Lifelore that end by themselves."""
REGISTERED = re.compile(r"""make\(["'](lifelore|MiniGrid)""")
"""Worlds that exist once a package is imported, which another block may have done in this process."""


def run_block(language: str, code: str, folder: Path, home: Path | None = None) -> str:
    """Output of a block of Python or of a shell, run here if it needs no process of its own: it starts sooner."""
    code = re.sub(r" +#.*$", "", code.rstrip("\n"), flags=re.MULTILINE) if language == "sh" else code
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(folder)
        patch.setenv("XDG_DATA_HOME", str(home or folder / "home"))
        patch.setenv("COLUMNS", "120")
        if (OF_A_SHELL if language == "sh" else REGISTERED).search(code):
            patch.setenv("PATH", f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}")
            command = ["bash", "-euc"] if language == "sh" else [sys.executable, "-W", "error", "-c"]
            done = subprocess.run([*command, code], capture_output=True, text=True, check=False)
            assert done.returncode == 0, f"{code}\n{done.stderr}"
            return done.stdout + done.stderr
        out, err = io.StringIO(), io.StringIO()
        with redirect_stdout(out), redirect_stderr(err):
            if language == "python":
                exec(compile(code, "page.py", "exec"), {"__name__": "__main__"})
            else:
                for line in code.splitlines():
                    assert run(words_of(line, folder)) == 0, err.getvalue()
        return out.getvalue() + err.getvalue()


def words_of(line: str, folder: Path) -> list[str]:
    """Arguments of a command of Lifelore, with names of files for a pattern such as ``*.pcd``."""
    words = []
    for word in shlex.split(line)[1:]:
        found = sorted(folder.glob(word)) if "*" in word else []
        words += [str(path.relative_to(folder)) for path in found] or [word]
    return words
