"""Runs Python in a new process, as tests of compiled code need it."""

import os
import subprocess
import sys


def run(*arguments: object, **environment: str) -> str:
    """Standard output of a new Python process in which warnings are errors."""
    done = subprocess.run(
        [sys.executable, "-W", "error", *map(str, arguments)],
        env=os.environ | environment,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    return done.stdout
