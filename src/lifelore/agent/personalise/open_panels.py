"""Panels of studies that stay open between requests, made again when their study has changed."""

import threading

from lifelore.agent.personalise.open_studies import OpenStudies
from lifelore.agent.personalise.panel import Panel
from lifelore.memory import Memory


class OpenPanels:
    """The panels of a memory by the name of their study."""

    def __init__(self, memory: Memory, studies: OpenStudies, seed: int = 0) -> None:
        self._memory, self._studies, self._seed = memory, studies, seed
        self._open: dict[str, Panel] = {}
        self._lock = threading.Lock()

    def drop_all(self) -> None:
        """Read every panel again at its next use."""
        with self._lock:
            self._open.clear()

    def get(self, name: str) -> Panel:
        """The panel of the study of that name; errors as for `open_study`."""
        study = self._studies.get(name)
        with self._lock:
            panel = self._open.get(name)
            if panel is None or panel.study is not study:
                panel = self._open[name] = Panel(self._memory, study, self._seed)
        return panel
