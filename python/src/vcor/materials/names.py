"""Names of measured quantities, in the languages of the instruments, and what a head says."""

from __future__ import annotations

import dataclasses
import functools
import itertools
import re
import tomllib
import unicodedata
from dataclasses import dataclass
from pathlib import Path

from .. import _library
from ..units import plain_unit, quantities_of, size, suffix_unit
from .labels import LONGEST, TEMPERATURE, read_label, unified


@dataclass(frozen=True)
class Quantity:
    """A measured quantity: its name, its SI unit, and how others call it."""

    name: str
    unit: str
    #: In any case; accents, and marks between words, are left out
    words: tuple[str, ...] = ()
    #: Exactly as they stand
    symbols: tuple[str, ...] = ()
    #: An example for messages
    example: str = ""
    #: Unit that a symbol implies
    implied: str = ""


_NAMES = tomllib.loads(Path(__file__).with_name("names.toml").read_text(encoding="utf-8"))
#: By their names
QUANTITIES = {
    name: Quantity(
        name, one["unit"], tuple(one.get("words", ())), tuple(one.get("symbols", ())),
        one.get("example", name), one.get("implied", ""),
    )
    for name, one in _NAMES["quantities"].items()
}  # fmt: skip
_SYMBOLS = {symbol: one for one in QUANTITIES.values() for symbol in one.symbols}
_WORDS = {word: one for one in QUANTITIES.values() for word in one.words}
#: Letters of a name at most: what is longer is a text
MOST_LETTERS = 200
#: Columns of a laboratory's table that are no data
ASIDE = {"", *_NAMES["aside"]}
#: Columns of texts that rows may end before
REMARKS = set(_NAMES["remarks"])
#: Columns of the summary that no one measures
COMPUTED = frozenset(_NAMES["computed"])
#: Words for the error of a datum
_ERRORS = frozenset(_NAMES["errors"])
#: By quantity: words in a name that is not known which make it likely
CUES: dict[str, list[str]] = _NAMES["cues"]
#: Words for a mean value, which change nothing
_AVERAGE = re.compile(
    r"^(?:average|avg\.?|mean|mittlere[rs]?|mittel|moyenne?|promedio)(?: of(?: the)?)? "
    r"| \(?(?:average|avg\.?|mean|moyenne?|promedio|mittel)\)?$"
)
_SHEAR = re.compile(
    r"shear|schub|scher|cisaillement|cizalla|せん断|剪切|\bG(?![a-z])|\|G", re.UNICODE
)
_TENSILE = re.compile(
    r"young|tensile|zug|elastizit|traction|引張|拉伸|\bE(?![a-z])|\|E|dehn", re.UNICODE
)
#: The number of a measurement behind the name of a column, and in front of it: E'_2, cor (trial 2),
#: Run 2 E'; a word has to tell that heights and velocities are no later ones of a sequence
_NUMBERED = (
    r"(?:run|rep|repl|replicate|repeat|repetition|trial|test|sample|specimen|versuch|messung|probe"
    r"|lauf|essai|mesure|ensayo|prueba|muestra|try)"
)
_RUN_BEHIND = re.compile(
    rf"(?i)(?P<name>.*?[^\s_\d])[\s_,;]*[\s_,;.(#\[]#?\s*(?P<word>{_NUMBERED})?[\s_.#]*"
    r"(?P<run>[1-9]\d?)[)\]]?(?P<unit>\s*[\[(/].*)?"
)
_RUN_BEFORE = re.compile(
    rf"(?i)(?P<word>{_NUMBERED})[\s_.#]*(?P<run>[1-9]\d?)[\s_,;:]+(?P<name>\D.*?)(?P<unit>)"
)
#: Quantities that are no sequence of impacts, so that a number alone tells a measurement
CURVES = {
    "time", "frequency", "angular_frequency", "storage_modulus", "loss_modulus", "complex_modulus",
    "relaxation_modulus", "loss_tangent", "phase_angle",
}  # fmt: skip
_AT = re.compile(
    rf"[\s,;@_(\[]+(?:(?:at|bei|à|a|@)\s*)?(?:T\s*[=:]?\s*)?{TEMPERATURE}\s*[)\]]?", re.UNICODE
)


