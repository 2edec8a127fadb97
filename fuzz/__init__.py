"""Fuzzing of every reader: `targets` (a reader, and small files to begin with), `__main__` (atheris runs them).

``make fuzz NAME=pcd SECONDS=3600``. What a run finds is stored in `findings/NAME`; the tests replay it.
"""
