"""The web pages of the service: a folder for each page, and `shell` for what all pages share.

A page is a folder: its document (``page.html``, between navigation and footer) and its scripts (``static``).
The page of lives has ``routes`` of its own. `shell.page_shell.PAGES` lists all.
"""