@dataclass(frozen=True)
class Head:
    """Head of a column, as it is understood."""

    #: As it stands in the file
    text: str
    #: Name of the quantity, empty if it is not known
    name: str = ""
    #: SI unit of the quantity, empty if any will do
    si: str = ""
    #: Unit as written, empty if there is none
    unit: str = ""
    #: Base of the logarithm that the column holds, 0: none
    base: float = 0.0
    #: Temperature of the column [K], nan: not stated
    temperature: float = float("nan")
    #: Whether the moduli are shear moduli; None: not stated
    shear: bool | None = None
    #: Whether it holds standard errors
    sigma: bool = False
    #: Whether the name is that of an angular frequency
    angular: bool = False
    #: Whether the unit is that of the symbol, as Hz is of f
    implied: bool = False
    #: Fault of it, for a message
    flaw: str = ""
    #: Why its temperature is not sure, for a message
    doubt: str = ""
    #: Whether the name is a symbol, which others may use for something else
    symbol: bool = False
    #: Number of the measurement among several side by side, 0: not stated
    run: int = 0

    @property
    def key(self) -> str:
        """Name of the column in a table."""
        return self.name + "_sigma" * self.sigma


def is_average(text: str) -> bool:
    """Whether a name is that of a mean of other columns."""
    return _AVERAGE.search(plain(re.sub(r"[\[(][^\[\]()]*[\])]\s*$", "", text))) is not None


def plain(text: str) -> str:
    """A name without what spellings differ in: capitals, accents, marks between words."""
    text = unicodedata.normalize("NFKD", _primed(text).casefold())
    text = "".join(c for c in text if not "\u0300" <= c <= "\u036f")
    text = unicodedata.normalize("NFC", text)
    return re.sub(r"[\s_\-\u2010-\u2015]+", " ", text).strip(" .:")


def _primed(text: str) -> str:
    """A text with the primes of moduli in one spelling."""
    text = unicodedata.normalize("NFKC", text)
    return re.sub("[’′`´‘]", "'", re.sub('[″”"]', "''", text))


def _symbol(text: str) -> str:
    return re.sub(r"\s+", "", _primed(text))


@functools.cache
def _columns() -> dict[str, Quantity]:
    """Columns of histories and of the summary, by what their names are without marks."""
    found = {**_library.columns(1), **_library.columns(0)}
    return {plain(name): Quantity(name, one.unit) for name, one in found.items()
            if not one.labels}  # fmt: skip


@functools.cache
def _names() -> dict[str, Quantity]:
    """Quantities, by what their names are without marks."""
    return {plain(name): one for name, one in QUANTITIES.items()}


def quantity(text: str) -> Quantity | None:
    """Quantity of a name or of a symbol, None if it is not known."""
    name = plain(text)
    found = _SYMBOLS.get(_symbol(text)) or _WORDS.get(name)
    if found or not text:
        return found
    if (bare := _AVERAGE.sub("", name)) != name and bare:
        return quantity(bare)
    if found := _names().get(name) or _columns().get(name):
        return found
    # `Relaxation modulus G(t)`, `Frequency, f`: two that agree
    words = text.replace(",", " ").split()
    for i in range(1, len(words)):
        first, last = " ".join(words[:i]), " ".join(words[i:])
        if last[0] + last[-1] in ("()", "[]"):
            last = last[1:-1]
        one, other = _known(first), _known(last)
        if one and one is other:
            return one
    return None


def _known(text: str) -> Quantity | None:
    return _SYMBOLS.get(_symbol(text)) or _WORDS.get(plain(text))


def is_address(text: str) -> bool:
    """Whether a name is the address of a value of a case."""
    return re.fullmatch(r"[^\W\d][\w ]*\.[^\W\d]\w*(\(\d+\))?", text.strip()) is not None


