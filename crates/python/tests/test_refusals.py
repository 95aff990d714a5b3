"""Whatever is given ends in a value or in an exception of Python's, never in an abort; every exception says what to do."""

from __future__ import annotations

import json
from typing import Any

import numpy as np
import pytest
from conftest import STUDIES, designs
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays

import retune as rt

ONCE = {"suppress_health_check": [HealthCheck.function_scoped_fixture], "deadline": None}
STRUCTURE = rt.Structure(m1=1000, c1=452, k1=3.95e4)


@pytest.mark.parametrize(
    ("call", "field", "value", "said"),
    [
        (lambda p: rt.Structure(m1=-1, c1=0, k1=1), "m1", -1, "m1: -1 is not allowed here: give a finite number above 0"),
        (lambda p: rt.Structure(m1=float("nan"), c1=0, k1=1), "m1", None, "give a finite number"),
        (lambda p: rt.SSVI(60, k2=1, c2=-2.5, D=0, C=0), "c2", -2.5, "c2: -2.5 is not allowed"),
        (lambda p: rt.TMD("heavy"), "m2", "heavy", 'm2: "heavy" is not a number in kg, nor one with its unit: kg, g, t'),
        (lambda p: rt.Structure(m1="1 t", c1=0, k1="20 kN"), "k1", "20 kN", 'k1: "20 kN" is not a number in N/m'),
        (lambda p: rt.Problem(STRUCTURE, None, P="1 kg"), "scene.forcing.P", "1 kg", '"1 kg" is not a number in N'),
        (lambda p: p.at(k1="3 Hz"), "k1", "3 Hz", '"3 Hz" is not a number in N/m'),
        (lambda p: rt.Problem(STRUCTURE, None, P=1, band=(5, 8)), "band", None, "band: of no use without vary"),
        (lambda p: rt.Problem(STRUCTURE, None, P=1, limits={"stroke": 1}), "limits", None, "limits: of no use without vary"),
        (lambda p: rt.Problem(STRUCTURE, rt.TMD(60, k2=1, c2=1), P=1, band=(8, 5), vary=["k2"]), "band", None, "give the lower frequency first"),
        (lambda p: rt.Problem(STRUCTURE, rt.TMD(60, k2=1, c2=1), P=1, band="5..8", vary=["k2"]), "band", "5..8", "give two, for instance"),
        (lambda p: rt.Contact(nu1=0.7), "nu1", 0.7, "nu1: 0.7 is not allowed here: give a number above -1 and at most 0.5"),
        (lambda p: rt.Problem(STRUCTURE, rt.TMD(60), P=1, vary=["k2"]), "scene.damper.k2", None, "missing"),
        (lambda p: rt.Problem(STRUCTURE, None, P=1, vary=["k2"]), "scene.damper", None, "missing, but `optimize` tunes"),
        (lambda p: rt.Problem(STRUCTURE, rt.TMD(60, k2=1, c2=1), vary=["k2"]), "scene.forcing", {"omega": 6.284902544988268}, "give one of"),
        (lambda p: rt.Problem(STRUCTURE, rt.TMD(60, k2=1, c2=1), P=1, vary=["k3"]), "optimize.vary[0]", "k3", "did you mean `k2`"),
        (
            lambda p: rt.Problem(STRUCTURE, rt.TMD(60, k2=1, c2=1), P=1, vary=["k2"], bounds={"k2": (5, 3)}),
            "optimize.bounds.k2",
            [5, 3],
            "0 <= smallest < largest",
        ),
        (lambda p: rt.Problem(STRUCTURE, None, P=1, window=(9, 3)), "window", {"t0": 9, "T": 3}, "the window is empty"),
        (lambda p: rt.Record([0, 1], [1, 2], of="push"), "of", "push", "expected `force` or `base acceleration`"),
        (lambda p: rt.Record([0, 1], [1, 2], of="force", unit="g"), "unit", "g", "give one of N, kN"),
        (lambda p: rt.Record(None, [1, 2], of="force"), "t", None, "t: None is not allowed here: give real numbers"),
        (lambda p: rt.Record([0, 1, 2], [1, 2], of="force"), "a", None, "one value for each time"),
        (lambda p: rt.Problem(STRUCTURE, record=rt.Record([0, 0], [1, 2], of="force")), "scene.forcing", None, "sample 2: the time 0 s"),
        (lambda p: rt.Problem(STRUCTURE, record=rt.Record(0.1, [1, np.nan], of="force")), "scene.forcing.record.values[1]", None, "give a finite"),
        (lambda p: rt.Problem(STRUCTURE, record=rt.Pulse("saw", 1, 1, of="force")), "scene.forcing.pulse", "saw", "allowed: half sine, rectangle, versed sine"),
        (lambda p: rt.Problem.from_study({"scen": {}}), "scen", {}, "did you mean `scene`"),
        (lambda p: rt.Problem.from_study("missing.json"), None, None, "missing.json: cannot be read"),
        (lambda p: p([1, 2, 3]), "x", None, "one number for each of k2, c2, D, C"),
        (lambda p: p([-1, 2, 3, 4]), "k2", -1, "k2: -1 is not allowed"),
        (lambda p: p("abcd"), "x", None, "give real numbers"),
        (lambda p: p([1j] * 4), "x", None, "give real numbers"),
        (lambda p: p.batch([1, 2, 3, 4]), "X", None, "give (n, 4)"),
        (lambda p: p.batch([[1, 2, 3, 4]], threads=0), "threads", 0, "from 1 to 1024"),
        (lambda p: p.simulate(interval=0), "interval", 0, "above 0"),
        (lambda p: p.simulate(k3=1), "k3", None, "did you mean"),
        (lambda p: p.simulate(k1=-3), "k1", -3, "not below 0"),
        (lambda p: p.sweep(mass=[1]), "mass", None, "there is no parameter"),
        (lambda p: p.sweep(k1=[1, np.inf]), "k1", np.inf, "finite"),
        (lambda p: p.sweep(k1=[]), "k1", None, "one value or more"),
    ],
)
def test_contract_an_error_names_the_field_and_what_to_do(ssvi: rt.Problem, call: Any, field: str, value: Any, said: str) -> None:
    with pytest.raises(rt.StudyError) as caught:
        call(ssvi)
    error = caught.value
    assert isinstance(error, (rt.Error, ValueError)) and said in str(error)
    assert error.field == field
    if value is not None:
        assert error.value == value


