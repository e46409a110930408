//! NumPy's arrays: what comes in is checked and copied, what goes out is a read-only view of memory that Rust owns.

use glam::DVec3;
use numpy::ndarray::{ArrayView1, ArrayView2};
use numpy::{Element, PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray2, PyUntypedArray, PyUntypedArrayMethods};
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;

use crate::errors::refuse;

/// Whole numbers up to this are doubles, all of them.
const MAX_EXACT: f64 = (1u64 << f64::MANTISSA_DIGITS) as f64;

/// A function of NumPy.
fn numpy_function<'py>(py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyAny>> {
    static NUMPY: PyOnceLock<Py<PyModule>> = PyOnceLock::new();
    NUMPY.get_or_try_init(py, || PyResult::Ok(py.import("numpy")?.unbind()))?.bind(py).getattr(name)
}

/// What can be seen as an array, as one.
fn as_array<'py>(value: &Bound<'py, PyAny>, name: &str) -> PyResult<Bound<'py, PyUntypedArray>> {
    let py = value.py();
    // what is masked would come back with the numbers below the mask
    if value.hasattr("mask")? && numpy_function(py, "ma")?.call_method1("is_masked", (value,))?.is_truthy()? {
        return Err(refuse(format!("{name}: found an array with masked numbers, expected all of them")));
    }
    let array = numpy_function(py, "asarray")?.call1((value,));
    let array = array.map_err(|error| refuse(format!("{name}: found what is no array: {}", error.value(py))))?;
    Ok(array.cast_into()?)
}

/// The letter for the kind of an array's numbers, and how many bytes each has.
fn kind_of(array: &Bound<'_, PyUntypedArray>) -> PyResult<(String, usize)> {
    let dtype = array.dtype();
    let dtype = dtype.as_any();
    Ok((dtype.getattr("kind")?.extract()?, dtype.getattr("itemsize")?.extract()?))
}

fn shape_text(array: &Bound<'_, PyUntypedArray>) -> String {
    let sizes: Vec<String> = array.shape().iter().map(ToString::to_string).collect();
    format!("({}{})", sizes.join(", "), if sizes.len() == 1 { "," } else { "" })
}

/// The array with numbers of another type, in rows one after another.
fn cast<'py, T: Element>(array: &Bound<'py, PyUntypedArray>, rows: bool) -> PyResult<Bound<'py, PyArray2<T>>> {
    let py = array.py();
    let dtype = numpy::dtype::<T>(py);
    // contiguous and aligned; what is so already is not copied here
    let array = numpy_function(py, "require")?.call1((array, dtype, ("C", "A")))?;
    let array = if rows { array } else { array.call_method1("reshape", ((1, -1),))? };
    Ok(array.cast_into()?)
}

/// Finite numbers as doubles, in rows of `N`. An empty list is an array without rows; with `single`, so is one row by itself.
fn rows<const N: usize>(value: &Bound<'_, PyAny>, name: &str, single: bool) -> PyResult<Vec<[f64; N]>> {
    let array = as_array(value, name)?;
    let expected = if single { format!("({N},)") } else { format!("(n, {N})") };
    let (kind, bytes) = kind_of(&array)?;
    if array.len() == 0 && !single && (array.ndim() == 1 || array.ndim() == 2 && array.shape()[1] == N) {
        return Ok(Vec::new());
    }
    if !matches!(kind.as_str(), "f" | "i" | "u") {
        let dtype = array.dtype();
        return Err(refuse(format!("{name}: found an array of {dtype}, expected real numbers of shape {expected}")));
    }
    let fits = if single { array.shape() == [N] } else { array.ndim() == 2 && array.shape()[1] == N };
    if !fits {
        return Err(refuse(format!("{name}: found an array of shape {}, expected {expected}", shape_text(&array))));
    }
    let array = cast::<f64>(&array, !single)?;
    let array: PyReadonlyArray2<'_, f64> = array.try_readonly()?;
    let numbers = array.as_slice()?;
    let (rows, _) = numbers.as_chunks::<N>();
    let is_rounded = |number: f64| kind != "f" && bytes >= 8 && number.abs() > MAX_EXACT;
    if let Some(place) = numbers.iter().position(|number| !number.is_finite() || is_rounded(*number)) {
        let at = if single { format!("[{place}]") } else { format!("[{}, {}]", place / N, place % N) };
        let number = numbers[place];
        let expected = if number.is_finite() { "whole numbers of at most 2^53" } else { "finite numbers" };
        return Err(refuse(format!("{name}: found {number} at {at}, expected {expected}")));
    }
    Ok(rows.to_vec())
}

