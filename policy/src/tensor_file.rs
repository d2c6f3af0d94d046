//! Named arrays in a file: safetensors, which Python reads with one line
//! (`safetensors.numpy.load_file`). The only file that knows the crate.
//!
//! The same content gives the same bytes: tensors are stored by size of their elements, then name, and
//! all metadata is one text (the format keeps several in no particular order).

use safetensors::tensor::{Dtype, SafeTensors, TensorView, serialize};
use std::collections::{BTreeMap, HashMap};
use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// The key of the metadata's only entry.
const ABOUT: &str = "vodca";

/// The numbers of a tensor, row by row.
#[derive(Clone, Debug, PartialEq)]
pub enum Data {
    /// 32-bit floats.
    F32(Vec<f32>),
    /// 64-bit floats.
    F64(Vec<f64>),
    /// Bytes.
    U8(Vec<u8>),
    /// 64-bit counters.
    U64(Vec<u64>),
}

/// An array.
#[derive(Clone, Debug, PartialEq)]
pub struct Tensor {
    /// Its shape; the product is the number of numbers.
    pub shape: Vec<usize>,
    /// Its numbers.
    pub data: Data,
}

/// Named arrays and a text that says what they are.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TensorFile {
    /// JSON by custom.
    pub about: String,
    /// By name.
    pub tensors: BTreeMap<String, Tensor>,
}

/// A tensor file cannot be written or read.
#[derive(Debug, thiserror::Error)]
pub enum TensorFileError {
    /// The system refused.
    #[error("cannot {what} {}: {source}; is the place writable, and is there space left?", path.display())]
    Io {
        /// `read` or `write`.
        what: &'static str,
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: io::Error,
    },
    /// Not a safetensors file, or cut off.
    #[error("{} is not a whole safetensors file: {reason}; was its writer cut off? remove it", path.display())]
    Malformed {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        reason: String,
    },
    /// The tensor is not there, or is another one.
    #[error("{} has no tensor `{tensor}` of {kind} in the shape {wanted:?}; it has {found}", path.display())]
    Missing {
        /// The file.
        path: PathBuf,
        /// Its name.
        tensor: String,
        /// Type of the numbers wanted.
        kind: &'static str,
        /// The shape wanted.
        wanted: Vec<usize>,
        /// What is there instead.
        found: String,
    },
}

impl Data {
    fn kind(&self) -> &'static str {
        match self {
            Self::F32(_) => "f32",
            Self::F64(_) => "f64",
            Self::U8(_) => "u8",
            Self::U64(_) => "u64",
        }
    }

    fn stored(&self) -> (Dtype, Vec<u8>) {
        match self {
            Self::F32(numbers) => (Dtype::F32, numbers.iter().flat_map(|n| n.to_le_bytes()).collect()),
            Self::F64(numbers) => (Dtype::F64, numbers.iter().flat_map(|n| n.to_le_bytes()).collect()),
            Self::U8(numbers) => (Dtype::U8, numbers.clone()),
            Self::U64(numbers) => (Dtype::U64, numbers.iter().flat_map(|n| n.to_le_bytes()).collect()),
        }
    }

    fn read(dtype: Dtype, bytes: &[u8]) -> Option<Self> {
        fn numbers<const SIZE: usize, T>(bytes: &[u8], number: impl Fn([u8; SIZE]) -> T) -> Vec<T> {
            let (whole, _) = bytes.as_chunks::<SIZE>();
            whole.iter().map(|chunk| number(*chunk)).collect()
        }
        Some(match dtype {
            Dtype::F32 => Self::F32(numbers(bytes, f32::from_le_bytes)),
            Dtype::F64 => Self::F64(numbers(bytes, f64::from_le_bytes)),
            Dtype::U8 | Dtype::BOOL => Self::U8(bytes.to_vec()),
            Dtype::U64 => Self::U64(numbers(bytes, u64::from_le_bytes)),
            _ => return None,
        })
    }
}

impl TensorFile {
    /// Adds a tensor.
    pub fn put(&mut self, name: &str, shape: &[usize], data: Data) {
        self.tensors.insert(name.to_owned(), Tensor { shape: shape.to_vec(), data });
    }

    /// Takes out the f32 numbers of `name`, which must have `shape`.
    pub fn take_f32(&mut self, path: &Path, name: &str, shape: &[usize]) -> Result<Vec<f32>, TensorFileError> {
        match self.tensors.remove(name) {
            Some(Tensor { shape: found, data: Data::F32(numbers) }) if found == shape => Ok(numbers),
            other => Err(missing(path, name, "f32", shape, other)),
        }
    }

    /// The same for u8.
    pub fn take_u8(&mut self, path: &Path, name: &str, shape: &[usize]) -> Result<Vec<u8>, TensorFileError> {
        match self.tensors.remove(name) {
            Some(Tensor { shape: found, data: Data::U8(numbers) }) if found == shape => Ok(numbers),
            other => Err(missing(path, name, "u8", shape, other)),
        }
    }

    /// The same for u64.
    pub fn take_u64(&mut self, path: &Path, name: &str, shape: &[usize]) -> Result<Vec<u64>, TensorFileError> {
        match self.tensors.remove(name) {
            Some(Tensor { shape: found, data: Data::U64(numbers) }) if found == shape => Ok(numbers),
            other => Err(missing(path, name, "u64", shape, other)),
        }
    }

