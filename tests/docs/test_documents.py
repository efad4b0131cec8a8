"""The documents: links that lead somewhere, commands and examples that do what they say."""

import os
import re
import shutil
import subprocess
import sys
import time

import pytest
from places import LIMIT, ROOT
from warm import commands_in

CONSUMER = ROOT / "tests" / "consumer"
PAGES = sorted([ROOT / "README.md", ROOT / "CONTRIBUTING.md", *(ROOT / "docs").glob("*.md"),
                *(ROOT / "docs/exchange").glob("*.md")])
# What a block has that is not for a test: it installs, builds, needs a prefix of yours or a cluster, or
# is about a case that is not there
OTHER = re.compile(
    r"apt-get|cmake|cpack|\bfpm\b|ctest|scripts/|pkg-config|build/release|\bcase\.nml"
    r"|SBATCH|mpirun|_shard_"
)


def text_of(name):
    """A page."""
    return (ROOT / name).read_text(encoding="utf-8")


def blocks(name, language):
    """The blocks of a language on a page."""
    return re.findall(rf"^```{language}\n(.*?)^```$", text_of(name), re.DOTALL | re.MULTILINE)


def plain(page):
    """A page without its blocks."""
    text = page.read_text(encoding="utf-8")
    return re.sub(r"^```.*?^```$", "", text, flags=re.DOTALL | re.MULTILINE)


def anchors(page):
    """Anchors of links: the headings as GitHub names them."""
    found = set()
    for title in re.findall(r"^#+ (.*)$", plain(page), re.MULTILINE):
        name = re.sub(r"[^\w\- ]", "", title.lower()).replace(" ", "-")
        count = sum(1 for other in found if re.fullmatch(rf"{re.escape(name)}(-\d+)?", other))
        found.add(f"{name}-{count}" if count else name)
    return found


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_links(page):
    words = re.sub(r"`[^`\n]*`", "", plain(page))
    links = re.findall(r"\]\(([^)\s]+)\)", words) + re.findall(r'(?:src|href)="([^"]+)"', words)
    for link in links:
        # the second leads to the pages of a repository on GitHub
        if "://" in link or link.startswith("../../actions/"):
            continue
        path, _, anchor = link.partition("#")
        target = (page.parent / path).resolve() if path else page
        assert target.exists(), link
        assert target.is_relative_to(ROOT), link
        if anchor:
            assert anchor in anchors(target), link


def test_one_version():
    version = re.search(r'^version = "(.*)"$', (ROOT / "fpm.toml").read_text(), re.MULTILINE)[1]
    assert f"\nversion: {version}\n" in (ROOT / "CITATION.cff").read_text()
    changes = (ROOT / "CHANGELOG.md").read_text()
    assert re.search(r"^## (\S+) \(\d{4}-\d\d-\d\d\)$", changes, re.MULTILINE)[1] == version


def test_the_index_names_every_page():
    index = text_of("docs/README.md")
    for page in (ROOT / "docs").glob("*.md"):
        assert f"({page.name})" in index or f"docs/{page.name}" in index or page.name == "README.md"


def test_modules_and_files_that_pages_name():
    """Modules, functions of C and files that a page names exist."""
    modules = set()
    for path in [*(ROOT / "src").rglob("*.[fF]90"), *(ROOT / "app").glob("*.f90")]:
        modules |= set(re.findall(r"^module (\w+)", path.read_text(), re.MULTILINE))
    modules |= set(re.findall(r"\b(vcor_\w+)\(", (ROOT / "include/vcor.h").read_text()))
    for page in PAGES:
        text = page.read_text(encoding="utf-8")
        named = set(re.findall(r"`(vcor_\w+)`|\[\[(vcor\w*)\(module\)", text))
        missing = {one or two for one, two in named} - modules - {"vcor_needs", "vcor_material_my_model"}
        assert not missing, f"{page.name} names modules that are not there"
        for name in re.findall(r"`((?:app|src|scripts|cmake|tests)/[\w/.-]+\.\w+)`", text):
            assert (ROOT / name).exists() or "my_" in name, f"{page.name} names {name}"


# ---------------------------------------------------------------------------------- commands


@pytest.fixture(scope="session")
def package(tmp_path_factory):
    """A folder with the commands of the package."""
    folder = tmp_path_factory.mktemp("bin")
    with commands_in(folder, ["card", "export", "fit", "identify", "master", "page", "plot", "table", "uncertainty"]):
        yield folder


