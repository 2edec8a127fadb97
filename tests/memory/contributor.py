"""A process that contributes to a memory and says so after each task; the tests run and kill it.

Arguments: place, robot, number of tasks (0: until killed), slots per task. A line ``ready`` when it begins,
then a line with the sequence number of each task that was stored, then ``refused: ...`` if one was not.
"""

import itertools
import sys
import uuid

import numpy as np

from lifelore.core import Record, StoreError
from lifelore.memory import open_memory


def main(where: str, robot: str, tasks: int, slots: int) -> None:
    """Contribute `tasks` times one to each of `slots` slots."""
    ones = Record("counts", "shared", 1, "add", np.arange(slots), np.ones(slots, dtype=np.int64))
    process = uuid.uuid4().hex
    print("ready", flush=True)
    with open_memory(where) as memory:
        for seq in range(tasks) if tasks else itertools.count():
            memory.contribute(robot, [ones], process=process, seq=seq, task={"index": seq})
            print(
                f"{seq}\n", end="", flush=True
            )  # in one piece, also where Python does not buffer: a kill cuts no line


if __name__ == "__main__":
    try:
        main(sys.argv[1], sys.argv[2], int(sys.argv[3]), int(sys.argv[4]))
    except StoreError as error:
        print(f"refused: {error}", flush=True)
