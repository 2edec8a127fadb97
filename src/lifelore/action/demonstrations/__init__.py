"""Demonstrations: files of steps, and the competence of demonstrators (thesis §3.4.8).

Read in this order: `demonstrations`, `competence`.
"""
