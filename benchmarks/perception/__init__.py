"""Benchmarks of perception: whole scenes, their pictures, the separator and the relations."""
