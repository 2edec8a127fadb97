"""Personalisation for a program that keeps a memory open, such as the HTTP service.

Read in this order: `library_document` (a policy library as plain data), `registration` (a library becomes a
study), `open_studies` (studies that stay open), `explanation` (the evidence behind a user's belief), `panel` (very
many users in batches; `panel_journal`, `open_panels`), `adaptation` (BEAT).
"""
