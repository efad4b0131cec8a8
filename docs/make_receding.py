"""Write docs/receding.svg: force against indentation for both contact laws, the paper's SLS case.

    pip install './python[plot]' && python docs/make_receding.py
"""

from pathlib import Path

from matplotlib import rc_context, style
from matplotlib.figure import Figure
from vcor.plot import COLUMN, STYLE

import vcor

ROOT = Path(__file__).resolve().parent.parent
# plate model, its name, colour
PLATES = [("none", "no waves", "C0"), ("hereditary", "thin plate", "C1")]


def main():
    """Write the figure."""
    with style.context(STYLE), rc_context():
        made = Figure(figsize=(COLUMN / 2.54, 6.5 / 2.54), layout="constrained")
        axis = made.subplots()
        for waves, name, color in PLATES:
            for law, line in (("boltzmann", "--"), ("receding", "-")):
                case = vcor.read(ROOT / "examples" / "paper" / "sls.nml")
                case["plate.waves"], case["contact.law"] = waves, law
                history = case.history()
                axis.plot(1e3 * history.indentation, history.force, color=color, linestyle=line, marker="",
                          label=f"{name}, {law}")  # fmt: skip
        axis.set(xlabel="indentation [mm]", ylabel="contact force [N]", xlim=0, ylim=0)
        axis.legend()
        made.savefig(ROOT / "docs" / "receding.svg", metadata={"Date": None})


if __name__ == "__main__":
    main()
