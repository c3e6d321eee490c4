"""The notebook is committed without outputs; CI runs it."""

from __future__ import annotations

import json
from pathlib import Path


def test_the_notebook_has_no_outputs() -> None:
    path = Path(__file__).resolve().parents[1] / "examples" / "close_the_loop.ipynb"
    cells = json.loads(path.read_text(encoding="utf-8"))["cells"]
    code = [cell for cell in cells if cell["cell_type"] == "code"]
    assert len(code) > 5
    assert all(cell["outputs"] == [] and cell["execution_count"] is None for cell in code)