def test_contract_a_run_that_cannot_be_finished_says_when(ssvi: rt.Problem) -> None:
    short = rt.Problem.from_study({**ssvi.study, "solver": {"max_steps": 50}})
    with pytest.raises(rt.SolverError, match="max_steps") as caught:
        short(ssvi.start)
    assert isinstance(caught.value, RuntimeError) and 0 <= caught.value.t < 100
    batch = short.batch([ssvi.start])
    assert batch.value[0] == np.inf and np.isnan(batch.E1max[0])
    assert isinstance(batch.errors[0], rt.SolverError) and batch.errors[0].t == caught.value.t


def test_contract_a_study_without_a_search_can_only_be_run() -> None:
    bare = rt.Problem(STRUCTURE, None, P=800, omega=6.0)
    assert bare.simulate().maxima["E1max"] > 0 and bare.names == []
    for call in (lambda: bare([]), lambda: bare.batch(np.empty((1, 0))), lambda: rt.optimize(bare)):
        with pytest.raises(rt.StudyError, match="optimize: missing"):
            call()


def test_contract_a_file_with_a_mistake_names_file_line_and_field(tmp_path: Any) -> None:
    study = json.loads((STUDIES / "ssvi.json").read_text())
    study["scene"]["damper"]["k2"] = -1
    file = tmp_path / "wrong.json"
    file.write_text(json.dumps(study, indent=1))
    with pytest.raises(rt.StudyError) as caught:
        rt.Problem.from_study(file)
    assert caught.value.field == "scene.damper.k2" and caught.value.value == -1
    assert str(caught.value).startswith(f"{file}:")


