"""Logs of choices and outcomes: CSV files and tables in memory, read as arrays.

Read in this order: `log`, `log_format`, `log_reader`.
"""
