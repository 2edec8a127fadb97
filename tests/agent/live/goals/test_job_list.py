"""Job lists: sorted by time, and one clear error with a line for each mistake."""

import pytest

from lifelore.agent.live.goals.destinations import Destination
from lifelore.agent.live.goals.job_list import named_points, read_jobs
from lifelore.core.errors import InputError


def jobs_of(tmp_path, text: str):
    path = tmp_path / "jobs.csv"
    path.write_text(text, encoding="utf-8")
    return read_jobs(path)


def test_columns_in_any_order_and_jobs_by_time(tmp_path):
    jobs = jobs_of(tmp_path, "y, name ,x,time\n2,dock,1,30\n4,,3,10.5\n\n6,lab,5,20\n")
    assert [job.destination for job in jobs] == [
        Destination((3.0, 4.0)), Destination((5.0, 6.0), "lab"), Destination((1.0, 2.0), "dock")
    ]  # fmt: skip
    assert [(job.time, job.line) for job in jobs] == [("10.5", 3), ("20", 5), ("30", 2)]


@pytest.mark.parametrize(
    ("times", "order"),
    [
        (["10:30", "09:05", "09:05:01"], [1, 2, 0]),
        (["2026-03-01T10:00", "2026-02-28 23:59:59", "2026-03-01"], [1, 2, 0]),
        (["2026-03-01T10:00+02:00", "2026-03-01T09:00Z"], [0, 1]),
        (["5", "5", "-1"], [2, 0, 1]),
        (["", "", ""], [0, 1, 2]),
    ],
)
def test_kinds_of_times(tmp_path, times, order):
    text = "time,x,y\n" + "".join(f"{time},{i},0\n" for i, time in enumerate(times))
    points = [job.destination.point for job in jobs_of(tmp_path, text)]
    assert points == [(float(i), 0.0) for i in order]


def test_without_times_the_order_of_the_file_stays(tmp_path):
    jobs = jobs_of(tmp_path, "\ufeffX,Y\r\n3,4\r\n1,2\r\n")
    assert [job.destination.point for job in jobs] == [(3.0, 4.0), (1.0, 2.0)]


def test_a_name_alone_means_the_point_of_another_line_or_of_memory(tmp_path):
    jobs = jobs_of(tmp_path, "name,x,y\ndock,,\nlab,,\ndock,1,2\ndock,1.0,2\n")
    assert [job.destination.point for job in jobs] == [None, None, (1.0, 2.0), (1.0, 2.0)]
    assert named_points(jobs) == {"dock": (1.0, 2.0)}
    assert jobs_of(tmp_path, "name\ndock\n")[0].destination == Destination(name="dock")


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "is empty"),
        ("x,y\n", "has no job below its header"),
        ("x,y,z\n1,2,3\n", "line 1 must name columns of time, name, x, y"),
        ("x,x\n1,2\n", "each at most once"),
        ("time\n3\n", "line 1 must have the columns x and y, or name"),
        ("name,x\na,3\n", "line 1 must have both columns x and y"),
        ("x,y\n1\n", "line 2: must have 2 fields (x,y), got 1"),
        ("x,y\n1,2\n3,4,5\n", "line 3: must have 2 fields (x,y), got 3"),
        ("x,y\n1,2\n,4\n", "line 3: x must be a number of metres, got ''"),
        ("x,y\n1,a\n", "line 2: y must be a number of metres, got 'a'"),
        ("x,y\n1,nan\n", "line 2: y must be a number"),
        ("x,y\n1,1e9\n", "line 2: a destination must have coordinates of magnitude"),
        ("x,y,name\n,,\n1,2,\n,,\n", None),
        ("time,x,y,name\n5,,,\n", "line 2: must have x and y, or a name"),
        ("time,x,y\n1,2,3\n,2,3\n", "line 3: time is missing"),
        ("time,x,y\n1,2,3\nsoon,2,3\n", "line 3: time must be a number of seconds, HH:MM or an ISO 8601 date"),
        ("time,x,y\n1,2,3\n10:30,2,3\n", "line 3: time must be a number of seconds as in line 2, got '10:30'"),
        ("time,x,y\n2026-01-01T10:00,2,3\n2026-01-01T10:00Z,2,3\n", "line 3: time must be a date as in line 2"),
        ("name,x,y\ndock,1,2\ndock,1,3\n", "line 3: name 'dock' has another position in line 2"),
        ('name,x,y\n"dock\nyard",1,2\n', "line 3: a destination's name must be"),
        ('name,x,y\n"dock,1,2\n', "is not CSV"),
        (f"name,x,y\n{'n' * 101},1,2\n", "line 2: a destination's name must be 1 to 100"),
    ],
)
def test_each_mistake_is_one_line_that_names_its_line(tmp_path, text, words):
    if words is None:
        assert len(jobs_of(tmp_path, text)) == 1
        return
    with pytest.raises(InputError) as caught:
        jobs_of(tmp_path, text)
    assert words in str(caught.value)
    assert str(caught.value).startswith(f"goals: {tmp_path}")


def test_all_wrong_lines_are_named_at_once_up_to_ten(tmp_path):
    with pytest.raises(InputError) as caught:
        jobs_of(tmp_path, "x,y\na,2\n1,2\n1\n")
    assert str(caught.value).endswith(
        "line 2: x must be a number of metres, got 'a'; line 4: must have 2 fields (x,y), got 1"
    )
    with pytest.raises(InputError, match=r"line 11: .*, got 'a'; 12 lines are wrong in all$"):
        jobs_of(tmp_path, "x,y\n" + 12 * "a,2\n")
    with pytest.raises(InputError, match=r"line 3: time must be .* as in line 2.*; line 4: time must be"):
        jobs_of(tmp_path, "time,x,y\n1,2,3\n10:30,2,3\n10:40,2,3\n")


def test_a_file_that_cannot_be_read(tmp_path):
    with pytest.raises(InputError, match="No such file"):
        read_jobs(tmp_path / "none.csv")
    with pytest.raises(InputError, match="directory"):
        read_jobs(tmp_path)
    (tmp_path / "latin.csv").write_bytes(b"name,x,y\nk\xfcche,1,2\n")
    with pytest.raises(InputError, match="not CSV in UTF-8"):
        read_jobs(tmp_path / "latin.csv")
