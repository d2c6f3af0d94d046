//! One tensor of a model: its name, type and shape, and whether all its numbers are finite.

use super::OnnxError;
use super::proto::TensorProto;
use super::read::text;
use std::fmt;

/// ONNX element type, by its number in the format.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ElementType(pub i32);

impl ElementType {
    /// 32-bit floats: the only type that enters or leaves an actor.
    pub const FLOAT: ElementType = ElementType(1);
    const FLOAT16: ElementType = ElementType(10);
    const DOUBLE: ElementType = ElementType(11);
    const BFLOAT16: ElementType = ElementType(16);

    /// Bytes per element; `None` for types of no fixed size and for unknown ones.
    pub fn size(self) -> Option<u64> {
        match self.0 {
            2 | 3 | 9 => Some(1),
            4 | 5 | 10 | 16 => Some(2),
            1 | 6 | 12 => Some(4),
            7 | 11 | 13 => Some(8),
            _ => None,
        }
    }
}

impl fmt::Display for ElementType {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let name = match self.0 {
            1 => "float32",
            2 => "uint8",
            3 => "int8",
            4 => "uint16",
            5 => "int16",
            6 => "int32",
            7 => "int64",
            8 => "string",
            9 => "bool",
            10 => "float16",
            11 => "float64",
            12 => "uint32",
            13 => "uint64",
            16 => "bfloat16",
            number => return write!(f, "type {number}"),
        };
        f.pad(name)
    }
}

/// What we know of a tensor stored in the file.
#[derive(Clone, Debug, PartialEq)]
pub struct Tensor {
    /// Its name.
    pub name: String,
    /// Its element type.
    pub element: ElementType,
    /// Its shape.
    pub dims: Vec<i64>,
    /// Position of the first NaN or infinite element.
    pub first_not_finite: Option<usize>,
    /// Whether its numbers lie in another file.
    pub external: bool,
}

/// Largest rank of a tensor; none of ours exceeds 2.
const MAX_RANK: usize = 8;

impl Tensor {
    /// What we look at in `stored`.
    pub(super) fn read(stored: TensorProto) -> Result<Self, OnnxError> {
        let name = text(stored.name);
        if stored.dims.len() > MAX_RANK {
            return Err(OnnxError::Rank { name, most: MAX_RANK });
        }
        let element = ElementType(stored.data_type.unwrap_or_default());
        let raw = stored.raw_data.as_deref();
        let (floats, doubles) = (&stored.float_data, &stored.double_data);
        let in_lists = floats.iter().map(|float| float.is_finite());
        let mut in_lists = in_lists.chain(doubles.iter().map(|double| double.is_finite()));
        let tensor = Tensor {
            name,
            element,
            dims: stored.dims,
            first_not_finite: match raw {
                Some(raw) => first_not_finite(element, raw),
                None => in_lists.position(|finite| !finite),
            },
            external: !stored.external_data.is_empty() || stored.data_location == Some(1),
        };
        let integers = stored.int32_data.len() + stored.int64_data.len() + stored.uint64_data.len();
        tensor.check_length(raw, floats.len() + doubles.len() + integers + stored.string_data.len())?;
        Ok(tensor)
    }

    /// Elements that `dims` ask for; `None` when negative or beyond 2^40.
    pub fn elements(&self) -> Option<u64> {
        self.dims.iter().try_fold(1u64, |product, &dim| {
            product.checked_mul(u64::try_from(dim).ok()?).filter(|&product| product < 1 << 40)
        })
    }

    /// A back-end may trust the shape and read beyond the block; so the lengths are compared here.
    fn check_length(&self, raw: Option<&[u8]>, stored: usize) -> Result<(), OnnxError> {
        if self.external {
            return Ok(());
        }
        let fits = match (self.elements(), raw, self.element.size()) {
            (Some(elements), Some(raw), Some(size)) => elements * size == raw.len() as u64,
            (Some(elements), None, _) => elements == stored as u64,
            _ => false,
        };
        if fits {
            return Ok(());
        }
        let has = raw.map_or(stored, <[u8]>::len);
        let unit = if raw.is_some() { "bytes" } else { "elements" };
        Err(OnnxError::TensorLength {
            name: self.name.clone(),
            dims: self.dims.clone(),
            element: self.element,
            has,
            unit,
        })
    }
}

fn first_not_finite(element: ElementType, raw: &[u8]) -> Option<usize> {
    match element {
        ElementType::FLOAT => raw.as_chunks::<4>().0.iter().position(|four| !f32::from_le_bytes(*four).is_finite()),
        ElementType::DOUBLE => raw.as_chunks::<8>().0.iter().position(|eight| !f64::from_le_bytes(*eight).is_finite()),
        // All exponent bits set: NaN or infinity.
        ElementType::FLOAT16 => raw.as_chunks::<2>().0.iter().position(|two| two[1] & 0x7c == 0x7c),
        ElementType::BFLOAT16 => {
            raw.as_chunks::<2>().0.iter().position(|two| u16::from_le_bytes(*two) & 0x7f80 == 0x7f80)
        }
        _ => None,
    }
}
