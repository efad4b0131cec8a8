"""Words of the command line: what is refused, and what each option does."""

import os
import re
import subprocess

import pytest
from cases import SLS
from program import FILE, INPUT, SUCCESS, USAGE, complaint


@pytest.fixture
def sls(vcor):
    vcor.write(SLS)
    return vcor


def names(folder):
    return {path.name for path in folder.iterdir()}


FILES = {"case.csv", "case.h5", "case_summary.csv"}


def test_no_command(vcor):
    vcor.refuses(code=USAGE, says=["no command", "run", "check", "verify", "help"])


@pytest.mark.parametrize(
    "word, nearest",
    [("runn", "run"), ("chek", "check"), ("hlep", "help"), ("uncertanty", "uncertainty")],
)
def test_unknown_command(vcor, word, nearest):
    vcor.refuses(word, "case.nml", code=USAGE, says=[f"'{word}'", f"'{nearest}'"])


@pytest.mark.parametrize(
    "word", ["", "sweep", "--", "-x", "--verbose", "\n", "\x1b[31m"]
)
def test_no_command_at_all(vcor, word):
    vcor.refuses(word, code=USAGE, says=["command", "run", "check", "help"])


def test_a_program_of_that_name(vcor, tmp_path, monkeypatch):
    """`vcor hello` is `vcor-hello` of PATH, with its words, output and exit code; `vcor run` is not."""
    folder = tmp_path / "bin"
    folder.mkdir()
    for name in ("vcor-hello", "vcor-run"):
        (folder / name).write_text('#!/bin/sh\nprintf "[%s]" "$@"\nexit 7\n')
        (folder / name).chmod(0o755)
    (folder / "vcor-locked").write_text("nothing that can be run")
    monkeypatch.setenv("PATH", f"{folder}:{os.environ['PATH']}")
    for words, code, shown in (
        (["hello", "--x=1", "two words", ""], 7, "[--x=1][two words][]"),
        (["hello"], 7, "[]"),
        (["run"], USAGE, ""),
        (["locked"], USAGE, ""),
        (["hello/../hello"], USAGE, ""),
    ):
        done = subprocess.run(
            [os.environ["VCOR"], *words], capture_output=True, encoding="utf-8", check=False
        )
        assert (done.returncode, done.stdout) == (code, shown), words
        assert bool(done.stderr) == (code == USAGE)


@pytest.mark.parametrize("word, nearest", [("--versoin", "--version"), ("--hepl", "--help")])
def test_unknown_option_without_command(vcor, word, nearest):
    vcor.refuses(word, code=USAGE, says=[f"'{word}'", f"'{nearest}'"])


@pytest.mark.parametrize("command", ["run", "check"])
@pytest.mark.parametrize("words", [[], ["--"], ["--set", "impact.velocity=1"]])
def test_no_case_file(vcor, command, words):
    vcor.refuses(command, *words, code=USAGE, says=["no case file", f"vcor {command}"])


@pytest.mark.parametrize("command", ["run", "check"])
def test_empty_name_of_a_file(vcor, command):
    vcor.refuses(command, "", code=FILE, says="empty")


@pytest.mark.parametrize(
    "command, word, nearest",
    [
        ("verify", "--sett", "--set"),
        ("verify", "--quite", "--quiet"),
        ("run", "--quite", "--quiet"),
        ("run", "--ouput", "--output"),
        ("run", "--prnt=cor", "--print"),
        ("run", "--sett", "--set"),
        ("check", "--sets", "--set"),
        ("help", "--hepl", "--help"),
    ],
)
def test_unknown_option(sls, command, word, nearest):
    option = word.partition("=")[0]
    sls.refuses(command, word, "case.nml", code=USAGE, says=[f"'{option}'", f"'{nearest}'"])


@pytest.mark.parametrize("word", ["-q", "-o", "--jobs", "-", "--Quiet", "-–set", "--set\n"])
def test_option_like_no_other(sls, word):
    if word == "-":
        sls.refuses("run", word, code=FILE, at="-", says="no such file")
    else:
        sls.refuses("run", "case.nml", word, "2", code=USAGE, says="unknown option")