def _parts(text: str) -> list[tuple[str, str]]:
    """Ways to take a head apart into a name and a unit, the most likely one first."""
    ways = [(text, "")]
    if len(text) > LONGEST:
        return ways
    if found := re.fullmatch(r"(.+?)\s*\[([^\[\]]*)\]", text):
        ways.append((found[1], found[2]))
    if found := re.fullmatch(r"(.+?)\s*\(([^()]*|[^()]*\([^()]*\)[^()]*)\)", text):
        ways.append((found[1], found[2]))
    for mark in (r"\s*/\s*", r"\s+in\s+", r"\s*,\s*", r"\s+"):
        if found := re.fullmatch(rf"(.+?){mark}(\S+(?: \S+)?)", text):
            if mark == r"\s+" and not quantities_of(found[2]):
                continue
            ways.append((found[1], found[2]))
    if found := re.fullmatch(r"(.+)_([A-Za-zµ%]+(?:_s2?)?)", text):
        ways += [(found[1], unit) for unit in [suffix_unit(found[2])] if unit]
    if found := re.fullmatch(r"(.+?)_((?:rad|m|mm|cm)_s2?)", text):
        ways.append((found[1], suffix_unit(found[2])))
    return ways


def read_head(text: str) -> Head:
    """Quantity and unit that the head of a column names, with what goes with them."""
    given = text
    if len(text) > MOST_LETTERS:
        return Head(given)
    text = text.strip()
    if text.startswith('"'):
        # quoted; at the end alone it belongs to E" and G"
        text = text[1:].removesuffix('"')
    text = unicodedata.normalize("NFKC", text).strip().strip(":")
    temperature, doubt, plainer = float("nan"), "", unified(text)
    if (found := _AT.search(plainer)) and (label := read_label(found[0])):
        temperature, doubt = label.kelvin, label.flaw
        text = (plainer[: found.start()] + plainer[found.end() :]).strip()
    text, base, flaw = _logarithm(text)
    if (numbered := _of_run(text, by_word=True)) is not None:
        return dataclasses.replace(numbered, text=given, base=base, flaw=flaw,
                                   temperature=temperature, doubt=doubt)  # fmt: skip
    bare, unit, sigma, known = "", "", False, None
    for name, of in _parts(text):
        stem = _of_error(name)
        known = quantity(stem or name)
        suffix = text[len(name) :].startswith("_") and of
        if known and (_is_quotient(text[len(name) :]) or (suffix and not size(of, known.unit))):
            # E''/E', or an index such as that of e_s, which is no unit of the quantity
            known = None
        elif known or is_address(stem or name):
            bare, unit, sigma = stem or name, of, bool(stem)
            break
    else:
        if (numbered := _of_run(text)) is not None:
            return dataclasses.replace(numbered, text=given, base=base, flaw=flaw,
                                       temperature=temperature, doubt=doubt)  # fmt: skip
        # not known: its unit is what stands in brackets
        unit = next((of for name, of in _parts(text)[1:] if quantities_of(of)), "")
        return Head(given, unit=unit, base=base, temperature=temperature, flaw=flaw,
                    doubt=doubt)  # fmt: skip
    if not known:
        return Head(given, re.sub(r"\s+", "_", bare.strip()), "", unit, base, temperature,
                    sigma=sigma, flaw=flaw, doubt=doubt)  # fmt: skip
    angular = known.name == "angular_frequency"
    symbol = _symbol(bare) in known.symbols
    implied = not unit and (symbol or angular or plain(bare) == "freq")
    if implied:
        unit = known.implied
    shear = None
    if known.unit == "Pa":
        name = unicodedata.normalize("NFKC", bare).replace("_", " ")
        letter = re.match(r"\|?([eEgG])(?=$|[\W\d ]|t\b)", name)
        kinds = (
            bool(_SHEAR.search(name)) or bool(letter and letter[1] in "gG"),
            (bool(_TENSILE.search(name)) or bool(letter and letter[1] in "eE")),
        )
        lower = name.casefold()
        kinds = kinds[0] or bool(_SHEAR.search(lower)), kinds[1] or bool(_TENSILE.search(lower))
        shear = kinds[0] if kinds[0] != kinds[1] else None
    name = "frequency" if angular else known.name
    return Head(given, name, known.unit, "" if unit in ("[]",) else unit, base, temperature, shear,
                sigma, angular, implied and bool(unit), flaw, doubt,
                symbol)  # fmt: skip


