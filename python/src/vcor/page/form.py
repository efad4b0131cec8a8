"""The form of a page: widgets for the values of a case, from the catalogue of keys.

Keys that a laboratory asks for stand first; all others of the catalogue follow in its order, so
that a new key has a widget without a change here. Values are shown in usual units; the case has SI
units. What is wrong is said at its widget, in the words of the library.
"""

from __future__ import annotations

import contextlib
import html
import re
from collections.abc import Callable, Iterator
from decimal import Decimal
from typing import Any

import numpy as np
from bokeh.models import (
    CategoricalSlider,
    Column,
    Div,
    InlineStyleSheet,
    RadioButtonGroup,
    Select,
    TextInput,
    Toggle,
)

from .._library import Error, InputError
from ..arguments import written
from ..case import Case
from .answer import materials_of, path_of, start_of
from .keys import Group, Key, groups, key_of
from .library import offered

#: Surfaces in words of a laboratory
SURFACES = {
    "block": "Thick block", "plate": "Free plate", "pad": "Pad on a floor",
    "ball": "Second ball", "structure": "Structure",
}  # fmt: skip
#: Values that are shown first, by section; "*" stands for all others of a group
_FIRST = {
    "Ball": ["sphere.diameter", "sphere.material", "sphere.shape", "sphere.mass"],
    "Impact": ["impact.drop_height", "impact.velocity", "impact.temperature", "impact.gravity"],
    "Mechanics": ["contact.mechanics"],
}
_SURFACE = {
    "block": ["plate.material"],
    "plate": ["plate.thickness", "plate.material"],
    "pad": ["plate.thickness", "plate.base", "plate.material"],
    "ball": ["plate.surface_radius", "plate.material"],
    "structure": ["target.*", "plate.material"],
}
#: Numbers with a slider
_SLIDERS = (
    "sphere.diameter", "impact.drop_height", "impact.velocity", "impact.temperature",
    "plate.thickness", "plate.surface_radius",
)  # fmt: skip
#: Groups whose keys are further ones of a section
_MORE = {"Ball": ["sphere"], "Surface": ["plate"], "Impact": ["impact"], "Mechanics": ["contact"]}
#: Groups that a page has no widgets for: it writes no files and has a range of its own
_NOT_SHOWN = ("sweep", "output")
#: First value where a key needs one, in SI units as a namelist has it
_AT_FIRST = {
    "thickness": "0.01", "surface_radius": "0.01", "base": "'bonded'", "body": "'block'",
    "mass": "1.0", "length": "0.3", "width": "0.03", "diameter": "0.02", "support": "'supported'",
    "half_angle": "60.0", "punch_radius": "0.005", "profile_coefficient": "100.0",
    "profile_power": "2.0", "radius": "0.005", "modulus": "1.0e9", "poisson_ratio": "0.4",
    "glassy_modulus": "1.0e7", "alpha": "100.0", "beta": "1000.0", "coefficient": "1.0e6",
    "exponent": "0.5", "relaxing_modulus": "1.0e7", "time": "1.0e-3", "moduli": "1.0e7",
    "times": "1.0e-3", "equilibrium_modulus": "1.0e6",
}  # fmt: skip
#: Places of a slider on each side of its middle
_PLACES = 40
#: Words of the library about a value without effect, and an address in its lines
_UNREAD = "the impact does not read it"
_ADDRESS = r"\b\w+\.\w+\b"
_DIGITS = 3


