"""What a refusal of a file advises is true: command, hint, command again."""

import re
import shlex

import numpy as np
import pytest

import vcor
from vcor import _command, _library
from vcor._command import parser_of
from vcor.materials.data import columns_option
from vcor.materials.hints import is_other
from vcor.materials.names import COMPUTED, CUES, QUANTITIES, read_head

#: Hints that are followed for one file
MOST = 3


def refusal(path, columns, units):
    """The refusal of a file as its command prints it; None and the data if there is none."""
    with _command.one_line():
        parser_of("identify").options(["case.nml", str(path)])
        try:
            return None, vcor.read_data(path, columns, units)
        except vcor.Error as error:
            return str(error), None


def hints(message):
    """Options that a message advises."""
    found = re.findall(r"--(columns|units) ('[^']*(?:'\"'\"'[^']*)*'|\S+)", message)
    return [(name, shlex.split(word)[0]) for name, word in found]


def follow(path, truth):
    """The data by the hints of the refusals; where these name several quantities, by the truth."""
    words = []
    for _ in range(MOST):
        message, data = refusal(path, columns_option(words), None)
        if data is not None:
            return data
        advised = [word for name, word in hints(message) if name == "columns"]
        assert len(advised) == 1, message
        (name, _, head) = advised[0].partition("=")
        if told := re.search(
            r"if '.*' is (.*?)(?: \(a stress over the strain\))?, say which", message
        ):
            # the user knows
            name = truth[head]
            assert name in told[1].split(" or ")
        assert truth.get(head) == name, message
        words.append(f"{name}={head}")
    raise AssertionError(message)


FREQUENCIES, RATIO = np.array([1.0, 10.0, 100.0]), np.array([0.4, 0.5, 0.6])
STORAGE = np.array([2.0, 3.0, 4.0])
LOSS = RATIO * STORAGE
NORM = np.hypot(STORAGE, LOSS)
TIMES, RELAXING = np.array([0.1, 1.0, 10.0]), np.array([4.0, 3.0, 2.0])
DYNAMIC = {"frequency": 2 * np.pi * FREQUENCIES, "storage_modulus": 1e6 * STORAGE,
           "loss_modulus": 1e6 * LOSS}  # fmt: skip
HEIGHTS, REBOUNDS = np.array([40.0, 80.0, 120.0]), np.array([21.5, 41.6, 60.7])
SPEEDS, COR = np.array([1.0, 2.0, 3.0]), np.array([0.7, 0.68, 0.66])


def moduli(**more):
    """Columns with the frequency before them, and what is right."""
    return {"f [Hz]": FREQUENCIES, **more}, DYNAMIC


def drops(name, values=REBOUNDS, means="rebound_height"):
    """Drops and a column of another name, and what is right."""
    factor = 0.01 if means.endswith("height") else 1e-3
    return ({"drop height (cm)": HEIGHTS, name: values},
            {"drop_height": HEIGHTS / 100, means: factor * values}, {name: means})  # fmt: skip


def shots(name, values, means, factor=1.0):
    """Impacts with velocity and cor and a column of another name, and what is right."""
    return ({"velocity [m/s]": SPEEDS, "cor": COR, name: values},
            {"velocity": SPEEDS, "cor": COR, means: factor * values}, {name: means})  # fmt: skip


