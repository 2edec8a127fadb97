"""Experiments: every claim of the thesis measured, and benchmarks.

`engine` runs claims and writes results; a claim is a folder `chapterN/cN_MM_name`; what several claims of a
chapter share lies in the chapter's folder. `bench` holds the benchmarks, `pictures` draws the pictures of the
docs.
"""
