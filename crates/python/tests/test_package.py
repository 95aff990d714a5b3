"""The package itself: its tag, what it shows, what it documents."""

from __future__ import annotations

import copy
import doctest
import inspect
import json
import pickle
import re
import subprocess
import sys
import tomllib
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import ROOT, STUDIES

import retune as rt
from retune import _forcing, _run, _scene


def test_contract_the_wheel_is_for_every_later_python() -> None:
    (wheel,) = (ROOT / "target" / "wheels").glob("retune_dampers-*.whl")
    assert re.fullmatch(r"retune_dampers-[\d.]+-cp311-abi3-\w+\.whl", wheel.name), wheel.name
    assert Path(rt.__file__).with_name("py.typed").is_file()
    assert rt.__version__ == tomllib.loads((ROOT / "Cargo.toml").read_text())["workspace"]["package"]["version"]


def test_contract_the_wheel_brings_the_program(program: Path) -> None:
    def said(*words: str | Path) -> tuple[int, bytes, bytes]:
        ran = subprocess.run(words, capture_output=True, check=False)
        return ran.returncode, ran.stdout, ran.stderr

    installed = Path(sys.executable).with_name("retune")
    for words in (["--version"], ["check", STUDIES / "ssvi.json"], ["check", STUDIES / "none.json"], ["simulate", "--rtol", "x"]):
        assert said(installed, *words) == said(program, *words), words
    assert said(installed, "check", STUDIES / "none.json")[0] == 2


def test_contract_everything_has_a_docstring_and_every_number_a_unit() -> None:
    for name in rt.__all__:
        if name != "__version__":
            assert inspect.getdoc(getattr(rt, name)), name
    for part in (rt.Structure, rt.Contact, rt.TMD, rt.SSVI):
        for field, (unit, words) in _scene.MEANING.items():
            if field in part.__dataclass_fields__:
                assert words and (unit or field in ("q", "nu1", "nu2", "nu3", "nu4")), field
    said = inspect.getdoc(rt.Problem) or ""
    for argument in inspect.signature(rt.Problem.__new__).parameters:
        assert argument in ("cls", "structure", "damper", "name") or f"``{argument}``" in said, argument


def test_contract_the_default_contact_is_the_studies() -> None:
    study = json.loads((STUDIES / "ssvi.json").read_text())
    none = dict.fromkeys(("loss", "strength", "density", "rigid"))
    assert vars(rt.Contact()) == {**study["scene"]["damper"]["contact"], **none}


def test_contract_contacts_that_lose_energy(ssvi: rt.Problem) -> None:
    lossy = rt.Problem.from_study(STUDIES / "ssvi-loss.json")
    assert lossy.simulate().maxima["E1max"] != lossy.simulate(**{"lambda": 0.0}).maxima["E1max"]
    law = rt.Contact(loss={"restitution": 0.7, "at": 1.4})
    damper = rt.SSVI(60, k2=583.9, c2=94.97, D=0.02885, C=1.105, contact=law)
    own = rt.Problem(rt.Structure(m1=1000, c1=452, k1=39500), damper, P=800, omega=6.28, window=(50, 100))
    assert own.simulate().maxima["E1max"] == lossy.simulate().maxima["E1max"]
    with pytest.raises(rt.StudyError, match="restitution"):
        rt.Contact(loss={"restitution": 1.2, "at": 1})


def test_contract_a_strength_and_a_density_change_no_motion() -> None:
    structure = rt.Structure(m1=1000, c1=452, k1=39500)

    def run(contact: rt.Contact) -> rt.Run:
        damper = rt.SSVI(60, k2=215, c2=232, D=0.06, C=0.36, contact=contact)
        return rt.Problem(structure, damper, P=800, omega=6.28, window=(50, 100)).simulate()

    plain, known = run(rt.Contact()), run(rt.Contact(strength=1e5, density=1200))
    for name in _run.SHOWN:
        assert known.maxima[name] == plain.maxima[name], name
    assert "warnings" not in plain.maxima
    assert ["yield strength of 100 kPa" in words for words in known.maxima["warnings"]] == [True, False] * 2
    with pytest.raises(rt.StudyError, match="strength: -1 is not allowed here: give a finite number above 0"):
        rt.Contact(strength=-1)
    with pytest.raises(rt.StudyError, match="density: 0 is not allowed here: give a finite number above 0"):
        rt.Contact(density=0)
    with pytest.raises(rt.StudyError, match="two laws: `rigid` and `density`"):
        rt.Contact(rigid=0.7, density=1200)


@pytest.mark.parametrize("module", [rt, _forcing])
def test_exact_examples_in_docstrings(module: Any) -> None:
    assert doctest.testmod(module).failed == 0


