"""The README's Python runs as it stands, only shorter."""

import json
import re
import subprocess
import sys
from pathlib import Path

README = Path(__file__).parents[1] / "README.md"


def test_the_ten_lines_of_python(tmp_path):
    (code,) = re.findall(r"```python\n(.*?)```", README.read_text(), flags=re.S)
    shorter = code.replace("tasks=30, episodes=500", "tasks=3, episodes=20")
    assert shorter != code
    done = subprocess.run(
        [sys.executable, "-W", "error", "-c", shorter], cwd=tmp_path, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    jumpstart = json.loads(done.stdout.replace("'", '"').replace("None", "null"))
    assert jumpstart["n"] == 1
    assert (tmp_path / "lake.db").is_file()


def test_its_pictures_exist():
    pictures = re.findall(r"!\[.*?\]\((.*?)\)", README.read_text())
    assert pictures
    for picture in pictures:
        assert (README.parent / picture).stat().st_size <= 300_000