    /// The file's bytes.
    fn bytes(&self, path: &Path) -> Result<Vec<u8>, TensorFileError> {
        let failed = |reason: String| TensorFileError::Malformed { path: path.to_owned(), reason };
        let stored: Vec<_> =
            self.tensors.iter().map(|(name, tensor)| (name, &tensor.shape, tensor.data.stored())).collect();
        let views: Result<Vec<_>, _> = stored
            .iter()
            .map(|(name, shape, (dtype, bytes))| Ok((name, TensorView::new(*dtype, shape.to_vec(), bytes)?)))
            .collect();
        let views = views.map_err(|error: safetensors::SafeTensorError| failed(error.to_string()))?;
        let about = HashMap::from([(ABOUT.to_owned(), self.about.clone())]);
        serialize(views, Some(about)).map_err(|error| failed(error.to_string()))
    }

    /// Writes the file beside its place and renames it into place.
    pub fn write(&self, path: &Path) -> Result<(), TensorFileError> {
        let bytes = self.bytes(path)?;
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        let beside = path.with_file_name(format!(".{name}.part"));
        let written = File::create(&beside)
            .and_then(|mut file| file.write_all(&bytes).and_then(|()| file.sync_all()))
            .and_then(|()| fs::rename(&beside, path));
        written.map_err(|source| {
            let _ = fs::remove_file(&beside); // best effort: the error that is reported matters more
            TensorFileError::Io { what: "write", path: path.to_owned(), source }
        })
    }

    /// Reads a file. Tensors of types that are not written here are left out.
    pub fn read(path: &Path) -> Result<Self, TensorFileError> {
        let bytes =
            fs::read(path).map_err(|source| TensorFileError::Io { what: "read", path: path.to_owned(), source })?;
        let failed = |error: safetensors::SafeTensorError| TensorFileError::Malformed {
            path: path.to_owned(),
            reason: error.to_string(),
        };
        let (_, header) = SafeTensors::read_metadata(&bytes).map_err(failed)?;
        let about = header.metadata().as_ref().and_then(|entries| entries.get(ABOUT)).cloned().unwrap_or_default();
        let mut tensors = BTreeMap::new();
        for (name, view) in SafeTensors::deserialize(&bytes).map_err(failed)?.iter() {
            if let Some(data) = Data::read(view.dtype(), view.data()) {
                tensors.insert(name.to_owned(), Tensor { shape: view.shape().to_vec(), data });
            }
        }
        Ok(Self { about, tensors })
    }
}

fn missing(path: &Path, tensor: &str, kind: &'static str, wanted: &[usize], found: Option<Tensor>) -> TensorFileError {
    let found = match found {
        Some(tensor) => format!("{} in the shape {:?}", tensor.data.kind(), tensor.shape),
        None => "none".into(),
    };
    TensorFileError::Missing { path: path.to_owned(), tensor: tensor.into(), kind, wanted: wanted.to_vec(), found }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn some() -> TensorFile {
        let mut file = TensorFile { about: "{\"a\":1}".into(), ..TensorFile::default() };
        file.put("x", &[2, 3], Data::F32(vec![1.5, -0.0, f32::MIN_POSITIVE, 3.0, 4.0, f32::INFINITY]));
        file.put("y", &[2], Data::U64(vec![0, u64::MAX]));
        file.put("a", &[3], Data::U8(vec![0, 7, 255]));
        file.put("d", &[1], Data::F64(vec![1.0 / 3.0]));
        file
    }

    #[test]
    fn what_is_written_is_read_and_gives_the_same_bytes() {
        let place = tempfile::tempdir().unwrap();
        let (first, second) = (place.path().join("a.safetensors"), place.path().join("b.safetensors"));
        some().write(&first).unwrap();
        let read = TensorFile::read(&first).unwrap();
        assert_eq!(read, some());
        read.write(&second).unwrap();
        assert_eq!(fs::read(first).unwrap(), fs::read(second).unwrap());
        assert_eq!(fs::read_dir(place.path()).unwrap().count(), 2, "nothing stays beside the files");
    }

    #[test]
    fn cut_off_and_foreign_files_are_refused() {
        let place = tempfile::tempdir().unwrap();
        let path = place.path().join("a.safetensors");
        some().write(&path).unwrap();
        let whole = fs::read(&path).unwrap();
        for length in [0, 4, 20, whole.len() - 1] {
            fs::write(&path, &whole[..length]).unwrap();
            let message = TensorFile::read(&path).unwrap_err().to_string();
            assert!(message.contains("is not a whole safetensors file"), "{message}");
        }
    }

    #[test]
    fn another_shape_or_type_is_named() {
        let mut file = some();
        let message = file.take_f32(Path::new("f"), "x", &[3, 2]).unwrap_err().to_string();
        assert_eq!(message, "f has no tensor `x` of f32 in the shape [3, 2]; it has f32 in the shape [2, 3]");
        let message = file.take_u8(Path::new("f"), "nothing", &[1]).unwrap_err().to_string();
        assert!(message.ends_with("it has none"), "{message}");
    }
}