/// Points, of shape (n, 3).
pub(crate) fn points(value: &Bound<'_, PyAny>, name: &str) -> PyResult<Vec<DVec3>> {
    Ok(rows::<3>(value, name, false)?.into_iter().map(DVec3::from).collect())
}

/// The first three columns of an array that may have more.
pub(crate) fn positions<'py>(value: &Bound<'py, PyAny>, name: &str) -> PyResult<Bound<'py, PyAny>> {
    let array = as_array(value, name)?;
    if array.ndim() != 2 || array.shape()[1] <= 3 {
        return Ok(array.into_any());
    }
    numpy_function(value.py(), "delete")?.call1((&array, pyo3::types::PySlice::new(value.py(), 3, isize::MAX, 1), 1))
}

/// Rows of any length that is known.
pub(crate) fn table<const N: usize>(value: &Bound<'_, PyAny>, name: &str) -> PyResult<Vec<[f64; N]>> {
    rows::<N>(value, name, false)
}

/// A few numbers, of shape (N,).
pub(crate) fn row<const N: usize>(value: &Bound<'_, PyAny>, name: &str) -> PyResult<[f64; N]> {
    Ok(rows::<N>(value, name, true)?[0])
}

/// A point or a direction, of shape (3,).
pub(crate) fn vector(value: &Bound<'_, PyAny>, name: &str) -> PyResult<DVec3> {
    row::<3>(value, name).map(DVec3::from)
}

/// How many columns a two-dimensional array has; 0 for others.
pub(crate) fn columns(value: &Bound<'_, PyAny>, name: &str) -> PyResult<usize> {
    Ok(shape(value, name)?.1)
}

/// How many rows and columns a two-dimensional array has; 0 for others.
pub(crate) fn shape(value: &Bound<'_, PyAny>, name: &str) -> PyResult<(usize, usize)> {
    let array = as_array(value, name)?;
    Ok(if array.ndim() == 2 { (array.shape()[0], array.shape()[1]) } else { (0, 0) })
}

/// Numbers of vertices, of shape (m, 3), each below a count.
pub(crate) fn triangles(value: &Bound<'_, PyAny>, name: &str, vertices: usize) -> PyResult<Vec<[u32; 3]>> {
    let array = as_array(value, name)?;
    if array.len() == 0 && (array.ndim() == 1 || array.ndim() == 2 && array.shape()[1] == 3) {
        return Ok(Vec::new());
    }
    if array.ndim() != 2 || array.shape()[1] != 3 {
        return Err(refuse(format!("{name}: found an array of shape {}, expected (m, 3)", shape_text(&array))));
    }
    let found = indices(&array, name, vertices)?;
    Ok(found.as_chunks::<3>().0.to_vec())
}

/// Numbers below a count, of shape (m,).
pub(crate) fn numbers(value: &Bound<'_, PyAny>, name: &str, length: Option<usize>, count: usize) -> PyResult<Vec<u32>> {
    let array = as_array(value, name)?;
    let fits = array.ndim() == 1 && length.is_none_or(|length| array.len() == length);
    if !fits {
        let expected = length.map_or("(m,)".to_owned(), |length| format!("({length},)"));
        return Err(refuse(format!("{name}: found an array of shape {}, expected {expected}", shape_text(&array))));
    }
    if array.len() == 0 { Ok(Vec::new()) } else { indices(&array, name, count) }
}

