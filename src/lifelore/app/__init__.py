"""The command line: reads options, calls one function of a lower room for each verb, prints the result."""

from typing import TYPE_CHECKING

from lifelore.core.lazy_exports import lazy_exports

if TYPE_CHECKING:
    from lifelore.app.pages.mount import HEADERS as HEADERS
    from lifelore.app.pages.mount import app_with_pages as app_with_pages
    from lifelore.app.service.settings import ServiceSettings as ServiceSettings

_HOME = {
    "HEADERS": ".pages.mount",
    "ServiceSettings": ".service.settings",
    "app_with_pages": ".pages.mount",
}

__all__ = [*_HOME]  # pyright: ignore[reportUnsupportedDunderAll]
__getattr__, __dir__ = lazy_exports(__name__, _HOME)