def _of_run(text: str, *, by_word: bool = False) -> Head | None:
    """The head of a column whose name has the number of a measurement; None: it has none.

    With `by_word` a word such as run has to stand before the number.
    """
    if len(text) > LONGEST:
        return None
    found = _RUN_BEHIND.fullmatch(text) or _RUN_BEFORE.fullmatch(text)
    if not found or (by_word and not found["word"]):
        return None
    head = read_head(f"{found['name']}{found['unit'] or ''}")
    sure = head.name in QUANTITIES and not head.run and (found["word"] or head.name in CURVES)
    return dataclasses.replace(head, run=int(found["run"])) if sure else None


def _of_error(name: str) -> str:
    """Name of the quantity whose error a column has by its name, empty if it has none.

    `cor std`, `contact_time_error`, `cor (sd)`, `error of cor`, `sigma(cor)`.
    """
    name = name.strip()
    if (found := re.fullmatch(r"(.+?)\s*[(\[](.+)[)\]]", name)) and plain(found[2]) in _ERRORS:
        return found[1]
    if found and plain(found[1]) in _ERRORS:
        return found[2]
    for mark in re.finditer(r"[\s_\-]+", name):
        before, behind = name[: mark.start()], name[mark.end() :]
        if plain(behind) in _ERRORS:
            return before
        if plain(before) in _ERRORS:
            return re.sub(r"(?i)^(of|in|on|von|der|des|de|du|la)[\s_]+(the[\s_]+)?", "", behind)
    return ""


def _is_quotient(rest: str) -> bool:
    """Whether what follows a name divides it by a quantity, as in `|G*|/sin d` and `E''/E'`."""
    if not (found := re.match(r"\s*/\s*(.+)", rest)) or quantities_of(found[1]):
        return False
    below = re.sub(r"\s*[(\[][^()\[\]]*[)\]]$", "", found[1]).strip()
    start = re.sub(r"_?(\d|inf|max|ref|∞)$", "", below)
    return bool(is_function(below) or quantity(below) or quantity(start))


def is_function(text: str) -> bool:
    """Whether a text has a trigonometric function: it is no quantity that is measured."""
    return re.search(r"(?<![a-z])(sin|cos|tan)(?![b-z])", plain(text)) is not None


def _logarithm(text: str) -> tuple[str, float, str]:
    """A name without the logarithm in front of it, the base, and what is wrong with it."""
    found = re.match(r"(?i)(log[ _]?10|lg|ln|log)(?![a-z])[\s_]*", text)
    if not found or quantity(text):
        return text, 0.0, ""
    inner = text[found.end() :].strip()
    # log10(E' [Pa]), log10(E') [Pa]
    depths = list(itertools.accumulate((c == "(") - (c == ")") for c in inner))
    if inner.startswith("(") and 0 in depths:
        end = depths.index(0)
        inner = f"{inner[1:end]} {inner[end + 1 :].strip()}".strip()
    which = found[1].lower()
    base = {"ln": 2.718281828459045, "log": 0.0}.get(which, 10.0)
    flaw = "" if base else "log may be natural or decimal, expected log10 or ln"
    return inner, base or 10.0, flaw


def canonical(name: str) -> tuple[str, float]:
    """Name that an option means, and the base of its logarithm, 0: none; empty if not known."""
    head = read_head(name)
    if head.unit and quantities_of(head.unit) and "[" in name:
        return "", 0.0
    return (head.key if head.name else ""), head.base


def plain_units(text: str) -> bool:
    """Whether a cell is a unit, as those of a second line are."""
    return text.strip() in ("", "-", "[]", "[-]", "()") or bool(quantities_of(plain_unit(text)))