#: Columns of a file, the data that they are, and what heads mean that are not known
KINDS = {
    "complex, dynamic": (*moduli(**{"Dyn. modulus [MPa]": NORM, "tan δ": RATIO}),
                         {"Dyn. modulus [MPa]": "complex_modulus"}),
    "complex, dynamic, upper case": (*moduli(**{"DYNMOD (MPa)": NORM, "tan δ": RATIO}),
                                     {"DYNMOD (MPa)": "complex_modulus"}),
    "storage, no word": (*moduli(**{"M1 [MPa]": STORAGE, "tan δ": RATIO}),
                         {"M1 [MPa]": "storage_modulus"}),
    "complex, no word": (*moduli(**{"M1 [MPa]": NORM, "tan δ": RATIO}),
                         {"M1 [MPa]": "complex_modulus"}),
    "modulus against frequency": (*moduli(**{"Modulus [MPa]": NORM, "tan δ": RATIO}),
                                  {"Modulus [MPa]": "complex_modulus"}),
    "E against frequency": (*moduli(**{"E [MPa]": STORAGE, "E'' [MPa]": LOSS}),
                            {"E [MPa]": "storage_modulus"}),
    "loss beside a stress": (*moduli(**{"E' [MPa]": STORAGE, "Viscous part [MPa]": LOSS,
                                        "Static stress [kPa]": 10 * LOSS}),
                             {"Viscous part [MPa]": "loss_modulus"}),
    "both parts": (*moduli(**{"Elastic part [MPa]": STORAGE, "Viscous part [MPa]": LOSS}),
                   {"Elastic part [MPa]": "storage_modulus", "Viscous part [MPa]": "loss_modulus"}),
    "over a sine": (*moduli(**{"|E*| (MPa)": NORM, "|E*|/sinδ (MPa)": NORM * 3,
                               "δ [rad]": np.arctan(RATIO)}), {}),
    "over a sine, blanks": (*moduli(**{"E*/sin δ [MPa]": NORM * 3, "E* [MPa]": NORM,
                                       "tan δ": RATIO}), {}),
    "ratio beside both": (*moduli(**{"E' [MPa]": STORAGE, "E''/E'": RATIO, "E'' [MPa]": LOSS}), {}),
    "over the first": (*moduli(**{"E' [MPa]": STORAGE, "E'/E0": STORAGE / 2, "E'' [MPa]": LOSS}),
                       {}),
    "angular frequency in Hz": ({"omega [Hz]": FREQUENCIES, "E' [MPa]": STORAGE, "E'' [MPa]": LOSS},
                                DYNAMIC, {"omega [Hz]": "frequency"}),
    "relaxation": ({"t [s]": TIMES, "value [MPa]": RELAXING},
                   {"time": TIMES, "relaxation_modulus": 1e6 * RELAXING},
                   {"value [MPa]": "relaxation_modulus"}),
    "time": ({"duration so far [s]": TIMES, "E(t) [MPa]": RELAXING},
             {"time": TIMES, "relaxation_modulus": 1e6 * RELAXING},
             {"duration so far [s]": "time"}),
    **{name: drops(name) for name in (
        "Average rebound height (cm)", "height after bounce [cm]", "Mean height of the bounce [cm]",
        "h_f [cm]", "final height (cm)", "returned to [cm]", "height 2 [cm]",
        "max. of rebound [cm]", "apex [cm]",
    )},
    "a size": drops("size of the ball [mm]", HEIGHTS / 10, "diameter"),
    **{name: shots(name, 5 * SPEEDS, means, 1e-3) for name, means in (
        ("Sheet thickness [mm]", "plate.thickness"), ("t [mm]", "plate.thickness"),
        ("t (mm)", "plate.thickness"), ("thk [mm]", "plate.thickness"),
        ("D_ball [mm]", "diameter"), ("penetration depth [mm]", "max_indentation"),
        ("pulse duration [ms]", "contact_time"), ("tc_mean [ms]", "contact_time"),
    )},
    "speeds": ({"approach speed 1 [m/s]": SPEEDS, "exit speed [m/s]": COR * SPEEDS},
               {"velocity": SPEEDS, "rebound_velocity": COR * SPEEDS},
               {"approach speed 1 [m/s]": "velocity", "exit speed [m/s]": "rebound_velocity"}),
    **{name: ({"velocity [m/s]": SPEEDS, name: COR * SPEEDS},
              {"velocity": SPEEDS, "rebound_velocity": COR * SPEEDS}, {name: "rebound_velocity"})
       for name in ("v2 [m/s]", "v_f [m/s]", "v_after [m/s]", "speed after the wall [m/s]",
                    "other speed [m/s]")},
    **{name: ({"velocity [m/s]": SPEEDS, name: 100 * COR}, {"velocity": SPEEDS, means: right},
              {name: means})
       for name, means, right in (("Ratio [%]", "cor", COR), ("rebound R [%]", "resilience", COR))},
}  # fmt: skip


@pytest.mark.parametrize("kind", KINDS)
def test_a_hint_leads_to_the_truth(tmp_path, kind):
    columns, right, truth = KINDS[kind]
    path = tmp_path / "a.csv"
    rows = zip(*columns.values(), strict=True)
    lines = [",".join(columns), *(",".join(f"{x:.12g}" for x in row) for row in rows)]
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    data = follow(path, truth)
    if "diameter" in right:
        right = {**right, "radius": right["diameter"] / 2}
        del right["diameter"]
    assert set(data) == set(right)
    for name, column in right.items():
        np.testing.assert_allclose(data[name], column, rtol=1e-9)


def test_the_hints_are_tried():
    """The names of this table are not all known, or nothing would be tried."""
    unknown = [head for _, _, truth in KINDS.values() for head in truth if not read_head(head).name]
    assert len(unknown) > 25


