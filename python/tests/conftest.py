"""What the tests share: where the repository is, and its program."""

from __future__ import annotations

import os
import pathlib
import subprocess

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]
TARGET = pathlib.Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target"))


@pytest.fixture(scope="session")
def program() -> pathlib.Path:
    """The program `vodca`, which `.ci/run` has built already; otherwise it is built here."""
    built = TARGET / "release" / "vodca"
    command = ["cargo", "build", "--release", "--locked", "--bins", "-p", "cli", "-p", "agent", "-q"]
    subprocess.run(command, cwd=ROOT, check=True)
    return built


@pytest.fixture
def recorded(program: pathlib.Path, tmp_path: pathlib.Path):
    """Runs `./run.sh run ARGUMENTS` and gives the folder."""

    def run(name: str, *arguments: str) -> pathlib.Path:
        folder = tmp_path / name.replace(":", "-")
        command = [program, "run", "--scenario", name, "--out", folder, *arguments]
        done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
        assert done.returncode in (0, 1), done.stderr
        return folder

    return run
