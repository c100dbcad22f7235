"""Hooks of MkDocs: notebooks as pages, with their pictures and players, and links within docstrings."""

import base64
import html
import json
import re
from pathlib import Path
from typing import Any

from mkdocs.config.defaults import MkDocsConfig
from mkdocs.structure.files import File, Files
from mkdocs.structure.pages import Page


def on_files(files: Files, config: MkDocsConfig) -> Files:
    """Add a page for each notebook, and its pictures beside it."""
    for notebook in [file for file in files if file.src_uri.endswith(".ipynb")]:
        stem = notebook.src_uri.removesuffix(".ipynb")
        text, shown = _written(json.loads(Path(config.docs_dir, notebook.src_uri).read_text("utf-8")), stem)
        text += f"\n[The notebook]({Path(notebook.src_uri).name})\n"
        files.append(File.generated(config, f"{stem}.md", content=text))
        for name, content in shown.items():
            files.append(File.generated(config, name, content=content))
    return files


def on_page_markdown(markdown: str, page: Page, config: MkDocsConfig, files: Files) -> str:
    """Let links to notebooks lead to their pages; from these, to the notebooks."""
    if page.file.src_uri.startswith("examples/"):
        return markdown
    return re.sub(r"\((examples/\w+)\.ipynb\)", r"(\1.md)", markdown)


def on_page_content(content: str, page: Page, config: MkDocsConfig, files: Files) -> str:
    """Let names that docstrings give with their roles (:class:`World`) lead to where the page has them."""
    ids = set(re.findall('id="(physicslab[.\\w]*)"', content))

    def linked(found: re.Match[str]) -> str:
        name = found[1].rpartition(".")[2] if found[0].count("~") else found[1]
        there = sorted(each for each in ids if each.endswith(f".{found[1].removeprefix('physicslab.')}"))
        code = f"<code>{name}</code>"
        return f'<a href="#{there[0]}">{code}</a>' if there else code

    return re.sub(r":\w+:<code>~?([.\w]+)</code>", linked, content)


def _written(notebook: Any, stem: str) -> tuple[str, dict[str, bytes]]:
    """Return a notebook as Markdown, and the files that it shows."""
    parts: list[str] = []
    shown: dict[str, bytes] = {}
    for cell in notebook["cells"]:
        source = "".join(cell["source"])
        parts.append(source if cell["cell_type"] == "markdown" else f"```python\n{source}\n```")
        for output in cell.get("outputs", ()):
            data = {kind: "".join(text) for kind, text in output.get("data", {}).items()}
            name = f"{stem}-{len(shown) + 1}"
            if "text" in output:
                parts.append(f"```text\n{''.join(output['text'])}```")
            elif "text/html" in data:  # a player in a frame, whose page is a file of its own here
                page = re.search('srcdoc="([^"]*)"', data["text/html"])
                assert page is not None
                shown[f"{name}.html"] = html.unescape(page[1]).encode()
                parts.append(data["text/html"].replace(page[0], f'src="../{Path(name).name}.html"'))
            elif "image/png" in data:
                shown[f"{name}.png"] = base64.b64decode(data["image/png"])
                parts.append(f"![{data['text/plain']}]({Path(name).name}.png)")
    return "\n\n".join(parts) + "\n", shown
