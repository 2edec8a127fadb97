"""A courier lives through ten tasks in a generated office and remembers the office.

For robot engineers. It uses your own memory, as `lifelore live` does, so a second run continues this life.
"""

from lifelore import live

report = live(tasks=10).report

print("Steps until the known way is worth 80 % of the best way:")
for number, task in enumerate(report["tasks"], start=1):
    steps = {agent: found["steps_to_80"] for agent, found in task["agents"].items()}
    print(f"task {number:2}: with memory {steps['lore']:6}, without {steps['scratch']:6}")
