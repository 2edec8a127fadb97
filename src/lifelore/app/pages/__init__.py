"""The web pages of the service: a folder for each page, and `shell` for what all pages share.

A page is a folder: its document (``page.html``, the part between navigation and footer), its scripts (``static``),
and its ``routes`` where it asks the service what no other page asks. `shell.page_shell.PAGES` lists all.
"""
