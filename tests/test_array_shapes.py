"""Public functions on arrays say what shape they take: by a named type that does, or in their docstring."""

import ast
import re
from collections.abc import Iterator
from pathlib import Path

PACKAGE = Path(__file__).parent.parent / "physicslab"
SHAPE = re.compile(r"\((?:\.{3}|\w[\w +-]*)(?:,(?: [\w. +-]+)?)+\)|\bshapes?\b")
"""``(n,)``, ``(rows, 2)``, ``(2 rows, k)``; or words on the shape."""
NAMED = {"Numbers", "Vectors", "Rows", "Flags", "Masks"}
"""The types of ``physicslab/kernels/types.py``, whose docstrings have it."""


def shaped_aliases(tree: ast.Module) -> set[str]:
    """Return the types of a module whose docstring gives a shape, and those that it takes from kernels."""
    found = set()
    for statement, following in zip(tree.body, [*tree.body[1:], None], strict=True):
        match statement, following:
            case ast.TypeAlias(name=ast.Name(id=name)), ast.Expr(value=ast.Constant(value=str(words))):
                found |= {name} if SHAPE.search(words) else set()
            case ast.ImportFrom(module=str(module), names=names), _ if module.startswith(
                "physicslab.kernels"
            ):
                found |= {alias.asname or alias.name for alias in names} & NAMED
    return found


def public_functions(tree: ast.Module) -> Iterator[ast.FunctionDef]:
    """Yield functions of a module, and methods of its classes, that have no underscore in front."""
    for statement in tree.body:
        match statement:
            case ast.FunctionDef(name=name) if not name.startswith("_"):
                yield statement
            case ast.ClassDef(name=name, body=body) if not name.startswith("_"):
                yield from (
                    part
                    for part in body
                    if isinstance(part, ast.FunctionDef) and not part.name.startswith("_")
                )


def unshaped(tree: ast.Module) -> Iterator[str]:
    """Yield types of arrays without a shape, and functions that take an array of which nothing gives it."""
    shaped = shaped_aliases(tree)
    arrays = {"NDArray"} | {
        statement.name.id
        for statement in tree.body
        if isinstance(statement, ast.TypeAlias) and "NDArray" in ast.unparse(statement.value)
    }
    yield from sorted(name for name in arrays - shaped - {"NDArray"} if not name.startswith("_"))
    for function in public_functions(tree):
        taken = [
            ast.unparse(part.annotation)
            for part in ast.walk(function.args)
            if isinstance(part, ast.arg) and part.annotation
        ]
        bare = [text for text in taken if set(re.findall(r"\w+", text)) & (arrays - shaped)]
        if bare and not SHAPE.search(ast.get_docstring(function) or ""):
            yield function.name


def test_array_arguments_have_a_shape() -> None:
    paths = sorted(PACKAGE.rglob("*.py"))
    missing = [
        f"{path.relative_to(PACKAGE)}: {name}"
        for path in paths
        for name in unshaped(ast.parse(path.read_text(encoding="utf-8")))
    ]
    assert not missing


def test_a_missing_shape_is_found() -> None:
    head = "type _Bare = NDArray[float]\ntype Row = NDArray[float]\n'''A row (n,).'''\n"
    bare = "def f(x: _Bare) -> None:\n    '''Do it with x [m].'''"
    assert list(unshaped(ast.parse(head + bare))) == ["f"]
    assert not list(unshaped(ast.parse(head + bare.replace("[m]", "(n, 2) [m]"))))
    assert not list(unshaped(ast.parse(head + bare.replace("_Bare", "Row"))))
    assert not list(unshaped(ast.parse(head + bare.replace("def f", "def _f"))))
    assert list(unshaped(ast.parse(head.replace("_Bare", "Bare")))) == ["Bare"]