def test_contract_rigid_walls() -> None:
    study = rt.Problem.from_study(STUDIES / "ssvi-rigid.json")
    damper = rt.SSVI(60, k2=583.9, c2=94.97, D=0.02885, C=1.105, contact=rt.Contact(rigid=0.7))
    own = rt.Problem(rt.Structure(m1=1000, c1=452, k1=39500), damper, P=800, omega=6.28, window=(50, 100))
    assert own.simulate().maxima["E1max"] == study.simulate().maxima["E1max"]
    assert study.simulate(restitution=0.0).maxima["E1max"] > study.simulate().maxima["E1max"]
    contacts = study.simulate().contacts
    assert set(contacts.wall) == {"structure"} and np.isinf(contacts.force).all()
    assert (contacts.touch_down == contacts.lift_off).all()
    shown = repr(rt.Contact(rigid=0.7))
    assert "0.7" in shown and "E1" not in shown
    with pytest.raises(rt.StudyError, match="restitution"):
        rt.Contact(rigid=1.2)


def test_contract_results_are_shown_as_tables(ssvi: rt.Problem) -> None:
    assert "stroke" in repr(ssvi.evaluate(ssvi.start)) and "k2" in repr(ssvi) and "E1max" in repr(ssvi)
    run = ssvi.simulate()
    sweep = ssvi.sweep(omega=np.linspace(5, 8, 31))
    assert "31 rows" in repr(sweep) and len(repr(sweep).splitlines()) == 13
    assert "contacts" in repr(run)
    for shown in (ssvi, ssvi.evaluate(ssvi.start), run, sweep, rt.TMD(1), rt.Structure(m1=1, c1=0, k1=1)):
        assert shown._repr_html_().startswith("<table>"), shown
        assert "&lt;" in type(shown)._repr_html_(shown) or "<script" not in shown._repr_html_()
    assert "N/m" in repr(rt.SSVI(60, k2=215))


def test_exact_a_text_with_a_unit_is_the_number_in_si_units(tmd: rt.Problem) -> None:
    structure = rt.Structure(m1="1 t", c1="0.452 kN·s/m", k1="39.5 kN/m")
    assert structure == rt.Structure(m1=1000, c1=452, k1=39500)
    assert rt.SSVI("60 kg", k2="215 N/m", c2=232, D="60 mm", C="36 cm") == rt.SSVI(60, k2=215, c2=232, D=0.06, C=0.36)

    def problem(P: Any, band: Any, high: Any, stroke: Any) -> rt.Problem:
        damper = rt.TMD(60, k2=1900, c2=150)
        search = {"vary": ["k2"], "bounds": {"k2": (0, high)}, "limits": {"stroke": stroke}}
        return rt.Problem(structure, damper, P=P, band=band, response="steady", **search)

    words = problem("0.8 kN", ("0.8 Hz", "75 rpm"), "4 kN/m", "400 mm")
    assert words == problem(800, (0.8 * 2 * np.pi, 75 * (2 * np.pi / 60)), 4000, 0.4)
    assert words.at(k1="40 kN/m") == words.at(k1=40000)
    found = tmd.evaluate(tmd.start)
    assert found.E1max == found.largest and f"{found.E1max:.5g}" in repr(found)
    assert repr(pickle.loads(pickle.dumps(found))) == repr(copy.copy(found)) == repr(found)
    with pytest.raises(AttributeError, match="there is no E9: there are value, quantity"):
        found.E9


def test_contract_tables_are_data_frames_and_plots(ssvi: rt.Problem) -> None:
    pd = pytest.importorskip("pandas")
    import matplotlib

    matplotlib.use("Agg")
    sweep = ssvi.sweep(omega=[5, 6, 7])
    assert sweep.to_pandas().equals(pd.DataFrame(sweep)) and list(sweep.to_pandas().columns) == list(sweep)
    assert sweep.plot("E1max").get_ylabel() == "E1max, J"
    theirs = matplotlib.pyplot.figure().gca()
    drawn = sweep.plot()
    numbers = [name for name, column in sweep.items() if name != "omega" and column.dtype.kind in "fiu"]
    assert [axes.get_ylabel().split(",")[0] for axes in drawn] == numbers, "one axis each"
    assert not theirs.get_lines() and len({axes.figure for axes in drawn}) == 1
    assert sweep.plot("E1max", ax=theirs) is theirs and len(theirs.get_lines()) == 1
    assert ssvi.simulate().plot() is not theirs
    with pytest.raises(rt.Error, match="there is no column E9: the columns are omega"):
        sweep.plot("E9")
    assert ssvi.simulate().to_pandas().t.iloc[0] == 50
    assert len(ssvi.simulate().plot("x1", "E1").get_lines()) >= 2
    with pytest.raises(AttributeError, match="the columns are omega"):
        sweep.E3max
