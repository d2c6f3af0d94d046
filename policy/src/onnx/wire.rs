//! The protobuf wire format: a reader that borrows, and a writer.
//!
//! A message is a list of (field number, value); a value is a varint, 4 or 8 fixed bytes or a block
//! of bytes with its length in front. The reader allocates nothing and never leaves its slice.

/// Why bytes are not a protobuf message.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum WireError {
    /// A value reaches beyond the end of the message.
    #[error("a value at byte {0} of a message reaches beyond its end")]
    Truncated(usize),
    /// A varint of more than ten bytes.
    #[error("a number at byte {0} of a message is longer than ten bytes")]
    LongVarint(usize),
    /// Field number 0 or a wire type that ONNX does not use.
    #[error("byte {at} of a message starts field {field} with wire type {wire_type}, which ONNX does not use")]
    UnknownTag {
        /// Offset in the message.
        at: usize,
        /// Field number.
        field: u64,
        /// Wire type, 0..=7.
        wire_type: u8,
    },
}

/// One value of a message.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Value<'a> {
    /// An integer, enum or bool.
    Varint(u64),
    /// A float or fixed32.
    Fixed32([u8; 4]),
    /// A double or fixed64.
    Fixed64([u8; 8]),
    /// A string, bytes, a message or a packed list.
    Bytes(&'a [u8]),
}

impl<'a> Value<'a> {
    /// The number, if this is one.
    pub fn varint(self) -> Option<u64> {
        if let Value::Varint(number) = self { Some(number) } else { None }
    }

    /// The block, if this is one.
    pub fn bytes(self) -> Option<&'a [u8]> {
        if let Value::Bytes(bytes) = self { Some(bytes) } else { None }
    }
}

/// Reads the fields of one message in order.
#[derive(Clone, Debug)]
pub struct Fields<'a> {
    bytes: &'a [u8],
    at: usize,
}

impl<'a> Fields<'a> {
    /// The fields of the message in `bytes`.
    pub fn new(bytes: &'a [u8]) -> Self {
        Self { bytes, at: 0 }
    }

    fn varint(&mut self) -> Result<u64, WireError> {
        let start = self.at;
        let mut number = 0u64;
        for shift in 0..10 {
            let byte = *self.bytes.get(self.at).ok_or(WireError::Truncated(start))?;
            self.at += 1;
            number |= u64::from(byte & 0x7f) << (7 * shift);
            if byte & 0x80 == 0 {
                return Ok(number);
            }
        }
        Err(WireError::LongVarint(start))
    }

    fn take(&mut self, length: u64, start: usize) -> Result<&'a [u8], WireError> {
        let end = usize::try_from(length).ok().and_then(|length| self.at.checked_add(length));
        let end = end.filter(|&end| end <= self.bytes.len()).ok_or(WireError::Truncated(start))?;
        let block = &self.bytes[self.at..end];
        self.at = end;
        Ok(block)
    }

    fn fixed<const N: usize>(&mut self, start: usize) -> Result<[u8; N], WireError> {
        let block = self.take(N as u64, start)?;
        block.try_into().map_err(|_| WireError::Truncated(start))
    }

    fn field(&mut self) -> Result<(u64, Value<'a>), WireError> {
        let start = self.at;
        let tag = self.varint()?;
        let (field, wire_type) = (tag >> 3, (tag & 7) as u8);
        let value = match wire_type {
            _ if field == 0 => return Err(WireError::UnknownTag { at: start, field, wire_type }),
            0 => Value::Varint(self.varint()?),
            1 => Value::Fixed64(self.fixed(start)?),
            2 => {
                let length = self.varint()?;
                Value::Bytes(self.take(length, start)?)
            }
            5 => Value::Fixed32(self.fixed(start)?),
            _ => return Err(WireError::UnknownTag { at: start, field, wire_type }),
        };
        Ok((field, value))
    }
}