@pytest.mark.parametrize("word", ["--output", "--print"])
def test_option_of_run_not_of_verify(sls, word):
    sls.refuses("verify", "case.nml", word, "x", code=USAGE, says=[f"'{word}'", "verify"])


@pytest.mark.parametrize("word", ["--output", "--print", "--quiet"])
def test_option_of_run_only(sls, word):
    sls.refuses("check", "case.nml", word, "x", code=USAGE, says=[f"'{word}'", "check"])


def test_two_options_in_one_word(sls):
    sls.refuses("run", "case.nml", "--set --output", "x", code=USAGE, says="unknown option")


@pytest.mark.parametrize("option", ["--set", "--output", "--print"])
def test_missing_value(sls, option):
    sls.refuses("run", "case.nml", option, code=USAGE, says=[option, "needs a value"])
    sls.refuses("run", option, "", "case.nml", code=USAGE, says=[option, "needs a value"])
    sls.refuses("run", f"{option}=", "case.nml", code=USAGE, says=[option, "needs a value"])
    sls.refuses("run", f"{option}= ", "case.nml", code=USAGE, says=[option, "needs a value"])


@pytest.mark.parametrize("option", ["--set", "--print"])
def test_option_for_a_value(sls, option):
    sls.refuses("run", "case.nml", option, "--quiet", code=USAGE, says=option)


def test_option_for_the_value_of_output(sls):
    sls.refuses("run", "case.nml", "--output", "--quiet", code=USAGE, says="--output")


def test_value_that_begins_with_dashes(sls):
    assert sls.succeeds("run", "case.nml", "--quiet", "--output=--out") == ""
    assert names(sls.folder / "--out") == FILES


def test_quiet_takes_no_value(sls):
    sls.refuses("run", "case.nml", "--quiet=yes", code=USAGE, says=["--quiet", "no value"])


def test_run(sls):
    out = sls.succeeds("run", "case.nml")
    assert names(sls.folder) == FILES | {"case.nml"}
    assert "case.nml" in out and "Ball on plate" in out
    assert all(name in out for name in FILES)


def test_run_of_several(sls):
    sls.write(SLS, "b.nml")
    sls.write(SLS, "folder/c.nml")
    out = sls.succeeds("run", "case.nml", "b.nml", "folder/c.nml")
    stems = {"case", "b", "c"}
    files = {f"{stem}{end}" for stem in stems for end in ("_summary.csv", ".csv", ".h5", ".nml")}
    assert names(sls.folder) == files - {"c.nml"} | {"folder"}
    assert out.index("case.nml") < out.index("b.nml") < out.index("folder/c.nml")


def test_two_files_with_one_stem(sls):
    sls.write(SLS, "folder/case.nml")
    words = ["run", "case.nml", "folder/case.nml"]
    said = sls.refuses(*words, code=INPUT, at="folder/case.nml", says="stem")
    assert "case.nml" in said.partition(": its")[2]
    sls.refuses("run", "case.nml", "case.nml", code=INPUT, says="stem")
    # ... which is no matter where no file is written
    assert len(set(sls.succeeds(*words, "--print", "cor").split("\n"))) == 2


def test_two_files_with_one_stem_in_two_folders(sls):
    sls.write(SLS.replace("&output\n", "&output\n   directory = 'b'\n"), "b/case.nml")
    sls.succeeds("run", "case.nml", "b/case.nml")
    assert names(sls.folder / "b") >= FILES
    assert names(sls.folder) >= FILES


def test_two_files_with_one_stem_in_one_folder_by_two_names(sls):
    sls.write(
        SLS.replace("&output\n", "&output\n   directory = '../{}'\n".format(sls.folder.name)),
        "b/case.nml",
    )
    sls.refuses("run", "case.nml", "b/case.nml", code=INPUT, says="stem")


def test_summary_of_one_and_history_of_another(sls):
    """case.nml and case_summary.nml would both write case_summary.csv."""
    sls.write(SLS, "case_summary.nml")
    sls.refuses("run", "case.nml", "case_summary.nml", code=INPUT, says="stem")


def test_case_file_is_not_replaced(sls):
    """A case file with the name of a result is still there after the run."""
    for name in ("x.csv", "x.h5", "x_summary.csv"):
        sls.write(SLS, name)
        sls.succeeds("run", name)
        assert (sls.folder / name).read_text() == SLS