X = arrays.arrays(
    dtype=st.sampled_from([np.float64, np.float32, np.float16, np.int64, np.uint8, np.bool_, np.dtype(">f8"), np.complex128, object, "U3"]),
    shape=arrays.array_shapes(min_dims=0, max_dims=3, min_side=0, max_side=6),
)


def turned(array: np.ndarray, how: int) -> np.ndarray:
    """The array as it is, reversed, transposed, strided, or out of alignment."""
    match how:
        case 1:
            return array[..., ::-1] if array.ndim else array
        case 2:
            return array.T
        case 3:
            return array[..., ::2] if array.ndim else array
        case 4 if array.dtype == np.float64:
            odd = np.zeros(array.nbytes + 1, np.uint8)[1:].view(np.float64).reshape(array.shape)
            odd[...] = array
            return odd
        case _:
            return array


@settings(max_examples=300, **ONCE)
@given(array=X, how=st.integers(0, 4))
def test_invariant_any_array_ends_in_a_value_or_an_exception(tmd: rt.Problem, array: np.ndarray, how: int) -> None:
    array = turned(array, how)
    try:
        found = tmd(array)
        assert array.shape == (2,) and found == tmd([float(value) for value in array])
    except rt.StudyError as error:
        assert str(error)
    try:
        batch = tmd.batch(array)
        assert array.ndim == 2 and array.shape[1] == 2 and batch.rows == len(array)
        assert all(np.isfinite(value) or i in batch.errors or batch.E1max[i] == np.inf for i, value in enumerate(batch.value))
    except rt.StudyError as error:
        assert str(error)


@settings(max_examples=200, **ONCE)
@given(row=st.lists(st.floats(), min_size=4, max_size=4), omega=st.floats(), k1=st.floats(), interval=st.floats())
def test_invariant_any_number_ends_in_a_value_or_an_exception(
    ssvi: rt.Problem, row: list[float], omega: float, k1: float, interval: float
) -> None:
    # What is refused late must not take minutes: a run may take few steps.
    bounded = rt.Problem.from_study({**ssvi.study, "window": {"t0": 0, "T": 2}, "solver": {"max_steps": 2000}})
    for call in (
        lambda: bounded(row),
        lambda: bounded.evaluate(row).largest,
        lambda: bounded.simulate(row, omega=omega, k1=k1, interval=max(interval, 1e-4)).maxima["E1max"],
        lambda: bounded.sweep(omega=[omega, 6.0]).E1max[0],
    ):
        try:
            found = call()
        except rt.Error as error:
            assert str(error)
        else:
            assert found is None or found >= 0 or np.isnan(found)


json_value = st.recursive(
    st.none() | st.booleans() | st.floats() | st.integers() | st.text(max_size=5),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=5), inner, max_size=3),
    max_leaves=5,
)


@settings(max_examples=200, **ONCE)
@given(data=st.data())
def test_invariant_any_study_is_read_or_refused(ssvi: rt.Problem, data: st.DataObject) -> None:
    study: Any = ssvi.study
    place = study
    while isinstance(place, dict) and place:
        key = data.draw(st.sampled_from(sorted(place)))
        if not isinstance(place[key], dict) or data.draw(st.booleans()):
            place[key] = data.draw(json_value)
            break
        place = place[key]
    try:
        problem = rt.Problem.from_study(study)
    except rt.StudyError as error:
        assert str(error)
    else:
        assert rt.Problem.from_study(problem.study) == problem and repr(problem)


def test_contract_empty_and_large_batches(tmd: rt.Problem) -> None:
    assert tmd.batch(np.empty((0, 2))).rows == 0
    X = np.full((100_000, 2), np.nan)
    X[::2] = designs(tmd, 50_000)
    batch = tmd.batch(X)
    assert np.isfinite(batch.value[::2]).all() and np.isinf(batch.value[1::2]).all()
    assert list(batch.errors) == list(range(1, 200, 2)), "the first hundred are told"


