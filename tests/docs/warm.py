"""The commands of the package, each in a process of its own that is forked from one which has imported what they
need: that takes a second, and the pages have some hundred commands.

As a program: the process that forks, with a listening socket as its standard input. `CLIENT` is what stands in the
PATH for a command: it hands over its words, folder, environment and standard files, and leaves with the exit code.
"""

import contextlib
import json
import os
import socket
import subprocess
import sys
import traceback

CLIENT = """#!{python} -ISB
import json, os, socket, sys
with socket.socket(socket.AF_UNIX) as server:
    server.connect("{place}")
    words = [os.path.basename(sys.argv[0]), *sys.argv[1:]]
    call = json.dumps([words, os.getcwd(), dict(os.environ)]).encode()
    socket.send_fds(server, [len(call).to_bytes(8, "little")], [0, 1, 2])
    server.sendall(call)
    sys.exit(server.recv(1)[0])
"""


@contextlib.contextmanager
def commands_in(folder, names):
    """Make the commands vcor-NAME in a folder while this lasts."""
    place = folder / "socket"
    with socket.socket(socket.AF_UNIX) as listening:
        listening.bind(str(place))
        listening.listen()
        with subprocess.Popen([sys.executable, __file__], stdin=listening) as server:
            for name in names:
                script = folder / f"vcor-{name}"
                script.write_text(CLIENT.format(python=sys.executable, place=place))
                script.chmod(0o755)
            try:
                yield
            finally:
                server.terminate()


def _answer(caller):
    """Run the command that a client calls, in this process; its exit code."""
    from vcor import _command

    size, files, *_ = socket.recv_fds(caller, 8, 3)
    with caller.makefile("rb") as text:
        words, folder, environment = json.loads(text.read(int.from_bytes(size, "little")))
    for i, file in enumerate(files):
        os.dup2(file, i)
        os.close(file)
    os.environ.clear()
    os.environ.update(environment)
    os.chdir(folder)
    sys.argv = words
    try:
        getattr(_command, words[0].removeprefix("vcor-"))()
        code = 0
    except SystemExit as leaving:
        code = leaving.code or 0
    except BaseException:
        traceback.print_exc()
        code = 1
    sys.stdout.flush()
    sys.stderr.flush()
    return code


def main():
    """Fork for each call."""
    # imported as the commands import them
    import importlib
    import io
    import signal

    import matplotlib.figure
    import xarray as xr

    from vcor._command import MODULES

    for name in (*(f"vcor.{name}" for name in MODULES.values()), "SALib.sample.sobol", "SALib.analyze.sobol"):
        importlib.import_module(name)
    # xarray imports dask with its first column, Matplotlib what writes a file with the first
    xr.Variable("x", [0.0])
    for ending in ("svg", "png"):
        matplotlib.figure.Figure().savefig(io.BytesIO(), format=ending)
    listening = socket.socket(fileno=0)
    # nobody waits for a child, whose client does
    signal.signal(signal.SIGCHLD, signal.SIG_IGN)
    while True:
        caller, _ = listening.accept()
        with caller:
            if os.fork():
                continue
            signal.signal(signal.SIGCHLD, signal.SIG_DFL)
            try:
                caller.sendall(bytes([_answer(caller)]))
            finally:
                os._exit(0)


if __name__ == "__main__":
    main()
