"""Files that are not cases: the error names the file, not a key."""

import os
import shutil

import pytest
from cases import SLS, edit
from program import FILE, INPUT

COMMANDS = ["run", "check"]


@pytest.mark.parametrize("command", COMMANDS)
def test_missing_file(vcor, command):
    vcor.refuses(command, "no.nml", code=FILE, at="no.nml", says="no such file")


@pytest.mark.parametrize("command", COMMANDS)
def test_missing_folder(vcor, command):
    vcor.refuses(command, "no/case.nml", code=FILE, at="no/case.nml", says="no such file")


@pytest.mark.parametrize("command", COMMANDS)
def test_directory(vcor, command):
    (vcor.folder / "case.nml").mkdir()
    vcor.refuses(command, "case.nml", code=FILE, at="case.nml", says="directory")


@pytest.mark.skipif(os.geteuid() == 0, reason="root may read every file")
def test_unreadable_file(vcor):
    path = vcor.folder / vcor.write(SLS)
    path.chmod(0)
    vcor.refuses("run", "case.nml", code=FILE, at="case.nml", says="ermission")


def test_link_to_nowhere(vcor):
    (vcor.folder / "case.nml").symlink_to("nowhere.nml")
    vcor.refuses("run", "case.nml", code=FILE, at="case.nml", says="no such file")


@pytest.mark.parametrize("command", COMMANDS)
@pytest.mark.parametrize("text", ["", "\n", "   \n\n", "! only a remark\n", "\ufeff"])
def test_empty_file(vcor, command, text):
    vcor.write(text)
    vcor.refuses(command, "case.nml", code=INPUT, says=["case.nml", "&impact"])


def test_text_that_is_no_namelist(vcor):
    vcor.write("velocity = 10\n")
    vcor.refuses("run", "case.nml", code=INPUT, at="case.nml:1", says="&")


@pytest.mark.parametrize("n", [1, 100, 100_000])
def test_random_bytes(vcor, n):
    state, data = 1, bytearray()
    for _ in range(n):
        state = (state * 1103515245 + 12345) % 2**31
        data.append(state >> 16 & 255)
    vcor.write(bytes(data))
    vcor.refuses("run", "case.nml", code=INPUT, at="case.nml:1")


def test_zero_byte(vcor):
    vcor.write(SLS.replace("'steel'", "'st\0eel'", 1))
    vcor.refuses("run", "case.nml", code=INPUT, at="case.nml:9", says="byte 0")


def test_program_as_a_case(vcor):
    vcor.refuses("run", shutil.which("true"), code=INPUT, says=":1: ")


def test_not_utf8(vcor):
    vcor.write(SLS.encode().replace(b"Ball", b"B\xe4ll"))
    vcor.refuses("run", "case.nml", code=INPUT, at="case.nml:2", says="UTF-8")


@pytest.mark.parametrize("filler", ["x", "1 ", "'", "&", "9"])
def test_long_line(vcor, filler):
    text, line = edit(SLS, "impact", "velocity", filler * (1_000_000 // len(filler)))
    vcor.write(text)
    vcor.refuses("run", "case.nml", code=INPUT, says=f"case.nml:{line}: ")


def test_long_line_that_is_right(vcor):
    """Blanks and remarks may be as long as they like."""
    text, _ = edit(SLS, "impact", "velocity", " " * 1_000_000 + "10.0 !" + "x" * 1_000_000)
    vcor.write(text)
    vcor.write(SLS, "short.nml")
    assert vcor.numbers("case.nml") == vcor.numbers("short.nml")


@pytest.mark.parametrize("quote", ["'", '"'])
def test_string_cut_off(vcor, quote):
    text, line = edit(SLS, "case", "title", f"{quote}Ball on plate")
    vcor.write(text)
    vcor.refuses("run", "case.nml", code=INPUT, at=f"case.nml:{line}", says="quote")


def test_string_cut_off_by_the_end_of_the_file(vcor):
    vcor.write(SLS + "&contact law = 'boltz")
    vcor.refuses("run", "case.nml", code=INPUT, says=["case.nml:", "quote"])


def test_group_cut_off(vcor):
    vcor.write(SLS.rstrip("/\n") + "\n")
    vcor.refuses("run", "case.nml", code=INPUT, says=["case.nml:", "end of the file", "&material"])


def test_group_cut_off_by_another(vcor):
    vcor.write(SLS.replace("/\n", "", 1))
    vcor.refuses("run", "case.nml", code=INPUT, says=["case.nml:", "&case", "/"])


def test_every_prefix(vcor):
    """A file that was cut off anywhere is refused, or is complete."""
    end = len(SLS.rstrip())
    for length in range(0, end, 13):
        vcor.write(SLS[:length])
        vcor.refuses("check", "case.nml", code=INPUT, says="case.nml")


@pytest.mark.parametrize("name, nearest", [("plat", "plate"), ("spere", "sphere")])
def test_unknown_group(vcor, name, nearest):
    text = SLS.replace(f"&{nearest}\n", f"&{name}\n")
    line = text.splitlines().index(f"&{name}") + 1
    vcor.write(text)
    vcor.refuses("run", "case.nml", code=INPUT, at=f"case.nml:{line}", says=[name, nearest])


def test_group_given_twice(vcor):
    vcor.write(SLS + "&impact velocity = 5.0 /\n")
    line = SLS.count("\n") + 1
    vcor.refuses("run", "case.nml", code=INPUT, at=f"case.nml:{line}", says=["&impact", "twice"])


@pytest.mark.parametrize("group", ["impact", "sphere", "plate"])
def test_group_missing(vcor, group):
    start = SLS.index(f"&{group}")
    vcor.write(SLS[:start] + SLS[SLS.index("/\n", start) + 2 :])
    vcor.refuses("run", "case.nml", code=INPUT, at="case.nml", says=f"&{group}")


def test_text_between_groups(vcor):
    vcor.write(SLS.replace("&impact", "velocity = 3\n&impact"))
    vcor.refuses("run", "case.nml", code=INPUT, at="case.nml:4", says="velocity")


def test_first_of_several_files_is_not_run_when_the_last_is_wrong(vcor):
    vcor.write(SLS, "good.nml")
    text, line = edit(SLS, "impact", "velocity", "fast")
    vcor.write(text, "bad.nml")
    vcor.refuses("run", "good.nml", "bad.nml", code=INPUT, at=f"bad.nml:{line}", says="fast")
