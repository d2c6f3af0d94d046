"""The notebook does what it says; here with little of everything."""

from __future__ import annotations

import json


from conftest import ROOT, TARGET

NOTEBOOK = ROOT / "python" / "examples" / "train_with_numpy.ipynb"
WHOLE = "GENERATIONS, CANDIDATES, STARTS, TESTS = 150, 32, 16, 400"


def test_the_notebook_runs_from_training_to_driving(monkeypatch, capsys):
    cells = json.loads(NOTEBOOK.read_text())["cells"]
    sources = ["".join(cell["source"]) for cell in cells if cell["cell_type"] == "code"]
    assert WHOLE in sources[0]
    sources[0] = sources[0].replace(WHOLE, "GENERATIONS, CANDIDATES, STARTS, TESTS = 3, 4, 2, 8")
    drives = (TARGET / "release" / "policy-server").exists()
    monkeypatch.chdir(ROOT)
    names: dict[str, object] = {}
    for source in sources if drives else sources[:-1]:
        exec(compile(source, "notebook", "exec"), names)
    said = capsys.readouterr().out
    assert "generation   2" in said and "gain" in said and "largest difference" in said
    if drives:
        assert "success" in said


def test_the_notebook_keeps_its_outputs():
    cells = json.loads(NOTEBOOK.read_text())["cells"]
    said = "".join("".join(output.get("text", [])) for cell in cells for output in cell.get("outputs", []))
    assert "gain" in said and "generation 149" in said


def test_the_strategy_fits_on_a_page():
    cells = json.loads(NOTEBOOK.read_text())["cells"]
    strategy = next(cell for cell in cells if "unpack" in "".join(cell["source"]))
    assert len([line for line in strategy["source"] if line.strip()]) <= 40