@pytest.fixture
def folder(vcor, package, tmp_path):
    """A folder as the documents take it: a copy of the examples, and mine.nml, a case of yours."""
    for name in ("examples", "data"):
        shutil.copytree(ROOT / name, tmp_path / name)
    shutil.copy(ROOT / "examples/paper/sls.nml", tmp_path / "mine.nml")
    (tmp_path / "bin").mkdir()
    for program in (vcor, *package.glob("vcor-*")):
        (tmp_path / "bin" / program.name).symlink_to(program)
    return tmp_path


# What is said on stderr of the validity of bare numbers
VALIDITY = re.compile(r"vcor: note: \S+: validity")
#: The same in Python, with the line of the script
VALIDITY_WARNING = re.compile(r"^\S+: ValidityWarning: .*\n  .*\n", re.MULTILINE)
# how long a command takes is said where it is minutes, which depends on what else the machine does
LONG = re.compile(r"vcor: note: \S+: the fit takes some \d+ min")


# A level below good: on a screen, as a value of --print or in a column of a table
LEVEL = re.compile(r"(?:^|[\s,:])(caution|outside)(?=[\s,:]|$)", re.MULTILINE)


def levels(folder, before, *printed):
    """The levels below good that a block has printed, or written into tables of results since a time [ns]."""
    found = {level for text in printed for level in LEVEL.findall(text)}
    for path in folder.rglob("*.csv"):
        if path.stat().st_mtime_ns < before:
            continue
        names, *rows = [line.split(",") for line in path.read_text("utf-8").splitlines() if line[:1] != "#"] or [[]]
        if "validity" in names:
            found |= {row[names.index("validity")] for row in rows} & {"caution", "outside"}
    return found


def words_on(block, page):
    """What a page says about a block: its comments, and what follows up to the next heading or block of commands."""
    comments = " ".join(re.findall(r"#.*", block))
    return comments + re.split(r"^(?:#+ |```sh$)", page.split(block, 1)[1], maxsplit=1, flags=re.MULTILINE)[0]


def test_levels_are_seen(tmp_path):
    (tmp_path / "drop_summary.csv").write_text("# vcor\ncor,validity\n0.5,good\n0.4,caution\n")
    assert levels(tmp_path, 0) == {"caution"}
    assert levels(tmp_path, 2**63) == set()
    for text in ("  validity: outside\n", "0.3,outside\n", "0.3 outside layer_strain", "note: validity outside: x"):
        assert levels(tmp_path, 2**63, text) == {"outside"}
    assert levels(tmp_path, 2**63, "validity: good\n", "caution_x") == set()
    page = "```sh\nvcor a # one\n```\nhere\n```sh\nvcor b\n```\noutside\n"
    assert "outside" not in words_on("vcor a # one\n", page) and "here" in words_on("vcor a # one\n", page)
    assert "outside" in words_on("vcor b\n", page)


def shell(folder, text, page=""):
    """Run a block as it stands; what it prints. On stderr is nothing but what the page shows, how
    valid bare numbers are, and on a busy machine how long it takes; the page has a word on results that
    are not good."""
    before = time.time_ns()
    env = {**os.environ, "PATH": f"{folder / 'bin'}:{os.environ['PATH']}"}
    done = subprocess.run(
        ["bash", "-euc", text],
        capture_output=True,
        encoding="utf-8",
        timeout=LIMIT,
        check=False,
        cwd=folder,
        env=env,
    )
    stderr = VALIDITY_WARNING.sub("", done.stderr)
    errors = [
        line
        for line in stderr.splitlines()
        if line not in page and not VALIDITY.match(line) and not LONG.match(line)
    ]
    assert (done.returncode, errors) == (0, []), text
    # a page that is made from the help has the help's examples as they are
    if text in page and not page.startswith("<!-- Made by"):
        notes = "\n".join(line for line in done.stderr.splitlines() if VALIDITY.match(line))
        found = levels(folder, before, done.stdout, notes)
        assert not found or re.search(r"caution|outside|validity", words_on(text, page)), (found, text)
    return done.stdout


# Pages whose commands have a test of their own, or sections of them
WALKED = {
    "README.md": [],
    "recipes.md": [],
    "which_model.md": [],
    "data.md": ["From DMA to e(T)", "Fits"],
    "figures.md": ["Gallery"],
    "reproducing_the_paper.md": ["Prony series of BUTYL"],
}


def section(text, title):
    """A section of a page, with those below it."""
    return re.split(r"^## ", text.split(f"\n## {title}\n")[1], maxsplit=1, flags=re.MULTILINE)[0]


