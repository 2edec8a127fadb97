"""Benchmarks of many robots: memory and rates of their learners, and the merging of their memories."""
