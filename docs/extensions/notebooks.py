"""Reads pages whose Python blocks make up a program as notebooks.

The build executes the notebooks and offers them for download.
"""

import re

from nbformat import NotebookNode
from nbformat.v4 import new_code_cell, new_markdown_cell, new_notebook

_BLOCK = re.compile(r"^```python\n(.*?)^```$\n?", re.MULTILINE | re.DOTALL)
_KERNEL = {"name": "python3", "display_name": "Python 3", "language": "python"}


def read(page: str) -> NotebookNode:
    """Returns a page of Markdown as a notebook: a cell for each block of Python."""
    cells, lines, end = [], [], 0
    for block in _BLOCK.finditer(page):
        cells += [
            new_markdown_cell(page[end : block.start()]),
            new_code_cell(block[1].rstrip()),
        ]
        lines += [page.count("\n", 0, at) for at in (end, block.start())]
        end = block.end()
    cells.append(new_markdown_cell(page[end:]))
    lines.append(page.count("\n", 0, end))
    return new_notebook(cells=cells, metadata={"kernelspec": _KERNEL, "source_map": lines})
