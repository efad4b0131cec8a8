"""Progress of what takes long."""

from __future__ import annotations

import contextlib
import sys
import types
import warnings
from typing import Any

#: Sweeps that take longer show a progress bar in a terminal [s]
_BAR_DELAY = 1.0


def progress_bar(total: int | None, progress: bool | None) -> Any:
    """A progress bar, or none; a total that is not known is None."""
    shell = getattr(sys.modules.get("IPython"), "get_ipython", lambda: None)()
    if progress is None:
        progress = sys.stderr.isatty() or hasattr(shell, "kernel")
    if not progress:
        return contextlib.nullcontext(types.SimpleNamespace(update=lambda _: None))
    with warnings.catch_warnings():
        # a notebook without ipywidgets has the bar of a terminal
        warnings.simplefilter("ignore")
        from tqdm.auto import tqdm

    return tqdm(total=total, unit="impact", delay=_BAR_DELAY)