def test_contract_an_array_that_changes_meanwhile_is_not_read(ssvi: rt.Problem) -> None:
    """The designs are copied before the lock is released."""
    X = designs(ssvi, 64)
    before = ssvi.batch(X)
    import threading

    stop = threading.Event()
    shared = X.copy()

    def write() -> None:
        while not stop.is_set():
            shared[:] = np.nan
            shared[:] = X

    thread = threading.Thread(target=write)
    thread.start()
    batches = [ssvi.batch(shared) for _ in range(3)]
    stop.set()
    thread.join()
    for batch in batches:
        same = (batch.value == before.value) | np.isinf(batch.value)
        assert same.all(), "each row is the design as it was, or not a number at all"


class Broken:
    """An array that fails inside, as a wrong index does."""

    def __array__(self, *_: Any, **__: Any) -> np.ndarray:
        return np.arange(3)[np.array([7])]

    def __float__(self) -> float:
        raise IndexError("index 7 is out of bounds")

    def __iter__(self) -> Any:
        raise KeyError("missing")


@pytest.mark.parametrize(
    ("call", "field"),
    [
        (lambda p: p(Broken()), "x"),
        (lambda p: p.evaluate(Broken()), "x"),
        (lambda p: p.gradient(Broken()), "x"),
        (lambda p: p.batch(Broken()), "X"),
        (lambda p: p.simulate(k1=Broken()), "k1"),
        (lambda p: p.simulate(interval=Broken()), "interval"),
        (lambda p: p.at(k1=Broken()), "k1"),
        (lambda p: p.sweep(k1=Broken()), "k1"),
        (lambda p: rt.Problem(STRUCTURE, None, P=1, window=Broken()), "window"),
        (lambda p: rt.Problem(STRUCTURE, None, P=1, window=(1,)), "window"),
        (lambda p: rt.Problem(STRUCTURE, None, P=1, band=(5,)), "band"),
        (lambda p: rt.Problem(STRUCTURE, rt.TMD(60, k2=1, c2=1), P=1, vary=["k2"], bounds={"k2": 3}), "optimize.bounds.k2"),
        (lambda p: rt.SSVI(Broken(), k2=1, c2=1, D=1, C=1), "m2"),
    ],
)
def test_contract_an_object_that_raises_is_refused_by_its_argument(ssvi: rt.Problem, call: Any, field: str) -> None:
    with pytest.raises(rt.StudyError, match=field) as caught:
        call(ssvi)
    assert caught.value.field == field
    with pytest.raises(TypeError, match="structure"):
        rt.Problem(Broken(), None, P=1)  # type: ignore[arg-type]


def test_contract_a_window_follows_the_structure() -> None:
    omega = 2 * np.pi * 0.3
    building = rt.Structure(m1=2e5, c1=2 * 0.01 * 2e5 * omega, k1=2e5 * omega**2)
    problem = rt.Problem(building, None, P=1000)
    settled = problem.simulate().maxima["E1max"]
    steady = 0.5 * 2e5 * (1000 / (2 * 0.01 * 2e5 * omega)) ** 2
    assert settled == pytest.approx(steady, rel=3e-3)
    with pytest.warns(UserWarning, match="the slowest transient still has 38.97 % of its start"):
        early = rt.Problem(building, None, P=1000, window=(50, 100))
    assert early.simulate().maxima["E1max"] < 0.8 * settled


def test_contract_walls_that_are_not_given_follow_the_mass() -> None:
    assert rt.SSVI(60, k2=1, c2=1, D=1, C=1).contact == rt.Contact()
    light = rt.SSVI(0.1, k2=1, c2=1, D=1, C=1).contact
    assert light is not None and light.R == 2 and light.E2 == pytest.approx(2.21e7 * 0.1 / 60, rel=1e-15)
