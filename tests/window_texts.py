"""The texts of the window, from its source and tables; as a program, those that a language lacks.

``uv run python tests/window_texts.py de``
"""

import ast
import re
import sys
from collections.abc import Iterable, Iterator
from functools import cache
from gettext import NullTranslations
from pathlib import Path

import physicslab
from physicslab.components.quantities import KIND_OF_UNIT, QUANTITIES
from physicslab.diagnostics import free_body
from physicslab.diagnostics.energy import ACCOUNT_WORDS, STORED_WORDS
from physicslab.ecs.component import COMPONENTS
from physicslab.ecs.config import PhysicsConfig, SimulationConfig
from physicslab.ecs.fields import Field
from physicslab.ecs.sentences import SENTENCES
from physicslab.export.page import player_texts
from physicslab.integrators import INTEGRATORS, SPLIT_METHODS
from physicslab.languages.catalogue import sources
from physicslab.languages.language import Language
from physicslab.scenes import SCENES
from physicslab.state.joint_rows import KINDS as JOINTS
from physicslab.theme import THEMES
from physicslab.view.controls.controls import CONTROLS
from physicslab.view.controls.tools import TOOLS
from physicslab.view.window.copying import Copying
from physicslab.view.window.desk import LEVELS
from physicslab.view.workbench import world_panel
from physicslab.view.workbench.copies_panel import shown_name
from physicslab.view.workbench.impact_panel import HEADS

PACKAGE = Path(physicslab.__file__).parent
WRITING = {
    "bar", "button", "checkbox", "choice", "faint", "floating", "heading", "item", "list", "menu", "notify",
    "row", "selectable", "text", "tip",
}  # fmt: skip
"""The methods that write words into the window."""
NEVER = re.compile(r"#{2,}|^[\W\d]*$|^(.{1,2}|GIF|FILM|[A-Z]{1,3}|F\d+|centre)$")
"""Identities of widgets, signs, and letters of formulas."""


def template(node: ast.AST) -> str | None:
    """Return a text of the source, ``{}`` in place of what is put in; ``None`` where it is none."""
    if isinstance(node, ast.JoinedStr):
        return "".join(template(one) or "{}" for one in node.values)
    return node.value if isinstance(node, ast.Constant) and isinstance(node.value, str) else None


def _either(node: ast.AST) -> Iterator[ast.AST]:
    """Yield a node, or both that a condition chooses between."""
    if isinstance(node, ast.IfExp):
        yield from _either(node.body)
        yield from _either(node.orelse)
    else:
        yield node


@cache
def constants() -> frozenset[str]:
    """Return all texts of the package's source, whatever they are for."""
    trees = (ast.parse(path.read_text(encoding="utf-8")) for path in PACKAGE.rglob("*.py"))
    texts = (text for tree in trees for node in ast.walk(tree) if (text := template(node)))
    return frozenset(part.strip() for text in texts for part in (text, *re.split(r"[\n|]", text)))


@cache
def written() -> dict[str, str]:
    """Return the texts that the window writes or has in tables, each with where it is."""
    found: dict[str, str] = {}
    for path in sorted(path for part in ("desktop", "view") for path in (PACKAGE / part).rglob("*.py")):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Call) and getattr(node.func, "attr", "") in WRITING:
                words = {keyword.arg: keyword.value for keyword in node.keywords}
                named = [words[key] for key in ("tip", "shown") if key in words]
                given = [*node.args["shown" in words or "identity" in words :], *named]
                for one in (part for each in given for part in _either(each)):
                    text = template(one)
                    if text and not NEVER.search(text.replace("{}", "")):
                        found.setdefault(text, f"{path.relative_to(PACKAGE)}:{node.lineno}")
    for name, table in tables().items():
        found |= {text: name for text in table if text not in found}
    return found


def tables() -> dict[str, list[str]]:
    """Return the texts with words that stand in tables."""
    tools = [(tool.title, tool.usage, *tool.prompts) for tool in TOOLS.values()]
    found = {
        "controls": [text for one in CONTROLS for text in (one.title, one.tip, one.label) if text],
        "tools": [text for texts in tools for text in texts],
        "scenes": [
            text for one in SCENES.values() for text in (one.title, one.description, one.also) if text
        ],
        "tags": ["all", *{tag for one in SCENES.values() for tag in (*one.teaches, *one.tags)}],
        "copies": [shown_name(name) for name in Copying.FIELDS],
        "microscope": [
            *("before", "after"),
            *(f"{body} {word}" for body in "AB" for word in ("before", "after", "moves", "turns")),
        ],
        "impacts": [one for one in HEADS if len(one) > 2],
        "player": player_texts(), "quantities": [*QUANTITIES, *KIND_OF_UNIT.values()],
        "levels": [*LEVELS, *LEVELS.values()],
        "methods": [one.title for one in (*INTEGRATORS.values(), *SPLIT_METHODS.values())],
        "accounts": [*ACCOUNT_WORDS.values(), *STORED_WORDS.values()],
        "settings": [text for texts in world_panel._NUMBERS.values() for text in texts],
        "forces": [*free_body._NAMES.values(), *(kind.__name__.lower() for kind in JOINTS)],
        "reasons": list(SENTENCES.values()),
        "themes": [theme.name for theme in THEMES],
        "fields": [text for one in fields() for text in (_label(one), one.meaning)],
    }  # fmt: skip
    return {name: [text for text in texts if not NEVER.search(text)] for name, texts in found.items()}


def fields() -> list[Field]:
    """Return the fields of all components, and those of a scene's physics and simulation."""
    components = [field for kind in COMPONENTS.values() for field in kind.FIELDS]
    return [*components, *PhysicsConfig.FIELDS, *SimulationConfig.FIELDS]


def _label(field: Field) -> str:
    return field.name.capitalize().replace("_", " ")


class Marked(NullTranslations):
    """A language that marks what a catalogue has."""

    def __init__(self, code: str) -> None:
        super().__init__()
        self._known = {text for source in sources(code) for text in source}

    def gettext(self, message: str) -> str:
        return f"\N{CHECK MARK}{message}" if message in self._known else message

    def ngettext(self, msgid1: str, msgid2: str, n: int) -> str:
        return self.gettext(msgid1 if n == 1 else msgid2)


def without_translation(code: str, texts: Iterable[str]) -> list[str]:
    """Return those of some texts that a language does not reword."""
    marked = Language(code, Marked(code))
    return [text for text in texts if marked.reword(text.replace("{}", "Q"))[:1] != "\N{CHECK MARK}"]


def is_known(source: str) -> bool:
    """Whether the program has a text: as it is, or made of one with gaps."""
    if {source, source[0].lower() + source[1:]} & _known():
        return True
    if "{" in source:
        own = re.compile(re.sub(r"\\\{\w+\\\}", ".+", re.escape(source)))
        if any(own.fullmatch(text) for text in _known()):
            return True
    return any(pattern.fullmatch(source) for pattern in _patterns())


@cache
def _known() -> frozenset[str]:
    return frozenset(constants()) | {text for table in tables().values() for text in table}


@cache
def _patterns() -> list[re.Pattern[str]]:
    texts = [text for text in _known() if len(text) > 8 and "{}" in text]
    return [re.compile(re.escape(text).replace(r"\{\}", ".*")) for text in texts]


if __name__ == "__main__":
    language = sys.argv[1]
    lacking = without_translation(language, written())
    for text in lacking:
        print(f"{written()[text]}: {text!r}")
    print(f"{language}: {len(written()) - len(lacking)} of {len(written())} texts of the window")
