//! The part of protobuf's wire format that our pictures need: varints, doubles, strings, nested messages.
//!
//! Three message types do not justify a code generator; the readers check the result against the
//! published descriptors, and so does a test with an independent decoder.

/// A protobuf message under construction. Fields may come in any order; defaults are left out.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Message(Vec<u8>);

const VARINT: u64 = 0;
const FIXED_64: u64 = 1;
const LENGTH_DELIMITED: u64 = 2;

impl Message {
    /// Field `number` as an integer, enum or bool.
    pub(super) fn integer(mut self, number: u64, value: u64) -> Self {
        if value != 0 {
            self.varint(number << 3 | VARINT);
            self.varint(value);
        }
        self
    }

    /// Field `number` as a double.
    pub(super) fn double(mut self, number: u64, value: f64) -> Self {
        if value.to_bits() != 0 {
            self.varint(number << 3 | FIXED_64);
            self.0.extend_from_slice(&value.to_le_bytes());
        }
        self
    }

    /// Field `number` as a string.
    pub(super) fn text(mut self, number: u64, value: &str) -> Self {
        if !value.is_empty() {
            self.delimited(number, value.as_bytes());
        }
        self
    }

    /// Field `number` as a nested message; call again for the next element of a repeated field.
    pub(super) fn message(mut self, number: u64, value: &Message) -> Self {
        self.delimited(number, &value.0);
        self
    }

    /// One nested message per item.
    pub(super) fn messages(self, number: u64, values: impl IntoIterator<Item = Message>) -> Self {
        values.into_iter().fold(self, |message, value| message.message(number, &value))
    }

    /// The encoded message.
    pub(super) fn into_bytes(self) -> Vec<u8> {
        self.0
    }

    fn delimited(&mut self, number: u64, bytes: &[u8]) {
        self.varint(number << 3 | LENGTH_DELIMITED);
        self.varint(bytes.len() as u64);
        self.0.extend_from_slice(bytes);
    }

    fn varint(&mut self, mut value: u64) {
        while value >= 0x80 {
            self.0.push(value as u8 | 0x80);
            value >>= 7;
        }
        self.0.push(value as u8);
    }
}

/// A field's value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Value<'a> {
    /// An integer, enum or bool.
    Integer(u64),
    /// A double.
    Double(f64),
    /// A string or a nested message.
    Bytes(&'a [u8]),
}

/// The fields of an encoded message with their numbers, in the order written; ends at the first that is
/// cut or of another kind.
pub(super) fn fields(mut rest: &[u8]) -> impl Iterator<Item = (u64, Value<'_>)> {
    std::iter::from_fn(move || {
        let key = take_varint(&mut rest)?;
        let value = match key & 7 {
            VARINT => Value::Integer(take_varint(&mut rest)?),
            FIXED_64 => {
                let (value, after) = rest.split_first_chunk()?;
                rest = after;
                Value::Double(f64::from_le_bytes(*value))
            }
            LENGTH_DELIMITED => {
                let length = usize::try_from(take_varint(&mut rest)?).ok()?;
                let (value, after) = rest.split_at_checked(length)?;
                rest = after;
                Value::Bytes(value)
            }
            _ => return None,
        };
        Some((key >> 3, value))
    })
}

fn take_varint(rest: &mut &[u8]) -> Option<u64> {
    let mut value = 0;
    for shift in (0..64).step_by(7) {
        let (byte, after) = rest.split_first()?;
        *rest = after;
        value |= u64::from(byte & 0x7f) << shift;
        if byte & 0x80 == 0 {
            return Some(value);
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_examples_of_the_encoding_guide_come_out() {
        // protobuf.dev, "Encoding": a = 150; b = "testing"; c = { a = 150 }.
        assert_eq!(Message::default().integer(1, 150).into_bytes(), [0x08, 0x96, 0x01]);
        assert_eq!(Message::default().text(2, "testing").into_bytes(), b"\x12\x07testing");
        let inner = Message::default().integer(1, 150);
        assert_eq!(Message::default().message(3, &inner).into_bytes(), [0x1a, 0x03, 0x08, 0x96, 0x01]);
    }

    #[test]
    fn doubles_are_little_endian_and_zero_is_left_out() {
        assert_eq!(Message::default().double(1, 1.0).into_bytes(), [0x09, 0, 0, 0, 0, 0, 0, 0xf0, 0x3f]);
        assert_eq!(Message::default().double(1, 0.0).into_bytes(), [0u8; 0]);
        assert_eq!(Message::default().double(1, -0.0).into_bytes().len(), 9);
    }
}
