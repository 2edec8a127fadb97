"""Which files a scene may be written to: told before the work, each another one, none of those that are read."""

import pytest

from lifelore.agent.perceive.scene_files import SceneFiles, check_scene_files, domain_path
from lifelore.core.errors import InputError


@pytest.mark.parametrize(
    ("problem", "domain"), [("a/scene.pddl", "a/scene-domain.pddl"), ("scene", "scene-domain.pddl"), ("", "")]
)
def test_the_domain_lies_beside_its_problem(problem, domain):
    assert domain_path(problem) == domain


def test_files_that_differ_pass_and_none_is_made(tmp_path):
    files = SceneFiles(str(tmp_path / "a.pddl"), str(tmp_path / "a.dot"), str(tmp_path / "A.PNG"))
    check_scene_files([files], [tmp_path / "cloud.pcd"])
    check_scene_files([SceneFiles()], ["cloud.pcd", "cloud.pcd"])
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("files", "said"),
    [
        (SceneFiles(dot="a.png", plot="a.png"), "'a.png' would be overwritten"),
        (SceneFiles(pddl="a", dot="./a"), "'./a' would be overwritten"),
        (SceneFiles(pddl="a.pddl", dot="a-domain.pddl"), "'a-domain.pddl' would be overwritten"),
        (SceneFiles(dot="cloud.pcd"), "'cloud.pcd' would be overwritten"),
        (SceneFiles(dot="link.pcd"), "'link.pcd' would be overwritten"),
        (SceneFiles(plot="a.svg"), "plot must name a PNG file, such as scene.png, got 'a.svg'"),
        (SceneFiles(plot="png"), "plot must name a PNG file"),
        (SceneFiles(pddl="b.pddl"), "'b-domain.pddl', which is a folder"),
        (SceneFiles(dot=""), "must be a file"),
        (SceneFiles(pddl=""), "must be a file"),
        (SceneFiles(dot="no/a.dot"), "folder must exist"),
    ],
)
def test_what_cannot_be_written_is_refused(tmp_path, monkeypatch, files, said):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "cloud.pcd").write_text("a cloud")
    (tmp_path / "link.pcd").symlink_to("cloud.pcd")
    (tmp_path / "b-domain.pddl").mkdir()
    with pytest.raises(InputError) as refused:
        check_scene_files([files], ["cloud.pcd"])
    assert said in str(refused.value)
