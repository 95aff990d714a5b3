//! Numbers from numpy and back.

use crate::errors::internal;
use numpy::{PyArray1, PyArrayDyn, PyArrayMethods, PyUntypedArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// Any array, list or number as 64-bit numbers in C order, with its shape. They are copied: the caller's array may change while the
/// interpreter's lock is released.
///
/// # Errors
/// They are not numbers: `retune.StudyError` with `name`.
pub fn numbers(values: &Bound<'_, PyAny>, name: &str) -> PyResult<(Vec<f64>, Vec<usize>)> {
    let convert = values.py().import("retune._arrays")?.getattr("floats")?;
    let array = convert.call1((values, name))?;
    let array = array.cast::<PyArrayDyn<f64>>().map_err(|_| internal("numpy made no array of numbers"))?;
    let numbers = array.try_readonly().map_err(|error| internal(&error.to_string()))?;
    Ok((numbers.as_slice().map_err(|error| internal(&error.to_string()))?.to_vec(), array.shape().to_vec()))
}

/// Copies a row that is already a 64-bit array, the usual case, into `row`; false if it has to be converted.
pub fn plain_row(values: &Bound<'_, PyAny>, row: &mut [f64]) -> bool {
    let Ok(array) = values.cast::<PyArray1<f64>>() else { return false };
    let aligned = array.data().align_offset(align_of::<f64>()) == 0;
    if !aligned || array.len() != row.len() || !array.is_c_contiguous() {
        return false;
    }
    let Ok(numbers) = array.try_readonly() else { return false };
    numbers.as_slice().is_ok_and(|numbers| {
        row.copy_from_slice(numbers);
        true
    })
}

/// A dictionary of named columns as numpy arrays.
///
/// # Errors
/// Out of memory.
pub fn table<'py>(
    py: Python<'py>,
    columns: impl IntoIterator<Item = (String, Vec<f64>)>,
) -> PyResult<Bound<'py, PyDict>> {
    let table = PyDict::new(py);
    for (name, values) in columns {
        table.set_item(name, PyArray1::from_vec(py, values))?;
    }
    Ok(table)
}
