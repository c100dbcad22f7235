"""Write the page of all components and their fields: ``uv run python docs/components.py``."""

from pathlib import Path

import physicslab.components  # which lists each of them
from physicslab.ecs.component import COMPONENTS, Component
from physicslab.ecs.fields import REQUIRED, Field

PAGE = Path(__file__).parent / "components.md"
_HEAD = f"""# Components

All components of `{physicslab.components.__name__}`, with their fields in the order in which they are given:
`Mass(2.0)`, `Mass(mass="2 kg")`. Scene files have the same names. A number with a unit is in SI, or a text
with a unit. `uv run python docs/components.py` writes this page.
"""
_COLUMNS = "| field | default | allowed | what it is |\n|---|---|---|---|\n"


def page() -> str:
    """Return the page, in Markdown."""
    named = vars(physicslab.components)
    own = [kind for name, kind in COMPONENTS.items() if named.get(name) is kind]
    return "\n".join([_HEAD, *map(_section, sorted(own, key=lambda kind: kind.__name__))])


def _section(kind: type[Component]) -> str:
    words = (kind.__doc__ or "").partition("\nParameters\n")[0].strip()
    rows = "\n".join(_row(field) for field in kind.FIELDS)
    return f"## {kind.__name__}\n\n{words}\n\n{_COLUMNS}{rows}\n"


def _row(field: Field) -> str:
    cells = f"`{field.name}`", _default(field), field.allowed, field.meaning or field.name
    return f"| {' | '.join(cell.replace('|', '&#124;') for cell in cells)} |"


def _default(field: Field) -> str:
    if field.default is REQUIRED:
        return "must be given"
    if field.default is None:
        return field.derived or "none"
    shown = field.default
    if field.kind == "vector":
        shown = [float(part) for part in shown]
    return f"`{shown}`" if shown not in ("", (), []) else "empty"


if __name__ == "__main__":
    PAGE.write_text(page(), encoding="utf-8")
