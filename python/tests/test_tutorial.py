"""The notebook examples/tutorial.ipynb: its cells run and print what stands in it."""

import contextlib
import io
import json
import shutil
import warnings

from conftest import ROOT


def test_the_tutorial(tmp_path, monkeypatch):
    shutil.copytree(ROOT / "examples", tmp_path / "examples")
    monkeypatch.chdir(tmp_path / "examples")
    monkeypatch.setenv("MPLBACKEND", "agg")
    notebook = json.loads((ROOT / "examples/tutorial.ipynb").read_text(encoding="utf-8"))
    names = {}
    for cell in notebook["cells"]:
        if cell["cell_type"] != "code":
            continue
        printed = io.StringIO()
        with contextlib.redirect_stdout(printed), warnings.catch_warnings():
            warnings.filterwarnings("ignore", "FigureCanvasAgg is non-interactive")
            exec("".join(cell["source"]), names)
        texts = [output for output in cell["outputs"] if output["output_type"] == "stream"]
        assert printed.getvalue() == "".join(line for text in texts for line in text["text"])
        assert all(text["name"] == "stdout" for text in texts)
