//! Bytes as text. The only file that imports `data_encoding`.

use data_encoding::{BASE64, HEXLOWER};

/// Lower-case hexadecimal digits, two per byte.
pub fn hex(bytes: &[u8]) -> String {
    HEXLOWER.encode(bytes)
}

/// The bytes of a SHA-256 written as 64 lower-case hexadecimal digits; `None` for any other text.
pub fn sha256_bytes(digits: &str) -> Option<[u8; 32]> {
    HEXLOWER.decode(digits.as_bytes()).ok()?.try_into().ok()
}

/// For `#[serde(with)]`: a SHA-256 as its digits, or nothing.
pub mod sha256_digits {
    use serde::de::{Deserialize, Deserializer, Error};
    use serde::ser::{Serialize, Serializer};

    /// Writes the digits.
    pub fn serialize<S: Serializer>(digest: &Option<[u8; 32]>, serializer: S) -> Result<S::Ok, S::Error> {
        digest.as_ref().map(|digest| super::hex(digest)).serialize(serializer)
    }

    /// Reads the digits.
    pub fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<[u8; 32]>, D::Error> {
        let Some(digits) = Option::<String>::deserialize(deserializer)? else { return Ok(None) };
        let digest = super::sha256_bytes(&digits);
        digest.map(Some).ok_or_else(|| D::Error::custom("a SHA-256 has 64 lower-case hexadecimal digits"))
    }
}

/// Base64 with padding (RFC 4648).
pub fn base64(bytes: &[u8]) -> String {
    BASE64.encode(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn digits_become_the_bytes_they_came_from_and_nothing_else_does() {
        let bytes: [u8; 32] = std::array::from_fn(|index| (index * 7) as u8);
        assert_eq!(sha256_bytes(&hex(&bytes)), Some(bytes));
        for wrong in ["", "00ff", &"zz".repeat(32), &"00FF".repeat(16), &"0".repeat(65)] {
            assert_eq!(sha256_bytes(wrong), None, "{wrong}");
        }
    }
}