impl<'a> Iterator for Fields<'a> {
    type Item = Result<(u64, Value<'a>), WireError>;

    fn next(&mut self) -> Option<Self::Item> {
        if self.at >= self.bytes.len() {
            return None;
        }
        let field = self.field();
        if field.is_err() {
            self.at = self.bytes.len(); // Nothing after a broken field can be trusted.
        }
        Some(field)
    }
}

/// The varints of a packed list.
pub fn packed(bytes: &[u8]) -> impl Iterator<Item = Result<u64, WireError>> + '_ {
    let mut list = Fields::new(bytes);
    std::iter::from_fn(move || {
        if list.at >= list.bytes.len() {
            return None;
        }
        let number = list.varint();
        if number.is_err() {
            list.at = list.bytes.len();
        }
        Some(number)
    })
}

/// Writes one message.
#[derive(Clone, Debug, Default)]
pub struct Message(Vec<u8>);

impl Message {
    /// An empty message.
    pub fn new() -> Self {
        Self::default()
    }

    fn raw_varint(&mut self, mut number: u64) {
        while number >= 0x80 {
            self.0.push(number as u8 | 0x80);
            number >>= 7;
        }
        self.0.push(number as u8);
    }

    /// Appends an integer field.
    pub fn varint(mut self, field: u64, number: u64) -> Self {
        self.raw_varint(field << 3);
        self.raw_varint(number);
        self
    }

    /// Appends a float field.
    pub fn float(mut self, field: u64, number: f32) -> Self {
        self.raw_varint(field << 3 | 5);
        self.0.extend_from_slice(&number.to_le_bytes());
        self
    }

    /// Appends a double field.
    pub fn double(mut self, field: u64, number: f64) -> Self {
        self.raw_varint(field << 3 | 1);
        self.0.extend_from_slice(&number.to_le_bytes());
        self
    }

    /// Appends bytes or a string.
    pub fn bytes(mut self, field: u64, bytes: impl AsRef<[u8]>) -> Self {
        let bytes = bytes.as_ref();
        self.raw_varint(field << 3 | 2);
        self.raw_varint(bytes.len() as u64);
        self.0.extend_from_slice(bytes);
        self
    }

    /// Appends a message.
    pub fn message(self, field: u64, message: Message) -> Self {
        self.bytes(field, message.0)
    }

    /// The bytes of the message.
    pub fn finish(self) -> Vec<u8> {
        self.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn what_is_written_is_read() {
        let inner = Message::new().bytes(1, "name");
        let bytes = Message::new().varint(3, 300).float(2, 1.5).message(7, inner).double(8, -2.5).finish();
        let fields: Vec<_> = Fields::new(&bytes).collect::<Result<_, _>>().unwrap();
        assert_eq!(fields[0], (3, Value::Varint(300)));
        assert_eq!(fields[1], (2, Value::Fixed32(1.5f32.to_le_bytes())));
        assert_eq!(fields[2], (7, Value::Bytes(b"\x0a\x04name")));
        assert_eq!(fields[3], (8, Value::Fixed64((-2.5f64).to_le_bytes())));
    }

    #[test]
    fn a_length_beyond_the_end_is_refused() {
        let far = [0x0a, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0x01];
        assert_eq!(Fields::new(&far).collect::<Result<Vec<_>, _>>(), Err(WireError::Truncated(0)));
        assert_eq!(Fields::new(&[0x80; 11]).collect::<Result<Vec<_>, _>>(), Err(WireError::LongVarint(0)));
        assert!(Fields::new(&[0x03]).next().unwrap().is_err());
    }

    proptest! {
        #[test]
        fn any_number_survives(number in any::<u64>(), field in 1u64..1000) {
            let bytes = Message::new().varint(field, number).finish();
            prop_assert_eq!(Fields::new(&bytes).next(), Some(Ok((field, Value::Varint(number)))));
            prop_assert_eq!(packed(&bytes).count(), 2);
        }

        #[test]
        fn any_bytes_end_in_fields_or_one_error(bytes in proptest::collection::vec(any::<u8>(), 0..200)) {
            let fields: Vec<_> = Fields::new(&bytes).collect();
            prop_assert!(fields.len() <= bytes.len());
            prop_assert!(fields.iter().rev().skip(1).all(Result::is_ok));
        }
    }
}
