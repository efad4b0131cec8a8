"""Results of a command: its report, its files and a figure."""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Mapping
from typing import Any

from ._text import place, write


def finish(
    options: argparse.Namespace, report: str, stem: str, contents: Mapping[str, Any], figure: Any
) -> None:
    """Write texts, bytes or what goes into JSON, by the ends of names, and a figure, and report.

    The figure may be None.
    """
    folder = options.output if options.output.endswith("/") else f"{options.output}/"
    paths = [place(folder, stem + end.rpartition(".")[0], [end.rpartition(".")[2]], None, [])
             for end in contents]  # fmt: skip
    for path, content in zip(paths, contents.values(), strict=True):
        if not isinstance(content, (str, bytes)):
            content = json.dumps(content, indent=1) + "\n"
        write(path, content if isinstance(content, bytes) else content.encode())
    if figure is not None:
        from .plot import save

        paths.append(place(folder, stem, [options.format], None, []))
        save(figure, paths[-1])
    if not options.quiet:
        sys.stdout.write(f"{report}\nwritten {', '.join(map(str, paths))}\n")
