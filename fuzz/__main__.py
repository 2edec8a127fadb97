"""Run the fuzzer: ``python -m fuzz NAME [NAME …] --seconds 3600`` (needs atheris; without names, every target)."""

import argparse
import subprocess
import sys
import tempfile
from pathlib import Path

MOST_MEMORY = 1024
"""Megabytes above which a run ends with a finding."""
SLOWEST = 20
"""Seconds above which an input is a finding."""
FINDINGS = Path(__file__).with_name("findings")


def run(name: str, seconds: int) -> int:
    """Fuzz a target in a process of its own; its exit status. Findings lie in `FINDINGS` / name."""
    folder = FINDINGS / name
    folder.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(prefix=f"fuzz-{name}-") as corpus:
        command = [
            sys.executable, "-m", "fuzz.one", name, corpus,
            f"-max_total_time={seconds}", f"-rss_limit_mb={MOST_MEMORY}", f"-timeout={SLOWEST}", "-max_len=65536",
            f"-artifact_prefix={folder}/", "-print_final_stats=1",
        ]  # fmt: skip
        return subprocess.run(command, check=False).returncode


def main() -> int:
    parser = argparse.ArgumentParser(prog="python -m fuzz", description=__doc__)
    parser.add_argument("names", nargs="*", help="targets; all by default")
    parser.add_argument("--seconds", type=int, default=3600, help="for each target")
    asked = parser.parse_args()
    from fuzz.targets import targets

    known = list(targets())
    if unknown := set(asked.names) - set(known):
        parser.error(f"no target {', '.join(sorted(unknown))}; there are {', '.join(known)}")
    failed = [name for name in asked.names or known if run(name, asked.seconds)]
    print(f"findings in {', '.join(failed)}: see {FINDINGS}" if failed else "no finding")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
