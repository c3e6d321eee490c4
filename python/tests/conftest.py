"""The program beside which the package is put, and records for all tests."""

from __future__ import annotations

import os
import subprocess
from pathlib import Path
from typing import Any, Callable

import pytest

import records

Run = Callable[..., str]


@pytest.fixture(scope="session")
def program() -> Run:
    """Runs the program `bowden` of this repository, named by BOWDEN_PROGRAM; gives its stdout."""
    path = os.environ.get("BOWDEN_PROGRAM")
    if path is None:
        target = Path(__file__).resolve().parents[2] / "target"
        built = [target / profile / "bowden" for profile in ("debug", "release")]
        path = next((str(p) for p in built if p.is_file()), None)
    if path is None:
        pytest.skip("no program: `cargo build -p bowden-cli` builds it, BOWDEN_PROGRAM names it")

    def run(*arguments: object) -> str:
        command = [str(path), *map(str, arguments)]
        done = subprocess.run(command, capture_output=True, text=True, encoding="utf-8")
        assert done.returncode == 0, done.stderr
        return done.stdout

    return run


@pytest.fixture(scope="session")
def viscous() -> dict[str, Any]:
    """Lacks viscous friction at phi_p."""
    return records.torque(seed=1, viscous=1.2)


@pytest.fixture(scope="session")
def plain() -> dict[str, Any]:
    """Lacks nothing; another motion of the same rig as `viscous` without its friction."""
    return records.torque(seed=2)