def test_case_file_is_not_replaced_by_its_stem(sls):
    sls.write(SLS, "x.csv")
    sls.refuses("run", "x.csv", "--set", "output.stem=x", code=INPUT, says="stem")


def test_output_makes_directories(sls):
    sls.succeeds("run", "case.nml", "--output", "a/b c/d")
    assert names(sls.folder / "a" / "b c" / "d") == FILES
    assert names(sls.folder) == {"a", "case.nml"}


def test_output_goes_before_the_directory_of_the_case(sls):
    sls.write(SLS.replace("&output\n", "&output\n   directory = 'mine'\n"))
    sls.succeeds("run", "case.nml")
    assert names(sls.folder / "mine") == FILES
    sls.succeeds("run", "case.nml", "--output=yours")
    assert names(sls.folder / "yours") == FILES
    assert names(sls.folder) == {"mine", "yours", "case.nml"}


def test_output_below_a_file(sls):
    sls.write("old", "file")
    sls.refuses("run", "case.nml", "--output", "file/x", code=FILE, says="file")


def test_output_is_a_file(sls):
    sls.write("old", "file")
    sls.refuses("run", "case.nml", "--output", "file", code=FILE, says="file")


def test_output_where_nobody_may_write(sls):
    sls.refuses("run", "case.nml", "--output", "/proc/vcor", code=FILE, says="/proc/vcor")


def test_quiet(sls):
    assert sls.succeeds("run", "--quiet", "case.nml") == ""
    assert names(sls.folder) == FILES | {"case.nml"}


def test_quiet_says_errors(vcor):
    vcor.refuses("run", "no.nml", "--quiet", code=FILE, at="no.nml")


def test_options_anywhere(sls):
    out = sls.succeeds("run", "--print", "cor", "case.nml", "--set", "impact.velocity=5")
    assert out == sls.succeeds("run", "--set", "impact.velocity=5", "--print", "cor", "case.nml")


def test_equals_forms(sls):
    plain = ["--set", "impact.velocity=5", "--print", "cor", "--output", "a"]
    equal = ["--set=impact.velocity=5", "--print=cor", "--output=b"]
    assert sls.succeeds("run", "case.nml", *plain) == sls.succeeds("run", "case.nml", *equal)
    a, b = ((sls.folder / name / "case.csv").read_bytes() for name in "ab")
    assert a == b


@pytest.mark.parametrize("name", ["--quiet", "-x.nml", "--set", "--"])
def test_file_named_like_an_option(vcor, name):
    vcor.write(SLS, name)
    out = vcor.succeeds("run", "--print", "cor", "--", name)
    assert 0 < float(out) < 1


@pytest.mark.parametrize("words", [["--version"], ["run", "--version"], ["check", "--version"]])
def test_version(vcor, words):
    assert vcor.succeeds(*words).startswith("vcor ")


def test_words_after_version(vcor):
    vcor.refuses("--version", "case.nml", code=USAGE, says="case.nml")


def test_two_topics(vcor):
    vcor.refuses("help", "run", "nothing", code=USAGE, says="nothing")


def test_closed_screen(sls):
    """A closed standard output: the files are written and the exit code says it."""
    done = sls("run", "case.nml", preexec_fn=lambda: os.close(1))
    complaint(done, FILE, "standard output")
    assert names(sls.folder) == FILES | {"case.nml"}


def test_the_environment_does_not_matter(sls):
    """Neither the language nor gfortran's own settings change a number."""
    plain = sls.numbers("case.nml")
    strange = {"LC_ALL": "de_DE.UTF-8", "GFORTRAN_CONVERT_UNIT": "big_endian", "HOME": "/no"}
    assert sls.numbers("case.nml", env=strange) == plain


def test_success_is_zero(sls):
    assert sls("check", "case.nml").code == SUCCESS


# ------------------------------------------------------------------------------ what was meant


@pytest.mark.parametrize("name", ["case.nml", "a b.nml", "folder/case.nml", ".nml", "x.nml.nml"])
def test_a_case_without_a_command(vcor, name):
    vcor.refuses(name, code=USAGE, says=[f"unknown command '{name}'; did you mean vcor run {name}?"])


