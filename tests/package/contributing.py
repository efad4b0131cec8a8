"""The examples of CONTRIBUTING.md as changes of the sources: where the page says that each block of code goes."""

import re
import shutil
from pathlib import Path

ROOT = Path(__file__).parents[2]
PAGE = ROOT / "CONTRIBUTING.md"
CATALOGUE = "src/vcor/case/catalogue.f90"
FACTORY = "src/vcor/solver.f90"
FEATURES = "src/vcor/solver/features.f90"
INPUTS = "src/vcor/case/inputs.f90"
READER = "src/vcor/case/reader.f90"
SHAPE = "src/vcor/impact/shape.f90"
#: For each example, in the order of its blocks: the file, what to do with the block, and the start of the line before
#: or instead of which it goes
EXAMPLES = {
    "a column of the summary": [
        ("src/vcor/sweep/quantity.f90", "before", "call list%add('resilience'"),
    ],
    "a key of the input": [
        (CATALOGUE, "before", 'key_t("impact", "gravity"'),
        (READER, "before", "call put(case, inputs, 'impact', 'gravity')"),
        (INPUTS, "before", "!> Gravity along the impact"),
        (INPUTS, "before", "case ('gravity')"),
        (INPUTS, "instead of", "velocity = self%velocity"),
    ],
    "a shape of the striking body": [
        (SHAPE, "instead of", "character(len=*), parameter :: other_shapes"),
        (SHAPE, "before", "shape_t('punch'"),
        (SHAPE, "before", "shape_parameter_t('punch'"),
        (SHAPE, "before", "case ('punch')"),
    ],
    "a method": [
        (FEATURES, "before", "method_t('coupled'"),
        (FEATURES, "before", "!> Those that `solver.method` may have"),
        (FEATURES, "instead of", "character(len=*), parameter :: method_choices"),
        (FEATURES, "before", "refusal_t([of_viscosity, 0, 0], of_second_term"),
        (FEATURES, "before", "!> The exclusions; of several"),
        (FACTORY, "before", "use vcor_words"),
        (FACTORY, "before", "type(product_t), allocatable :: product"),
        (FACTORY, "before", "else if (settings%method == 'coupled')"),
    ],
}
#: Files that an example adds: where they go, and where they are
ADDED = {"a method": {"src/vcor/solver/my_method.f90": ROOT / "tests" / "package" / "my_method.f90"}}


def text_of(title: str) -> str:
    """An example, from its heading to the next one."""
    return PAGE.read_text("utf-8").split(f"## Example: {title}\n")[1].split("\n## ")[0]


def blocks(title: str) -> list[str]:
    """Blocks of code of an example."""
    found = re.findall(r"^   ```\n(.*?)^   ```$", text_of(title), re.M | re.S)
    return [re.sub(r"^   ", "", block, flags=re.M) for block in found]


def changed(text: str, way: str, line: str, block: str) -> str:
    """A text with a block before, or instead of, its only line that begins so, at the same indentation."""
    found = list(re.finditer(rf"^( *){re.escape(line)}.*\n", text, re.M))
    assert len(found) == 1, f"{len(found)} lines begin with {line}, expected one"
    start, end = found[0].span()
    more = "".join(found[0][1] + row + "\n" for row in block.splitlines())
    return text[:start] + more + text[start if way == "before" else end :]


def apply(title: str, top: Path) -> None:
    """Change the sources under a folder by an example."""
    for (name, way, line), block in zip(EXAMPLES[title], blocks(title), strict=True):
        path = top / name
        path.write_text(changed(path.read_text("utf-8"), way, line, block), "utf-8")
    for name, source in ADDED.get(title, {}).items():
        shutil.copyfile(source, top / name)
