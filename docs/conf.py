"""Sphinx settings of the site, and the generator of its API reference.

The reference has one page for each name that `lifelore` or a room exports, so no public name can be forgotten.
Names in backticks inside public docstrings are checked: a name that can be found neither in the code nor among the
parameters keeps its role, and Sphinx (`-n -W`) then fails the build.
"""

import contextlib
import inspect
import re
import shutil
from functools import cached_property
from importlib import import_module
from pathlib import Path

from docutils.nodes import Element
from sphinx.addnodes import pending_xref
from sphinx.application import Sphinx
from sphinx.environment import BuildEnvironment
from sphinx.util import logging

import lifelore

log = logging.getLogger(__name__)
HERE = Path(__file__).parent

project = "Lifelore"
author = "The Lifelore founders"
release = version = lifelore.__version__
extensions = ["sphinx.ext.autodoc", "sphinx.ext.napoleon", "sphinx.ext.mathjax", "myst_parser"]
exclude_patterns = ["_build", "api/_*"]

html_theme = "furo"
html_title = "Lifelore"
html_static_path = ["_static"]
html_css_files = ["lifelore.css"]
html_copy_source = html_show_sourcelink = html_show_copyright = False
pygments_style, pygments_dark_style = "friendly", "monokai"

myst_heading_anchors = 4
myst_enable_extensions = ["colon_fence", "dollarmath"]
suppress_warnings = ["myst.xref_ambiguous"]

default_role = "py:obj"
autodoc_typehints = "none"
autodoc_member_order = "bysource"
autodoc_class_signature = "mixed"
napoleon_google_docstring = False
napoleon_use_param = napoleon_use_rtype = False
napoleon_custom_sections = [("Attributes", "params_style")]

# The rooms in the order in which the reference shows them, and a title for each.
ROOMS = {
    "lifelore.verbs": "The log of a robot",
    "lifelore.agent": "Verbs, and the long-lived agent",
    "lifelore.perception": "Perception",
    "lifelore.action": "Action priors",
    "lifelore.interaction": "Policy reuse",
    "lifelore.interaction.evaluation": "Off-policy evaluation",
    "lifelore.agent.personalise": "Personalisation",
    "lifelore.domains": "Worlds",
    "lifelore.domains.tabletop_job": "Tabletop jobs",
    "lifelore.figures": "Figures",
    "lifelore.memory": "Memory",
    "lifelore.core": "Tasks, learners and protocols",
}


ERRORS = "lifelore.core.errors"


def exported() -> dict[str, tuple[str, object]]:
    """Each public name, with the package to import it from (`lifelore` before a room) and its value."""
    names = {name: ("lifelore", getattr(lifelore, name)) for name in lifelore.__all__ if name != "__version__"}
    for room in ROOMS:
        package = import_module(room)
        for name in getattr(package, "__all__", ()):
            value = getattr(package, name)
            if callable(value) and getattr(value, "__module__", "") != ERRORS:
                names.setdefault(name, (room, value))
    return names


PUBLIC = exported()
HOMES = {name: getattr(value, "__module__", package) for name, (package, value) in PUBLIC.items()}
SOURCES = Path(lifelore.__file__).parent
# Where modules and classes live, by their bare names: docstrings name both so.
MODULES: dict[str, list[str]] = {}
CLASSES: dict[str, list[str]] = {}
for file in sorted(SOURCES.rglob("*.py")):
    module_name = ".".join(("lifelore", *file.relative_to(SOURCES).with_suffix("").parts))
    MODULES.setdefault(file.stem, []).append(module_name)
    for class_name in re.findall(r"^class (\w+)", file.read_text(encoding="utf-8"), flags=re.M):
        CLASSES.setdefault(class_name, []).append(module_name)


def first_line(documented: object) -> str:
    """The first line of a docstring, with names as literals."""
    return re.sub(r"(?<!`)`([^`]+)`(?!`)", r"``\1``", (inspect.getdoc(documented) or "").split("\n")[0])


