"""The server of a live page: Bokeh's, on this machine alone."""

from __future__ import annotations

import errno
import logging
import os
import shutil
import signal
import socket
import tempfile
import threading
import webbrowser
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from bokeh.application import Application
from bokeh.application.handlers.function import FunctionHandler
from bokeh.document import Document
from bokeh.models import ColumnDataSource, Div
from bokeh.server.server import Server
from bokeh.settings import settings
from jinja2 import Environment
from tornado.ioloop import IOLoop

from .._library import Error, FileError, InputError, UsageError, whole
from .._text import option
from ..case import Case, read
from ..material_files import material_case
from .answer import Span
from .axes import axes_of
from .library import offered
from .live import MOST_BYTES, Page

_ADDRESS = "127.0.0.1"
#: Ports that no user needs a right for
_PORTS = 1024, 65535
#: A file in base 64, and what else a message has
_MOST_MESSAGE = MOST_BYTES * 4 // 3 + 100_000
_START = """
&case title = 'Steel ball dropped on a rubber pad' /
&impact drop_height = 0.3, temperature = 296.15 /
&sphere shape = 'true_sphere', diameter = 0.016, material = 'rigid as steel' /
&plate thickness = 0.02, base = 'bonded', material = 'natural rubber' /
"""
_PARTS = Path(__file__).parent


def start_case() -> Case:
    """The case of a page that is given none."""
    case = Case(_START, name="case.nml")
    for name in ("rigid as steel", "natural rubber"):
        if name not in offered():
            raise FileError("the package has no materials to begin with, expected a case: vcor "
                            "page CASE.nml")  # fmt: skip
        case.add(offered()[name].read())
    return case


def case_of(files: Sequence[str], values: Mapping[str, str] | None = None) -> Case:
    """Case of files as a page shows it: a single impact that can be solved or mended."""
    if not files:
        case = start_case()
    else:
        for path in files[1:]:
            if material_case(path)[2]:
                raise UsageError(f"{path}: found a second case, expected a file with nothing but "
                                 "&material groups")  # fmt: skip
        case = read(*files)
    for address, text in (values or {}).items():
        case[address] = text
    return case


def check(case: Case) -> Case:
    """Refuse what a page cannot begin with."""
    case.text()
    if case._axes():
        raise InputError(f"{case.name}: found a &sweep group, expected a single impact: the page "
                         "has a range of its own")  # fmt: skip
    return case


class Live:
    """A live page that is served by a thread of this process; `stop` ends it.

    In a notebook it is shown below the cell.
    """

    def __init__(self, server: Server, thread: threading.Thread) -> None:
        self._server, self._thread = server, thread

    @property
    def url(self) -> str:
        """Where a browser of this machine finds it."""
        return _url(self._server)

    def stop(self) -> None:
        """End the page."""
        loop = self._server.io_loop
        if self._thread.is_alive():
            loop.add_callback(_end, self._server)
            self._thread.join(timeout=1.0)

    def __repr__(self) -> str:
        return f"<vcor page at {self.url}>"

    def _repr_html_(self) -> str:
        return (f'<iframe src="{self.url}" width="100%" height="900" '
                'style="border:0" title="vcor page"></iframe>')  # fmt: skip


def _end(server: Server) -> None:
    """Stop the server and its loop."""
    server.stop()
    server.io_loop.stop()


def live(case: Case, *, port: int | None = None) -> Live:
    """Serve a page of a case from a thread, as `case.page()` does.

    Parameters
    ----------
    case
        A single impact; the page changes a copy.
    port
        Port on 127.0.0.1; None: a free one.

    Raises
    ------
    FileError
        The port is in use.
    InputError
        The case is wrong.
    """
    check(case)
    ready = threading.Event()
    made: list[Any] = []

    def work() -> None:
        """Serve in this thread until the end."""
        with tempfile.TemporaryDirectory(prefix="vcor-page-") as folder:
            try:
                loop = IOLoop(make_current=True)
                made.append(_server(case, [], None, port, loop, Path(folder)))
            except Error as error:
                made.append(error)
                return
            finally:
                ready.set()
            loop.start()
            loop.close()

    thread = threading.Thread(target=work, name="vcor page", daemon=True)
    thread.start()
    ready.wait()
    if isinstance(made[0], Error):
        raise made[0]
    return Live(made[0], thread)


