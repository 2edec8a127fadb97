"""The README's Python runs as it stands, only shorter."""

import json
import re
import subprocess
import sys
from pathlib import Path

from lifelore.domains.tabletop.scene_folder import save_cloud
from lifelore.domains.tabletop.tabletop import TabletopSettings, sample_scene

README = Path(__file__).parents[1] / "README.md"


def python_blocks() -> list[str]:
    return re.findall(r"```python\n(.*?)```", README.read_text(), flags=re.S)


def run(code: str, folder: Path) -> str:
    """What the code prints."""
    command = [sys.executable, "-W", "error", "-c", code]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_the_ten_lines_of_python(tmp_path):
    code = next(block for block in python_blocks() if "gymnasium" in block)
    shorter = code.replace("tasks=30, episodes=500", "tasks=3, episodes=20")
    assert shorter != code
    jumpstart = json.loads(run(shorter, tmp_path).replace("'", '"').replace("None", "null"))
    assert jumpstart["n"] == 1
    assert (tmp_path / "lake.db").is_file()


def test_a_cloud_becomes_a_scene(tmp_path):
    scene = sample_scene(3, 0, TabletopSettings(n_objects=(2, 2)))
    save_cloud(tmp_path / "scene.pcd", scene)
    said = run(next(block for block in python_blocks() if "perceived_scene" in block), tmp_path)
    assert "Relation(a=2, b=1, relation='on'" in said
    assert "relation='in_front_of'" in said


def test_every_block_is_run():
    assert len(python_blocks()) == 2


def test_its_pictures_exist():
    pictures = re.findall(r"!\[.*?\]\((.*?)\)", README.read_text())
    assert pictures
    for picture in pictures:
        assert (README.parent / picture).stat().st_size <= 300_000