@pytest.mark.parametrize("name", ["nml", "case.nm", "case.nml.txt", "x"])
def test_a_word_that_is_no_case(vcor, name):
    vcor.refuses(name, code=USAGE, says=[f"unknown command '{name}'", "check"])


@pytest.mark.parametrize("words, says", [
    (["--print", "cor,", "contact_time"], "between 'cor,' and 'contact_time', expected none, such as --print"),
    (["--print", "cor", ",contact_time"], "between 'cor' and ',contact_time'"),
    (["--print=cor,", "contact_time"], "between 'cor,' and 'contact_time'"),
    (["--set", "impact.velocity", "=", "2"], "between 'impact.velocity' and '=', expected none, such as --set"),
    (["--set", "impact.velocity=", "2"], "between 'impact.velocity=' and '2'"),
    (["--set", "impact.velocity", "=2"], "between 'impact.velocity' and '=2'"),
])  # fmt: skip
def test_a_blank_that_cuts_a_value(sls, words, says):
    sls.refuses("run", "case.nml", *words, code=USAGE, says=[says])


@pytest.mark.parametrize("words", [
    ["case.nml", "--print", "cor,contact_time"], ["--print", "cor", "case.nml"],
    ["--set", "impact.velocity=2", "case.nml"], ["--set", "impact.velocity = 2", "case.nml"],
])  # fmt: skip
def test_values_without_such_a_blank(sls, words):
    assert sls("run", *words, "--quiet").code == SUCCESS


@pytest.mark.parametrize("name, says", [("a.h5", "; vcor plot draws files"), ("a.xlsx", "identify and table"),
                                        ("a.csv", "; vcor fit, master"), ("a.txt", "; vcor fit, master")])  # fmt: skip
@pytest.mark.parametrize("command", ["run", "check", "material", "verify"])
def test_results_and_data_are_no_case(sls, name, says, command):
    sls.write("x", name)
    sls.refuses(command, name, code=INPUT, says=[f"{name}:1: found", says])
    sls.refuses(command, f"no{name}", code=FILE, says=[f"no{name}: there is no such file"])


def test_values_of_a_single_impact_are_no_columns(sls):
    sls.refuses("run", "case.nml", "--print", "impact.velocity", code=USAGE,
                says=["found 'impact.velocity' in --print", "those that vcor check prints"])  # fmt: skip


def test_few_steps_are_enough(sls):
    """The screen says so of methods that choose their steps."""
    assert "  method ive in 4 steps, as many as the accuracy needs\n" in sls.succeeds("run", "case.nml")
    direct = sls.succeeds("run", "case.nml", "--set", "solver.method=direct")
    assert re.search(r"\n  method direct in \d+ steps\n", direct)


def test_a_sheet_that_flies_with_the_ball_may_lack_its_floor(vcor):
    vcor.write("""&impact velocity = 2.4 /
&sphere diameter = 0.006, material = 'steel' /
&plate thickness = 0.003, material = 'sheet' /
&contact mechanics = 'exact' /
&material name = 'steel', model = 'elastic', modulus = 210e9, poisson_ratio = 0.3, density = 7800 /
&material name = 'sheet', model = 'mittag_leffler', density = 1150, poisson_ratio = 0.5, equilibrium_modulus = 4e6,
   relaxing_modulus = 1.1e9, exponent = 0.45, time = 1e-9 /
&solver end_time = 0.004 /
""")
    done = vcor("run", "case.nml", "--print", "cor")
    assert done.code != SUCCESS and "free on both sides" in done.err
    assert "on a floor give plate.base" in done.err and "solver.end_time" in done.err
    # without an end of its own a longer time is no advice
    text = (vcor.folder / "case.nml").read_text().replace("&solver end_time = 0.004 /", "")
    vcor.write(text)
    done = vcor("run", "case.nml", "--print", "cor")
    assert done.code != SUCCESS and "on a floor give plate.base" in done.err
    assert "end_time" not in done.err


@pytest.mark.parametrize("topic", ["tangential", "rolling", "oblique", "hollow"])
def test_help_on_what_there_is_not(vcor, topic):
    vcor.refuses("help", topic, code=USAGE, says=[f"no help on '{topic}': "])