fn indices(array: &Bound<'_, PyUntypedArray>, name: &str, count: usize) -> PyResult<Vec<u32>> {
    let (kind, _) = kind_of(array)?;
    if !matches!(kind.as_str(), "i" | "u") {
        let dtype = array.dtype();
        return Err(refuse(format!("{name}: found an array of {dtype}, expected whole numbers")));
    }
    let columns = if array.ndim() == 2 { array.shape()[1] } else { 1 };
    let wrong = |place: usize, found: String| {
        let at = if array.ndim() == 2 {
            format!("[{}, {}]", place / columns, place % columns)
        } else {
            format!("[{place}]")
        };
        let last = count.saturating_sub(1);
        refuse(format!("{name}: found {found} at {at}, expected numbers from 0 to {last}"))
    };
    let is_row = array.ndim() == 2;
    if kind == "u" {
        let array = cast::<u64>(array, is_row)?;
        let array = array.try_readonly()?;
        let numbers = array.as_slice()?;
        if let Some(place) = numbers.iter().position(|number| *number >= count as u64) {
            return Err(wrong(place, numbers[place].to_string()));
        }
        return Ok(numbers.iter().map(|number| *number as u32).collect());
    }
    let array = cast::<i64>(array, is_row)?;
    let array = array.try_readonly()?;
    let numbers = array.as_slice()?;
    let is_wrong = |number: &i64| u64::try_from(*number).map_or(true, |number| number >= count as u64);
    if let Some(place) = numbers.iter().position(is_wrong) {
        return Err(wrong(place, numbers[place].to_string()));
    }
    Ok(numbers.iter().map(|number| *number as u32).collect())
}

/// A read-only array of rows that an object owns.
pub(crate) fn view_rows<'py, T: Element, const N: usize>(
    owner: &Bound<'py, PyAny>,
    rows: &[[T; N]],
) -> Bound<'py, PyArray2<T>> {
    let numbers = rows.as_flattened();
    let array = ArrayView2::from_shape((rows.len(), N), numbers).expect("rows of one length");
    // SAFETY: callers pass rows of an object that never changes and that lives as long as the owner, which the array holds as its base. Nothing moves or frees them
    // before the last array is gone, and the array is made read-only before anybody sees it; NumPy lets nobody make it writable again, as its base is no buffer.
    #[allow(unsafe_code)]
    let array = unsafe { PyArray2::borrow_from_array(&array, owner.clone()) };
    array.readwrite().make_nonwriteable();
    array
}

/// The same for numbers one after another.
pub(crate) fn view<'py, T: Element>(owner: &Bound<'py, PyAny>, numbers: &[T]) -> Bound<'py, PyArray1<T>> {
    let array = ArrayView1::from(numbers);
    // SAFETY: as in `view_rows`.
    #[allow(unsafe_code)]
    let array = unsafe { PyArray1::borrow_from_array(&array, owner.clone()) };
    array.readwrite().make_nonwriteable();
    array
}

/// The same for points.
pub(crate) fn view_points<'py>(owner: &Bound<'py, PyAny>, points: &[DVec3]) -> Bound<'py, PyArray2<f64>> {
    view_rows(owner, bytemuck::cast_slice::<DVec3, [f64; 3]>(points))
}

/// A new read-only array of a few rows.
pub(crate) fn small_rows<'py, T: Element + Copy, const N: usize>(
    py: Python<'py>,
    rows: &[[T; N]],
) -> PyResult<Bound<'py, PyArray2<T>>> {
    let array = PyArray1::from_slice(py, rows.as_flattened()).reshape([rows.len(), N])?;
    array.readwrite().make_nonwriteable();
    Ok(array)
}

/// A new read-only array of a few numbers.
pub(crate) fn small<'py, T: Element + Copy>(py: Python<'py>, numbers: &[T]) -> Bound<'py, PyArray1<T>> {
    let array = PyArray1::from_slice(py, numbers);
    array.readwrite().make_nonwriteable();
    array
}