def room_of(module: str) -> str | None:
    """The room, of the most specific name, in which a module lives; None where `ROOMS` lists none."""
    return max((room for room in ROOMS if module.startswith(room)), key=len, default=None)


def undocumented(name: str) -> list[str]:
    """A public name and its public methods and properties that have no docstring of their own."""
    value = PUBLIC[name][1]
    missing = [] if value.__doc__ else [name]
    for member, attribute in vars(value).items() if inspect.isclass(value) else ():
        function = getattr(attribute, "__func__", getattr(attribute, "func", attribute))
        documented = callable(function) or isinstance(attribute, property)
        if documented and not member.startswith("_") and not inspect.getdoc(function):
            missing.append(f"{name}.{member}")
    return missing


def write_reference(app: Sphinx) -> None:
    """Write `api/`: an index by room, and one page for each public name."""
    folder = HERE / "api"
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir()
    index = ["API reference", "=============", ""]
    index += [
        "Every name can be imported from the package that stands before it. Each is loaded when first used.",
        "",
    ]
    left = dict(HOMES)
    for room, title in ROOMS.items():
        names = sorted((name for name in left if room_of(left[name]) == room), key=str.lower)
        index += [title, "-" * len(title), "", first_line(import_module(room)), ""]
        index += [".. list-table::", "   :widths: 28 72", "   :class: wide", ""]
        for name in names:
            left.pop(name)
            package, value = PUBLIC[name]
            index += [f"   * - ``{package}.``\\ :doc:`{name} <{name}>`", f"     - {first_line(value)}"]
            kind = "class" if inspect.isclass(value) else "function"
            directive = [f".. auto{kind}:: {package}.{name}"]
            if issubclass(value, BaseException) if kind == "class" else False:
                directive = [f".. autoexception:: {package}.{name}", "   :show-inheritance:"]
            elif kind == "class":
                directive += ["   :members:"]
            (folder / f"{name}.rst").write_text("\n".join([name, "=" * len(name), "", *directive, ""]))
            for missing in undocumented(name):
                log.warning("%s.%s has no docstring", package, missing)
        index += ["", ".. toctree::", "   :hidden:", "", *(f"   {name}" for name in names), ""]
    for name in left:
        log.warning("%s lives in %s, a room that docs/conf.py does not list", name, left[name])
    index += ["Errors", "------", "", first_line(import_module(ERRORS)), ""]
    index += [".. toctree::", "   :hidden:", "", "   errors", "", "See :doc:`errors`.", ""]
    errors = ["Errors", "======", "", f".. automodule:: {ERRORS}", "   :members:", "   :show-inheritance:", ""]
    (folder / "errors.rst").write_text("\n".join(errors))
    (folder / "index.rst").write_text("\n".join(index))


def parameters(value: object) -> set[str]:
    """The parameters of a function, or of a class and its methods, and the attributes its docstring lists."""
    names = set(re.findall(r"^(\w[\w, *]*?)(?: : |$)", inspect.getdoc(value) or "", flags=re.M))
    names = {part.strip(" *") for name in names for part in name.split(",")}
    functions = [value, *vars(value).values()] if inspect.isclass(value) else [value]
    for function in functions:
        try:
            names |= set(inspect.signature(getattr(function, "__func__", function)).parameters)
        except (TypeError, ValueError):
            continue
    return names


def found(name: str, owners: list[object], module: str) -> bool:
    """Whether a dotted name leads somewhere from the owners, from their module, or from any module of Lifelore."""
    head, *rest = name.split(".")
    places = [*owners, import_module(module)]
    starts = [getattr(place, head) for place in places if hasattr(place, head)]
    starts += map(import_module, MODULES.get(head, []))
    starts += [getattr(import_module(home), head) for home in CLASSES.get(head, [])]
    if head == "lifelore":
        with contextlib.suppress(ImportError):
            import_module(name)
        with contextlib.suppress(ImportError):
            import_module(name.rpartition(".")[0])
        starts.append(lifelore)
    for start in starts:
        for part in rest:
            start = getattr(start, part, getattr(start, "__dataclass_fields__", {}).get(part))
        if start is not None:
            return True
    return False


