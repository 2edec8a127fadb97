"""The command line: reads options, calls one function of a lower room for each verb, prints the result."""

from typing import TYPE_CHECKING

from lifelore.core.lazy_exports import lazy_exports

if TYPE_CHECKING:
    from lifelore.app.pages.mount import HEADERS as HEADERS
    from lifelore.app.pages.mount import app_with_pages as app_with_pages
    from lifelore.app.service.settings import ServiceSettings as ServiceSettings

__all__, __getattr__, __dir__ = lazy_exports(__name__)  # pyright: ignore[reportUnsupportedDunderAll]
