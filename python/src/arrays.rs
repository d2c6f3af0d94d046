//! Numbers as NumPy arrays. The only file that imports `numpy`.

use crate::error::wrong;
use numpy::{Element, PyArray1, PyArrayDyn, PyArrayMethods, PyReadonlyArrayDyn};
use pyo3::prelude::*;
use vodca::Position;

/// `values` as an array of this shape, without a copy.
pub(crate) fn array<'py, T: Element>(py: Python<'py>, values: Vec<T>, shape: &[usize]) -> PyResult<Bound<'py, PyAny>> {
    Ok(PyArray1::from_vec(py, values).reshape(shape.to_vec())?.into_any())
}

/// Points as an array [..., 2].
pub(crate) fn points<'py>(
    py: Python<'py>,
    points: impl IntoIterator<Item = Position>,
    shape: &[usize],
) -> PyResult<Bound<'py, PyAny>> {
    let values = points.into_iter().flat_map(|point| [point.x, point.y]).collect();
    array(py, values, &[shape, &[2]].concat())
}

/// The numbers of `given`, an array of `shape` of exactly this type; `what` is named in errors.
pub(crate) fn numbers<T: Element + Copy>(given: &Bound<'_, PyAny>, what: &str, shape: &[usize]) -> PyResult<Vec<T>> {
    let refused = || wrong(format!("{what} is no array of the right type; its shape is {shape:?}"));
    let array = given.cast::<PyArrayDyn<T>>().map_err(|_| refused())?;
    let array: PyReadonlyArrayDyn<'_, T> = array.try_readonly().map_err(|_| refused())?;
    let view = array.as_array();
    if view.shape() != shape {
        return Err(wrong(format!("{what} has the shape {:?}; it must be {shape:?}", view.shape())));
    }
    Ok(view.iter().copied().collect())
}

/// Two finite numbers: an array, a list or a tuple.
pub(crate) fn point(given: &Bound<'_, PyAny>, what: &str) -> PyResult<Position> {
    let [x, y]: [f64; 2] = given.extract().map_err(|_| wrong(format!("{what} = {given} is not [x, y] in metres")))?;
    if x.is_finite() && y.is_finite() {
        return Ok(Position::new(x, y));
    }
    Err(wrong(format!("{what} = [{x}, {y}] m; coordinates must be finite numbers")))
}
