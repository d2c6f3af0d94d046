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
