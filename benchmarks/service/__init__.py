"""Benchmark of the HTTP service under load, beside a bare FastAPI route."""
