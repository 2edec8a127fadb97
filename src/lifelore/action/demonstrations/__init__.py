"""Demonstrations: files of steps, the competence of demonstrators, and simulated demonstrators (thesis §3.6).

Read in this order: `demonstrations`, `competence`, `simulated_person`.
"""