def commands(page):
    """The blocks of commands of a page."""
    text = text_of(page.relative_to(ROOT))
    walked = WALKED.get(page.name)
    if walked == []:
        return []
    tested = "".join(section(text, title) for title in walked or [])
    found = [block for block in blocks(page.relative_to(ROOT), "sh") if f"```sh\n{block}```" not in tested]
    return [block for block in found if "vcor " in block and not OTHER.search(block)]


def test_there_are_commands():
    assert sum(len(commands(page)) for page in PAGES) >= 4


@pytest.mark.parametrize("page", [page for page in PAGES if commands(page)], ids=lambda p: p.name)
def test_commands(folder, page):
    """One after the other, as a reader types them."""
    text = text_of(page.relative_to(ROOT))
    printed = {block: shell(folder, block, text) for block in commands(page)}
    if page.name == "identification.md":
        # the number that the page gives for moduli at several temperatures
        (shown,) = [out for block, out in printed.items() if "vcor master examples" in block]
        value = float(re.search(r"^cor +([\d.]+)", shown, re.MULTILINE)[1])
        assert f"coefficient of restitution: {value:.4f} here" in text


@pytest.mark.parametrize("name", ["lammps", "mujoco"])
def test_the_line_of_the_export(folder, name):
    """The line that a page shows is one of the file that its command writes, to five digits of its numbers."""
    page = f"docs/exchange/{name}.md"
    shell(folder, blocks(page, "sh")[0], text_of(page))
    number = re.compile(r"-?\d+\.\d+(?:e[+-]\d+)?")

    def split(line):
        return " ".join(number.sub("#", line).split()), [float(word) for word in number.findall(line)]

    (shown,) = [line for line in re.findall("^    (.*)$", text_of(page), re.MULTILINE) if re.search(r"\d\.\d{5}", line)]
    (path,) = [path for path in (folder / name).glob(f"granular_pair_{name}.*") if path.suffix != ".svg"]
    made = dict(map(split, path.read_text("utf-8").splitlines()))
    words, numbers = split(shown)
    assert words in made and numbers == pytest.approx(made[words], rel=1e-5)


def rounded(value, shown):
    """A number as the page shows it; a word as it is."""
    if not re.match(r"-?\d", shown):
        return value
    mantissa, _, power = shown.partition("E")
    return f"{float(value):.{len(mantissa.partition('.')[2])}{'E' if power else 'f'}}"


@pytest.mark.parametrize("name", ["docs/recipes.md", "docs/which_model.md"])
def test_the_numbers_after_commands(folder, name):
    """A block ends with what stands after its `#`, to the digits that are shown."""
    for block in blocks(name, "sh"):
        shown = ", ".join(re.findall(r" {5}# (.*)$", block, re.MULTILINE)).split(", ")
        found = shell(folder, block, text_of(name)).split()[-len(shown) :]
        assert [rounded(*pair) for pair in zip(found, shown, strict=True)] == shown, block


def test_the_walk_from_dma_to_restitution(folder):
    """The numbers of the page, from its own commands."""
    page = "docs/data.md"
    walk = section(text_of(page), "From DMA to e(T)")
    found = re.findall(r"^```sh\n(.*?)^```$", walk, re.DOTALL | re.MULTILINE)
    for block in found:
        shell(folder, block, text_of(page))
    rows = [line for line in (folder / "walk/drop_summary.csv").read_text().splitlines() if line[:1] != "#"]
    names, *rows = [row.split(",") for row in rows]
    cor = [float(row[names.index("cor")]) for row in rows]
    shown = re.search(r"with ([\d.]+) at 10 °C; the coefficient rises to ([\d.]+) at 60 °C", text_of(page))
    assert [f"{cor[0]:.3f}", f"{cor[-1]:.2f}"] == [shown[1], shown[2]]
    assert shell(folder, found[0]) in walk


def test_the_loop_prints_what_the_page_shows(folder):
    page = text_of("docs/sweeps.md")
    loop = next(block for block in blocks("docs/sweeps.md", "sh") if "for v in" in block)
    shown = page.split(loop)[1].split("```")[2].lstrip("\n")
    assert shell(folder, loop) == shown


def test_the_length_of_the_readme():
    assert len(text_of("README.md").splitlines()) <= 110