class Field:
    """Widgets of a value."""

    def __init__(self, form: Form, address: str, key: Key) -> None:
        """Make the widgets of the key `key` at `address`."""
        self._form, self.address, self.key = form, address, key
        said = [key.meaning]
        if key.range:
            said.append(f"range {key.range}" + f" {key.unit}" * bool(key.unit))
        more = {"description": f"{'; '.join(said)} ({address})", "stylesheets": form.styles}
        self.slider: CategoricalSlider | None = None
        if key.name == "material" or key.choices or key.type == "logical":
            self.control: Any = Select(title=key.label, options=[], **more)
        else:
            self.control = TextInput(title=key.label, **more)
        self.control.name = address
        self.fault = Div(text="", visible=False, css_classes=["fault"], stylesheets=form.styles)
        parts: list[Any] = [self.control]
        if address in _SLIDERS:
            self.slider = CategoricalSlider(
                categories=["0", "1"], value="0", show_value=False, visible=False,
                stylesheets=form.styles, name=f"{address} slider", margin=(0, 12, 0, 12),
            )  # fmt: skip
            self.slider.on_change("value", self._slid)
            parts.append(self.slider)
        self.note = Div(text="", visible=False, css_classes=["note"], stylesheets=form.styles)
        self.control.on_change("value", self._typed)
        self.root = Column(
            *parts, self.fault, self.note, sizing_mode="stretch_width", css_classes=["field"]
        )
        for one in self.root.children:
            one.sizing_mode = "stretch_width"

    def refresh(self, case: Case) -> None:
        """Show the value of the case."""
        value = case[self.address]
        if isinstance(self.control, Select):
            self.control.options = self._options(case)
            if isinstance(value, bool):
                value = ".true." if value else ".false."
            self.control.value = "" if value is None else str(value)
        else:
            self.control.value = self.key.shown(value)
            self._slide(value)
        if self.key.name == "material":
            found = offered().get(str(value))
            text = html.escape(found.source) if found else ""
            self.note.text = f"<details><summary>Source</summary>{text}</details>" if text else ""
            self.note.visible = bool(text)
        self.say("")

    def say(self, message: str) -> None:
        """Say what is wrong with the value; empty: nothing."""
        self.fault.text = html.escape(message)
        self.fault.visible = bool(message)

    def _options(self, case: Case) -> Any:
        """Words of a Select: materials of the case and the library, or choices with meanings."""
        key = self.key
        if key.name == "material":
            own = self._form.names(case)
            return {"In this case": own, "Library": [n for n in offered() if n not in own]}
        if key.type == "logical":
            return [(".false.", "no"), (".true.", "yes")]
        words = [
            (word, f"{word}: {key.meanings[word]}" if word in key.meanings else word)
            for word in key.choices
        ]
        return words if case[self.address] is not None else [("", "–"), *words]

    def _slide(self, value: Any) -> None:
        """Bring the slider to a value; its range stays while the value is in it."""
        if self.slider is None:
            return
        self.slider.visible = isinstance(value, (int, float)) and value != 0
        if not self.slider.visible:
            return
        text = self.key.shown(value)
        known = list(self.slider.categories)
        if text not in known:
            if not float(known[0]) < float(text) < float(known[-1]):
                known = self._places(float(value))
            self.slider.categories = sorted({*known, text}, key=Decimal)
        self.slider.value = text

    def _places(self, value: float) -> list[str]:
        """Values of the slider around one, as texts in the usual unit."""
        first, last, is_log = start_of(value, self.key.unit)
        if is_log:
            ratios = np.geomspace(first, last, 2 * _PLACES + 1).tolist()
            return [self.key.shown(float(f"{one:.{_DIGITS - 1}e}")) for one in ratios]
        return [self.key.shown(one) for one in np.arange(first, last + 0.5).round(2).tolist()]

    def _typed(self, _attr: str, _old: Any, new: str) -> None:
        self._form.set(self, new)

    def _slid(self, _attr: str, _old: str, new: str) -> None:
        self._form.set(self, new)