@pytest.mark.parametrize(("text", "never"), [
    # what cannot be meant is not advised
    ("t [s],Stress [MPa]\n1,2\n2,1\n", "columns="),
    ("f [Hz],E' [MPa],Torque [MPa]\n1,2,3\n", "Torque [MPa]'}"),
    ("drop height [cm],rebound height [cm],cor,apex [cm]\n40,20,0.7,3\n", "'drop_height'"),
    ("velocity [m/s],cor,t\n1,0.5,3\n", "'time'"),
    ("velocity [m/s],cor,cor_sphere,ratio [%]\n1,0.5,0.5,3\n", "'cor'"),
])  # fmt: skip
def test_what_cannot_be_meant_is_not_advised(tmp_path, text, never):
    (tmp_path / "a.csv").write_text(text)
    with pytest.raises(vcor.InputError) as caught:
        vcor.read_data(tmp_path / "a.csv")
    assert never not in str(caught.value).partition("expected")[2]


def test_words_of_hints_are_of_quantities():
    known = {*QUANTITIES, *_library.columns(0), "other", "plate.thickness"}
    assert set(CUES) <= known
    assert is_other(read_head("Stress [Pa]")) and is_other(read_head("G*sin d"))
    assert not is_other(read_head("distance [m]"))


# --------------------------------------------------------------- columns that no one measures


@pytest.mark.parametrize("name", [
    "cor error", "COR error", "cor_error", "cor err", "cor uncertainty", "cor_std", "cor sd",
    "standard error of cor", "error in cor", "uncertainty of the cor", "sigma_cor", "sigma(cor)",
    "cor (standard deviation)", "cor ±", "Fehler der Stoßzahl",
])  # fmt: skip
def test_errors_of_a_datum_are_no_data(tmp_path, name):
    (tmp_path / "a.csv").write_text(f"velocity [m/s],cor,{name}\n1,0.7,0.006\n2,0.6,0.007\n")
    data = vcor.read_data(tmp_path / "a.csv")
    assert list(data) == ["velocity", "cor", "cor_sigma"]
    assert data.cor_sigma.tolist() == [0.006, 0.007]


def test_errors_have_units_and_quantities(tmp_path):
    path = tmp_path / "a.csv"
    path.write_text(
        "velocity [m/s],cor,contact time [ms],contact time error [ms]\n1,0.7,0.9,0.02\n"
    )
    data = vcor.read_data(path)
    assert data.contact_time_sigma.tolist() == [2e-5]
    path.write_text("velocity [m/s],cor,cor error [%]\n1,0.7,2\n")
    with pytest.raises(vcor.InputError, match="may be a part of 'cor' or of 1"):
        vcor.read_data(path)
    path.write_text("velocity [m/s],cor [%],cor error [%]\n1,70,2\n")
    assert vcor.read_data(path).cor_sigma.tolist() == [0.02]
    path.write_text("velocity [m/s],cor,contact time error [ms]\n1,0.7,0.02\n")
    data = vcor.read_data(path)
    assert list(data) == ["velocity", "cor"]
    assert "not taken: contact time error [ms]" in data.attrs["taken"]


def test_arrays_follow_the_same_rules(sls):
    sls["rubber.beta"] = 1000.0
    speeds = np.array([1.0, 2.0, 4.0])
    cor = sls.points({"impact.velocity": speeds}, ["cor"]).cor.values
    right = vcor.identify(sls, {"velocity": speeds, "cor": cor, "cor_sigma": 0.01 + 0 * cor},
                          ["rubber.beta"])  # fmt: skip
    found = vcor.identify(sls, {"velocity": speeds, "cor": cor, "cor_error": 0.01 + 0 * cor,
                                "steps": 100 * cor}, ["rubber.beta"])  # fmt: skip
    assert found.estimates == right.estimates and len(found.data) == 3
    assert found.taken == ("data: not taken: steps",)


def test_what_no_one_measures_is_left_out_by_name(tmp_path):
    assert set(_library.columns(0)) >= COMPUTED
    (tmp_path / "a.csv").write_text(
        "velocity [m/s],velocity error [m/s],cor,steps,tan delta,t [s]\n1,0.01,0.7,300,0.1,5\n"
    )
    data = vcor.read_data(tmp_path / "a.csv")
    assert list(data) == ["velocity", "cor"]
    assert "not taken: velocity error [m/s], steps, tan delta, t [s]" in data.attrs["taken"]
    # a user may say that it is this column, as of results that the program computed
    data = vcor.read_data(tmp_path / "a.csv", {"loss_tangent": "tan delta"})
    assert data.loss_tangent.tolist() == [0.1]