def serve(
    files: Sequence[str], vary: Mapping[str, str], values: Mapping[str, str],
    port: int | None, *, browser: bool, quiet: bool,
) -> None:  # fmt: skip
    """Serve a page until Ctrl-C, as `vcor page` does."""
    case = check(case_of(files, values))
    span = None
    if vary:
        axis = axes_of(case, vary)[0]
        first, last = (float(one) for one in axis.si(axis.nodes(2)))
        span = Span(axis.address, first, last, axis.is_log)
    # a browser that goes away ends its own connection, not the program
    signal.signal(signal.SIGPIPE, signal.SIG_IGN)
    own = [] if values else list(files)
    with tempfile.TemporaryDirectory(prefix="vcor-page-") as folder:

        def end(*_: object) -> None:
            """End at once.

            An exception might be lost in the midst of a callback, and threads that still solve for
            pages are of no use to anybody.
            """
            shutil.rmtree(folder, ignore_errors=True)
            os._exit(0)

        for one in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            # one that is ignored, as under nohup, stays so
            if signal.getsignal(one) is not signal.SIG_IGN:
                signal.signal(one, end)
        server = _server(case, own, span, port, IOLoop.current(), Path(folder))
        if not quiet:
            _print(f"vcor page: {_url(server)} (Ctrl-C ends it)")
        if browser and not _open(_url(server)):
            _print(f"vcor: note: found no browser; open {_url(server)} in one")
        server.io_loop.start()


def _print(line: str) -> None:
    """Write a line at once, past what collects the output of a command to its end."""
    os.write(2, f"{line}\n".encode())


def _open(url: str) -> bool:
    """Open a browser, whatever it prints is not that of the command."""
    try:
        return webbrowser.open(url)
    except (OSError, webbrowser.Error):
        return False


def _url(server: Server) -> str:
    """Address of the page."""
    return f"http://{_ADDRESS}:{server.port}/"


def _server(
    case: Case, files: Sequence[str], span: Span | None, port: int | None, loop: IOLoop,
    folder: Path,
) -> Server:  # fmt: skip
    """A server that has begun."""
    if port is not None:
        whole(port, option("port"), *_PORTS)
    number = port or _free_port()
    hosts = [f"{name}:{number}" for name in (_ADDRESS, "localhost")]
    # what the environment says of both is for other servers
    settings.resources = "server"
    settings.allowed_ws_origin = hosts
    for name in ("bokeh", "tornado"):
        logging.getLogger(name).setLevel(logging.ERROR)
    application = Application(
        FunctionHandler(lambda document: _fill(document, case, files, span, folder))
    )
    try:
        server = Server(
            {"/": application}, io_loop=loop, port=number, address=_ADDRESS,
            allow_websocket_origin=hosts, websocket_max_message_size=_MOST_MESSAGE,
        )  # fmt: skip
    except OSError as error:
        words = "is in use" if error.errno == errno.EADDRINUSE else (error.strerror or "fails")
        raise FileError(f"port {number} of {_ADDRESS} {words}, expected another one: "
                        f"{option('port', ...)}") from None  # fmt: skip
    server.start()
    return server


def _free_port() -> int:
    """A port that is free now."""
    with socket.socket() as one:
        one.bind((_ADDRESS, 0))
        return int(one.getsockname()[1])


def _fill(
    document: Document, case: Case, files: Sequence[str], span: Span | None, folder: Path
) -> None:
    """Make the document of a browser tab."""
    page = Page(document, case.copy(), files, span, folder)
    scheme = ColumnDataSource(data={"dark": []}, name="scheme")
    scheme.on_change(
        "data", lambda _a, _o, new: page.set_dark(bool(new["dark"] and new["dark"][0]))
    )
    holder = Div(text="", visible=False, name="scheme_holder")
    holder.tags = [scheme]
    document.add_root(holder)
    title = str(case["case.title"] or "").strip() or Path(case.name).stem
    document.title = title
    document.template = Environment(autoescape=False).from_string(  # noqa: S701
        (_PARTS / "live.html").read_text(encoding="utf-8")
    )
    style = "".join(
        (_PARTS / name).read_text(encoding="utf-8") for name in ("page.css", "live.css")
    )
    script = (_PARTS / "live.js").read_text(encoding="utf-8")
    document.template_variables.update(page_style=style, page_script=script)