def has_page(target: str) -> bool:
    """Whether the reference documents this public name, or this method or property of a public class."""
    public, *member = target.split(".")
    if public not in HOMES or len(member) > 1:
        return False
    attribute = vars(PUBLIC[public][1]).get(member[0]) if member else None
    return not member or callable(attribute) or isinstance(attribute, (property, classmethod, cached_property))


def link_names(app: Sphinx, what: str, name: str, value: object, options: object, lines: list[str]) -> None:
    """Turn backticks into links to public names and literals of other names; leave unknown names to fail."""
    package = max((room for room in ("lifelore", *ROOMS) if name.startswith(room + ".")), key=len)
    public, *member = name.removeprefix(package + ".").split(".")
    if public not in HOMES:
        public, owners, module = "", [value], ERRORS
    else:
        owner = PUBLIC[public][1]
        owners, module = [value, owner] if member else [owner], HOMES[public]
    known = set().union(*map(parameters, owners))

    def link(match: re.Match[str]) -> str:
        text = match[1]
        start = re.match(r"[A-Za-z_][\w.]*", text)
        target = start[0].removeprefix("lifelore.") if start else ""
        whole = target == text.removeprefix("lifelore.")
        for page in (target, f"{public}.{target}"):
            if whole and has_page(page):
                return f":py:obj:`~{PUBLIC[page.split('.')[0]][0]}.{page}`"
        if start and (target.split(".")[0] in known or found(start[0], owners, module)):
            return f"``{text}``"
        return match[0]

    linked = re.compile(r"\b(?:" + "|".join(HOMES) + r")\b")
    for place, line in enumerate(lines):
        if line.lstrip().startswith((">>>", "...")):
            continue
        parts = re.split(r"(``[^`]+``)", line)
        parts[::2] = (re.sub(r"(?<![:\w])`([^`<>]+)`(?!_)", link, part).replace("|", "\\|") for part in parts[::2])
        line = "".join(parts)
        field = re.match(r"(\w[\w, ]*) : (.*)$", line)
        if field:
            line = f"{field[1]} : " + linked.sub(lambda m: f":py:obj:`~{PUBLIC[m[0]][0]}.{m[0]}`", field[2])
        # Napoleon takes the text before a colon in a property's docstring for its type.
        lines[place] = line.replace(":", "\0") if what in ("property", "attribute") else line


def unmark(app: Sphinx, what: str, name: str, value: object, options: object, lines: list[str]) -> None:
    """Undo the marks that `link_names` made for napoleon."""
    lines[:] = [line.replace("\0", ":") for line in lines]


def resolve_errors(app: Sphinx, env: BuildEnvironment, node: pending_xref, content: Element) -> Element | None:
    """Resolve a bare name under *Raises* to the page of errors."""
    target = f"{ERRORS}.{node['reftarget']}"
    if node["reftype"] != "exc" or target not in env.domains["py"].objects:
        return None
    return env.domains["py"].resolve_xref(env, node["refdoc"], app.builder, "exc", target, node, content)


def name_anchors(app: Sphinx, page: str, source: list[str]) -> None:
    """Turn what pages on a code host need into what Sphinx knows: HTML anchors, and the page of contributing."""
    source[0] = source[0].replace("](../CONTRIBUTING.md", "](contributing.md")
    source[0] = re.sub(r'^<a id="([\w-]+)"></a>$', r"(\1)=", source[0], flags=re.M)


def setup(app: Sphinx) -> None:
    app.connect("builder-inited", write_reference)
    app.connect("source-read", name_anchors)
    app.connect("autodoc-process-docstring", link_names, priority=100)
    app.connect("autodoc-process-docstring", unmark, priority=900)
    app.connect("missing-reference", resolve_errors)
