"""A courier lives through ten tasks in a generated office and remembers the office.

For robot engineers. Give `map="my_building.yaml"` (a ROS map_server map) to live in a building of your own.
"""

import tempfile

from lifelore import LifeSettings, live

with tempfile.TemporaryDirectory() as folder:
    settings = LifeSettings(domain="building", tasks=10, memory=f"{folder}/courier.db", seed=1)
    report = live(settings).report

print("Steps until the known way is worth 80 % of the best way, with memory (lore) and without (scratch):")
for number, task in enumerate(report["tasks"], start=1):
    steps = {agent: found["steps_to_80"] for agent, found in task["agents"].items()}
    print(f"task {number:2}: lore {steps['lore']:6}, scratch {steps['scratch']:6}")