def test_the_boxes_of_the_readme():
    """Those of the recipes, which are tested there."""
    recipes = text_of("docs/recipes.md")
    install, *boxes = blocks("README.md", "sh")
    (first,) = blocks("README.md", "python")
    assert len(boxes) == 2 and "scripts/setup.sh" in install and "scripts/test.sh" in install
    for block in (*boxes, first):
        assert block in recipes
    for block in boxes:
        shown = re.search(r"caution|outside", words_on(block, recipes))
        assert not shown or re.search(r"caution|outside|good", words_on(block, text_of("README.md"))), block
    (pair,) = re.findall(r"^pair_coeff .*$", recipes, re.MULTILINE)
    shown = re.search(r"# \.\.\. (\S+) (\S+) \.\.\.$", first, re.MULTILINE).groups()
    assert shown == tuple(f"{float(word):.4g}" for word in pair.split()[4:6])


def test_the_first_run(folder):
    """The numbers to all digits that are shown, or to their errors; steps and files are another matter."""
    shown = next(b for b in text_of("docs/getting_started.md").split("```") if b.startswith("\nvcor "))
    found = shell(folder, "vcor run examples/paper/sls.nml")

    def rows(text):
        lines = [line.rstrip() for line in text.strip().splitlines() if line]
        return [line for line in lines if not re.search(r"imbalance|steps", line)]

    for line, other in zip(rows(shown), rows(found), strict=True):
        if " +- " in line:
            (value, error), (expected, _) = (re.findall(r"[\d.]+(?:E-\d+)?", row)[-2:] for row in (other, line))
            assert abs(float(value) - float(expected)) <= max(float(error), 1e-8)
            assert line.split("0.")[0] == other.split("0.")[0]
        else:
            assert line == other


def test_the_pendulum_of_the_recipes():
    """The case that is shown is the example that its commands run."""
    assert blocks("docs/recipes.md", "fortran") == [text_of("examples/identification/pendulum.nml")]


def test_the_case_of_the_page(folder):
    """The case that is shown is the example."""
    (folder / "sls.nml").write_text(blocks("docs/getting_started.md", "fortran")[0])
    assert shell(folder, "vcor check sls.nml") == shell(folder, "vcor check examples/paper/sls.nml")


def test_the_solver_group_of_the_page(folder):
    (group,) = blocks("docs/accuracy.md", "fortran")
    with (folder / "mine.nml").open("a") as file:
        file.write(group)
    assert shell(folder, "vcor run mine.nml --print status") == "separated\n"


def test_the_sweep_of_the_page(folder):
    """The sweep that is shown, and the scripts of the page that read results."""
    (groups,) = blocks("docs/sweeps.md", "fortran")
    case = (folder / "mine.nml").read_text()
    (folder / "case.nml").write_text(f"{case}\n{groups}")
    shell(folder, "vcor run case.nml --quiet; vcor run examples/paper/sls.nml examples/superball.nml --quiet")
    scripts = blocks("docs/sweeps.md", "python") + blocks("docs/output.md", "python")
    assert len(scripts) >= 5
    env = {**os.environ, "PATH": f"{folder / 'bin'}:{os.environ['PATH']}"}
    for i, script in enumerate(scripts):
        # a figure wants a screen and Matplotlib
        (folder / f"{i}.py").write_text(re.sub(r"\.plot\(.*\)", "", script))
    # one interpreter for all, each script in a namespace of its own: most of the time goes into imports
    runner = "import runpy, sys\nfor name in sys.argv[1:]: runpy.run_path(name, {}, '__main__')"
    done = subprocess.run(
        [sys.executable, "-c", runner, *(f"{i}.py" for i in range(len(scripts)))],
        capture_output=True,
        text=True,
        timeout=LIMIT,
        check=False,
        cwd=folder,
        env=env,
    )
    assert done.returncode == 0, done.stderr


# ---------------------------------------------------------------------------------- library


@pytest.mark.parametrize(
    "language, names",
    [
        ("fortran", ["app/from_case.f90"]),
        ("c", ["c/from_c.c"]),
        ("cmake", ["CMakeLists.txt"]),
    ],
)
def test_the_page_of_the_library_shows_the_consumer(language, names):
    """The project that tests/package and scripts/test.sh build."""
    assert blocks("docs/python.md", language) == [(CONSUMER / name).read_text() for name in names]


def test_the_library_has_what_the_page_names():
    facade = (ROOT / "src/vcor.f90").read_text()
    names = re.findall(r"`((?:new|waves|read|solve|evaluate)\w*)`", section(text_of("docs/python.md"), "Fortran"))
    assert len(names) > 15
    for name in names:
        assert re.search(rf"public ::.*\b{name}\b", facade), name
