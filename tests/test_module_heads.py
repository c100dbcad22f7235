"""What stands above the code of a module: only what something reads."""

import ast
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import pytest

PACKAGE = Path(__file__).parent.parent / "physicslab"
FOLDERS = (
    "commands", "components", "contacts", "desktop", "diagnostics", "ecs", "export", "files", "history",
    "integrators", "lab", "languages", "lessons", "ode", "prefabs", "scenes", "state", "stepping",
    "systems", "view",
    "kernels/constraint", "kernels/forces", "kernels/joints", "kernels/ode", "kernels/sleep", "kernels/wide",
)  # fmt: skip
"""The folders that hold to it; the others follow."""


@cache
def modules() -> list[tuple[str, ast.Module]]:
    """Return the modules of these folders, parsed, with their paths."""
    paths = [path for folder in FOLDERS for path in sorted((PACKAGE / folder).rglob("*.py"))]
    return [(str(path.relative_to(PACKAGE)), ast.parse(path.read_text(encoding="utf-8"))) for path in paths]


def names(node: ast.AST) -> set[str]:
    return {part.id for part in ast.walk(node) if isinstance(part, ast.Name)}


def defined(statement: ast.stmt) -> set[str]:
    """Return the names that a statement of a module binds, imports left out."""
    match statement:
        case ast.FunctionDef(name=name) | ast.ClassDef(name=name):
            return {name}
        case ast.Assign(targets=targets):
            return set().union(*map(names, targets))
        case ast.AnnAssign(target=target) | ast.TypeAlias(name=target):
            return names(target)
    return set()


def annotations(node: ast.AST) -> Iterator[ast.expr]:
    """Yield the annotations that are evaluated when a module is imported, those in functions left out."""
    match node:
        case ast.FunctionDef(args=taken, returns=returned):
            yield from (
                part.annotation for part in ast.walk(taken) if isinstance(part, ast.arg) and part.annotation
            )
            yield from [returned] if returned else []
        case ast.AnnAssign(annotation=annotation):
            yield annotation
        case ast.ClassDef(body=body) | ast.If(body=body):
            for part in body:
                yield from annotations(part)


def is_named_later(tree: ast.Module) -> bool:
    """Return whether an annotation names what is bound only after it, or for type checkers alone."""
    bound: set[str] = set()
    later = set().union(*map(defined, tree.body))
    for statement in tree.body:
        if isinstance(statement, ast.If) and names(statement.test) == {"TYPE_CHECKING"}:
            return True
        if any(names(part) & (later - bound) for part in annotations(statement)):
            return True
        bound |= defined(statement)
    return False


def test_all_is_written_only_where_names_of_others_are_passed_on() -> None:
    wrong = []
    for path, tree in modules():
        for statement in tree.body:
            if isinstance(statement, ast.Assign) and names(statement.targets[0]) == {"__all__"}:
                listed = set(ast.literal_eval(statement.value))
                if listed <= set().union(*map(defined, tree.body)):
                    wrong.append(path)
    assert not wrong, "public is what has no underscore in front"


def test_annotations_are_deferred_only_where_they_name_what_comes_later() -> None:
    wrong = [
        path
        for path, tree in modules()
        if any(isinstance(part, ast.ImportFrom) and part.module == "__future__" for part in tree.body)
        and not is_named_later(tree)
    ]
    assert not wrong


@pytest.mark.parametrize(("source", "later"), [
    ("class A:\n    def f(self) -> A: ...", True),
    ("def f(a: A) -> None: ...\nclass A: ...", True),
    ("class A: ...\ndef f(a: A) -> A: ...", False),
])  # fmt: skip
def test_what_is_named_later_is_found(source: str, later: bool) -> None:
    assert is_named_later(ast.parse(source)) is later
