"""The notebooks of the docs: executed, they show what is kept in them."""

import io
from pathlib import Path
from typing import Any

import numpy as np
import pygame
import pytest

pytestmark = [pytest.mark.notebook, pytest.mark.slow]
NOTEBOOKS = sorted((Path(__file__).parent.parent / "docs" / "examples").glob("*.ipynb"))
_WIDGET = "application/vnd.jupyter.widget-view+json"


def executed(path: Path) -> Any:
    """Return a notebook with what its cells show now, without what differs from run to run."""
    nbformat, nbclient = pytest.importorskip("nbformat"), pytest.importorskip("nbclient")
    pytest.importorskip("anywidget")
    found = nbformat.read(path, as_version=4)
    about = dict(found.metadata)
    where = {"metadata": {"path": str(path.parent)}}
    nbclient.NotebookClient(
        found, timeout=900, kernel_name="python3", resources=where, store_widget_state=False,
        record_timing=False,
    ).execute()  # fmt: skip
    found.metadata = about
    for output in outputs(found):
        output.get("data", {}).pop(_WIDGET, None)
    return found


def outputs(notebook: Any) -> list[Any]:
    """Return what the cells of a notebook show, in order."""
    return [one for cell in notebook.cells if cell.cell_type == "code" for one in cell.outputs]


def texts(notebook: Any) -> list[str]:
    """Return what is printed; warnings are no part of an example."""
    streams = [one for one in outputs(notebook) if one.output_type == "stream"]
    assert {one.name for one in streams} == {"stdout"}, streams
    return [one.text for one in streams]


def pictures(notebook: Any) -> list[pygame.Surface]:
    """Return the pictures that are shown."""
    import base64

    shown = [one.data["image/png"] for one in outputs(notebook) if "image/png" in one.get("data", {})]
    return [pygame.image.load(io.BytesIO(base64.b64decode(text)), "figure.png") for text in shown]


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_a_notebook_shows_what_is_kept_in_it(path: Path, pytestconfig: pytest.Config) -> None:
    nbformat = pytest.importorskip("nbformat")
    kept, fresh = nbformat.read(path, as_version=4), executed(path)
    if pytestconfig.getoption("renew_notebooks"):
        path.write_text(nbformat.writes(fresh) + "\n", encoding="utf-8")
        kept = fresh
    assert texts(fresh) == texts(kept) != []
    figures = pictures(fresh)
    sizes = [[figure.get_size() for figure in shown] for shown in (figures, pictures(kept))]
    # Numbers along an axis of the time that runs took are now longer, now shorter.
    assert np.allclose(sizes[0], sizes[1], rtol=0.0, atol=9.0), sizes
    assert figures
    for figure in figures:
        width, height = figure.get_size()
        colours = {tuple(figure.get_at((x, y))) for x in range(0, width, 3) for y in range(0, height, 3)}
        assert width > 500 and height > 250 and len(colours) > 25


def test_there_are_four() -> None:
    assert [path.stem for path in NOTEBOOKS] == ["chaos", "fit", "methods", "throws"]
