"""The documents of the pages: one frame with the navigation around the part of each page."""

from dataclasses import dataclass
from html import escape
from importlib.resources import files
from string import Template

ROOT = files("lifelore.app.pages")
SHELL = "shell"


@dataclass(frozen=True)
class Page:
    """A page in the navigation.

    Parameters
    ----------
    name : str
        Its folder, and its address below ``/``.
    title : str
    does : str
        In one sentence, what a person does there.
    """

    name: str
    title: str
    does: str

    @property
    def path(self) -> str:
        """Address of the page."""
        return f"/{self.name}"


PAGES: tuple[Page, ...] = (
    Page(
        "see",
        "See",
        "See the objects of a point cloud in 3-D, where they touch, and which is on or beside which.",
    ),
    Page("life", "Life", "Watch a memory grow: tasks, learning curves, maps, beliefs, curiosity, and reasons."),
    Page("study", "Study", "See what a study of personalisation achieves: traffic, uplift, policies, alarms."),
)
HOME = Page("", "Lifelore", "Choose a page.")


def page_document(page: Page) -> str:
    """The HTML document of a page."""
    frame = Template((ROOT / SHELL / "frame.html").read_text(encoding="utf-8"))
    return frame.substitute(
        title=escape(page.title if page is HOME else f"{page.title} · Lifelore"),
        description=escape(page.does),
        navigation=_navigation(page),
        content=_cards() if page is HOME else (ROOT / page.name / "page.html").read_text(encoding="utf-8"),
    )


def _navigation(current: Page) -> str:
    def item(page: Page) -> str:
        here = ' aria-current="page"' if page is current else ""
        return f'<li><a href="{page.path}"{here}>{escape(page.title)}</a></li>'

    return "\n".join(item(page) for page in PAGES)


def _cards() -> str:
    cards = "\n".join(
        f'<li class="card"><h2><a href="{page.path}">{escape(page.title)}</a></h2><p>{escape(page.does)}</p></li>'
        for page in PAGES
    )
    words = "An agent that becomes good at its world. Choose a page."
    return f'<h1>Lifelore</h1>\n<p>{words}</p>\n<ul class="cards">{cards}</ul>'