class Form:
    """Widgets of a case, which they change.

    Parameters
    ----------
    case
        The case, a single impact.
    changed
        What is called after each change, or with a value that is wrong.
    styles
        Style sheets of the widgets.
    """

    def __init__(
        self, case: Case, changed: Callable[[], None], styles: list[InlineStyleSheet]
    ) -> None:
        """Make the widgets of all keys of the case."""
        self.case, self._changed, self.styles = case, changed, styles
        #: Names of materials that were added by the page from its library
        self._own = _names(case)
        self._fields: dict[str, Field] = {}
        self._is_quiet = False
        #: Whether the further keys of a section are open
        self._open: dict[str, bool] = {}
        #: Values that the impact did not read after a change of its kind, to be given again
        self._left: dict[str, str] = {}
        #: Address of the last change, and what is wrong with values that the case does not have
        self.last = ""
        self.faults: dict[str, str] = {}
        self.root = Column(sizing_mode="stretch_width", name="inputs")
        self.build()

    # ------------------------------------------------------------------------- building

    def build(self) -> None:
        """Make the widgets of the keys that the case has now."""
        self.kind = surface_of(self.case)
        shown: list[Any] = []
        self._visible: set[str] = set()
        for title in ("Ball", "Surface", "Impact", "Mechanics"):
            shown += self._section(title)
        for name in materials_of(self.case):
            if f"{path_of(name)}.name" in self.case:
                keys = groups()["material"].keys_of(str(self.case[f"{path_of(name)}.model"]))
                addresses = [f"{path_of(name)}.{key.name}" for key in keys if key.name != "name"]
                shown += [*self._more(f"Material: {name}", addresses)]
        done = {"sphere", "plate", "impact", "contact", "target", "material", *_NOT_SHOWN}
        for group in groups().values():
            if group.name not in done and not group.repeated:
                shown += self._more(group.meaning, list(self._addresses(group)))
        self.root.children = shown
        self.refresh()

    def _section(self, title: str) -> Iterator[Any]:
        """Widgets of a section: Ball, Surface, Impact or Mechanics."""
        yield Div(text=f"<h2>{title}</h2>", stylesheets=self.styles)
        if title == "Surface":
            kinds = list(SURFACES)
            choice = RadioButtonGroup(
                labels=list(SURFACES.values()), active=kinds.index(self.kind),
                stylesheets=self.styles, name="surface", sizing_mode="stretch_width",
            )  # fmt: skip
            choice.on_change("active", lambda _a, _o, new: self.set_surface(kinds[new]))
            yield choice
            first = _SURFACE[self.kind]
        else:
            first = _FIRST[title]
        addresses = []
        for one in first:
            group = groups()[one.partition(".")[0]]
            addresses += list(self._addresses(group)) if one.endswith("*") else [one]
        for address in addresses:
            if self._key(address) is not None:
                yield self._field(address).root
        more = [
            address
            for name in _MORE[title]
            for address in self._addresses(groups()[name])
            if address not in addresses
        ]
        yield from self._more(f"More of the {title.lower()}", more)

    def _more(self, title: str, addresses: list[str]) -> Iterator[Any]:
        """Further keys behind a button, whose widgets are made when it is pressed first."""
        addresses = [one for one in addresses if self._key(one) is not None]
        if not addresses:
            return
        is_open = self._open.get(title, False)
        box = Column(visible=is_open, sizing_mode="stretch_width")
        button = Toggle(
            label=title, active=is_open, stylesheets=self.styles, css_classes=["more"],
            sizing_mode="stretch_width",
        )  # fmt: skip

        def fill() -> None:
            """Make the fields, when they are seen for the first time."""
            box.children = [self._field(one).root for one in addresses]

        def press(_attr: str, _old: bool, new: bool) -> None:
            """Show or hide the fields."""
            self._open[title] = new
            if new and not box.children:
                fill()
                self.refresh()
            box.visible = new

        if is_open:
            fill()
        button.on_change("active", press)
        yield button
        yield box

    def _addresses(self, group: Group) -> Iterator[str]:
        """Addresses of a group that the model of the case has."""
        model = self.case[f"{group.name}.{group.selector}"] if group.selector else None
        for key in group.keys_of(None if model is None else str(model)):
            # of a structure without a body nothing else is known
            if model is not None or not group.selector or key.name == group.selector:
                yield f"{group.name}.{key.name}"

    def _key(self, address: str) -> Key | None:
        """Key at an address; None if the case has no use for it, or a page not."""
        key = key_of(self.case, address)
        group = groups()[key.group]
        if group.selector and key.models:
            owner = address.rpartition(".")[0]
            if str(self.case[f"{owner}.{group.selector}"]) not in key.models:
                return None
        # no page asks for a path of the machine
        return None if key.is_file else key

    def _field(self, address: str) -> Field:
        """Widgets of an address, whose key the case has."""
        key = key_of(self.case, address)
        self._visible.add(address)
        known = self._fields.get(address)
        if known is None or known.key != key:
            known = self._fields[address] = Field(self, address, key)
        return known

    def refresh(self) -> None:
        """Show the values of the case in all widgets but those with a wrong one."""
        self._is_quiet = True
        try:
            for address in self._visible - set(self.faults):
                self._fields[address].refresh(self.case)
        finally:
            self._is_quiet = False

    # ------------------------------------------------------------------------- changing

    def set(self, field: Field, text: str) -> None:
        """Take what the user gives a value."""
        if self._is_quiet:
            return
        address, key = field.address, field.key
        self.last = address
        try:
            if not text.strip():
                del self.case[address]
            elif key.name == "material":
                self._take_material(address, text)
            else:
                self.case[address] = f"'{text}'" if key.choices else key.written(text)
        except Error as error:
            self.faults[address] = str(error)
            field.say(str(error))
        else:
            self.faults.pop(address, None)
            field.say("")
            self._follow(address, key)
        self._changed()

    def _follow(self, address: str, key: Key) -> None:
        """Follow a change: other keys, and waves that suit the surface."""
        owner = address.rpartition(".")[0]
        group = groups()[key.group]
        if key.name == group.selector:
            self._fit_keys(owner, group)
        if address in ("contact.mechanics", "plate.waves"):
            self._fit_waves(is_given=address == "plate.waves")
        if (
            key.name in (group.selector, "material")
            or address in ("contact.mechanics", "plate.waves", "solver.method")
            or surface_of(self.case) != self.kind
        ):
            self._settle()
            self.build()
        else:
            self.refresh()

    def _take_material(self, address: str, name: str) -> None:
        """Give a body a material of the case or the library; the library's unused ones go."""
        if name not in self.names(self.case):
            self.case.add(offered()[name].read())
        self.case[address] = "'" + name.replace("'", "''") + "'"
        # what the library can give again
        used = materials_of(self.case)
        for one in self.names(self.case):
            if one not in used and one not in self._own:
                del self.case[path_of(one)]

    def add_material(self, group: Case, name: str, body: str) -> None:
        """Take a material of a file for a body, in the place of one of the same name."""
        if name in self.names(self.case):
            del self.case[path_of(name)]
        self.case.add(group)
        self._own.append(name)
        self._take_material(f"{body}.material", name)
        self.last = f"{body}.material"
        self.faults.clear()
        self._settle()
        self.build()
        self._changed()

    def take(self, case: Case) -> None:
        """Take another case in the place of all."""
        self.case, self._own = case, _names(case)
        self._fields.clear()
        self.faults.clear()
        self.build()
        self._changed()

    def names(self, case: Case) -> list[str]:
        """Names of the materials of the case."""
        known = dict.fromkeys([*self._own, *offered()])
        return [name for name in known if f"{path_of(name)}.name" in case]

    def _fit_keys(self, owner: str, group: Group) -> None:
        """Remove the values of keys that the choice does not have; give those that it needs."""
        model = str(self.case[f"{owner}.{group.selector}"])
        had = {key.name for key in group.keys if key.models and model in key.models}
        for key in group.keys:
            address = f"{owner}.{key.name}"
            if key.models and key.name not in had:
                del self.case[address]
        for key in group.keys_of(model):
            address = f"{owner}.{key.name}"
            is_needed = key.required or (model == "prony" and key.name in ("moduli", "times"))
            other = {"radius": "diameter", "times": "rates"}.get(key.name)
            has = [self.case[address], self.case[f"{owner}.{other}"] if other else None]
            if is_needed and all(one is None or one == [] for one in has):
                self._start(address, key)

    def _start(self, address: str, key: Key) -> None:
        """Give a value to begin with, of a word the first that the choice allows."""
        for text in [_AT_FIRST.get(key.name, ""), *[f"'{word}'" for word in key.choices]]:
            if not text:
                continue
            try:
                self.case[address] = text
            except Error:
                continue
            return

    def set_surface(self, kind: str) -> None:
        """Make the case one of a kind of surface."""
        case = self.case
        if kind != "structure":
            del case["target"]
        kept = {
            "plate": ["thickness", "half_thickness"], "pad": ["thickness", "half_thickness"],
            "ball": ["surface_radius"],
        }.get(kind, [])  # fmt: skip
        for name in ("thickness", "half_thickness", "surface_radius", "base", "waves", "extent"):
            if name not in kept:
                del case[f"plate.{name}"]
        needs = {"plate": "plate.thickness", "pad": "plate.thickness",
                 "ball": "plate.surface_radius", "structure": "target.body"}  # fmt: skip
        if (address := needs.get(kind)) and not case[address] and not case["plate.half_thickness"]:
            self._start(address, key_of(case, address))
        if kind == "pad":
            self._start("plate.base", key_of(case, "plate.base"))
        if kind == "structure":
            self._fit_keys("target", groups()["target"])
        if kind == "ball" and case["sphere.shape"] == "true_sphere":
            # the library has that of a flat surface alone
            del case["sphere.shape"]
        self.faults.clear()
        self.last = address or "plate.material"
        self._fit_waves()
        self._settle()
        self.build()
        self._changed()

    def _fit_waves(self, *, is_given: bool = False) -> None:
        """Leave waves out where the mechanics have none of a surface without thickness.

        With exact mechanics the library takes those of a half space.
        """
        case, kind = self.case, surface_of(self.case)
        if is_given:
            return
        del case["plate.waves"]
        if kind in ("block", "ball") and case["contact.mechanics"] == "paper":
            case["plate.waves"] = "none"

    def _settle(self) -> None:
        """Leave out values that the impact does not read, and give them again when it does.

        As a temperature, where no material has a shift: the library refuses what has no effect.
        """
        for address, text in self._left.items():
            if address in self.case and self.case[address] is None:
                with contextlib.suppress(Error):
                    self.case[address] = text
        self._left.clear()
        line = _refusal(self.case)
        while _UNREAD in line:
            for address in re.findall(_ADDRESS, line):
                trial = self.case.copy()
                try:
                    value = trial[address]
                    del trial[address]
                except Error:
                    continue
                if value is not None and (said := _refusal(trial)) != line:
                    self._left[address] = value if isinstance(value, str) else written(value, "")
                    self.case, line = trial, said
                    break
            else:
                return

    def blame(self, message: str) -> str:
        """Say what is wrong with the case at the widget that it is about, else at the last one.

        Returns the line without the name of the case.
        """
        line = re.sub(rf"^{re.escape(self.case.name)}(:\d+)?: ", "", message)
        missing = re.search(r"key '(\w+)' .*?&(\w+)(?: '([^']*)')?", line)
        found = [f"{missing[3] or missing[2]}.{missing[1]}".replace(" ", "_")] if missing else []
        found += re.findall(_ADDRESS, line)
        for address in [*found, self.last]:
            if address in self._visible:
                self._fields[address].say(line)
                break
        return line

    def clear(self) -> None:
        """Nothing is wrong with the case any more."""
        for address in self._visible - set(self.faults):
            self._fields[address].say("")


def _refusal(case: Case) -> str:
    """Why a case makes no impact; empty if it makes one."""
    trial = case.copy()
    try:
        if trial._has_mesh:
            # that it begins is enough
            trial["solver.accuracy"] = "0.1"
        trial._solve([], np.empty((1, 0)), ["status"], 1)
    except InputError as error:
        return str(error)
    except Error:
        pass
    return ""


def surface_of(case: Case) -> str:
    """Kind of surface of a case, one of `SURFACES`."""
    if case["target.body"] is not None:
        return "structure"
    if case["plate.surface_radius"]:
        return "ball"
    if case["plate.base"] != "free":
        return "pad"
    has = [case[f"plate.{name}"] is not None for name in ("thickness", "half_thickness")]
    return "plate" if any(has) else "block"


def _names(case: Case) -> list[str]:
    """Names of the materials of a case that can be solved."""
    text = case.text()
    found = re.findall(r"(?im)^&material\s.*?^\s*name\s*=\s*'((?:[^']|'')*)'", text, re.S)
    return [name.replace("''", "'") for name in found]
