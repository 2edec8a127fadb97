"""A program drives a study of the HTTP service: decide, observe, report, forget; also while the service is gone.

For people who personalise interactive systems. `lifelore serve` runs, and has the study of docs/service.md.
"""

import random
import sys

from lifelore.bridges import StudyClient

url = sys.argv[1] if len(sys.argv) > 1 else "http://127.0.0.1:8321"
random.seed(0)
means = [{"slow": 8.0, "fast": 2.0}, {"slow": 3.0, "fast": 8.5}]  # two types of user, unknown to the service

with StudyClient(url, "playlists", fallback="slow", queue="outcomes.db") as client:
    for _ in range(5):
        for user in range(100):
            choice = client.decide(f"user{user}")
            client.observe(choice, random.gauss(means[user % 2][choice.policy], 2.0))
        client.flush()  # the next round knows the outcomes of this one
    counts = client.counts()
    print(f"choices by the service: {counts['service']}, without it: {counts['table'] + counts['fallback']}")
    try:
        report = client.report()
    except ConnectionError:
        sys.exit(f"no service at {url}; outcomes.db keeps {counts['pending']} outcomes until one runs there")
    print(f"uplift over the control group: {report['uplift']['value']:.2f}, 95 % in {report['uplift']['ci95']}")
    client.forget("user0")
