"""Demonstrations: files of steps, the competence of demonstrators, and simulated demonstrators (thesis §3.4.8).

Read in this order: `demonstrations`, `competence`, `simulated_person`.
"""
