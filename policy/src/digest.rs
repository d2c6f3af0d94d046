//! SHA-256 of a model file: the identity of what acted.

use crate::encoding::hex;
use sha2::{Digest, Sha256};

/// Lower-case hexadecimal SHA-256 of `bytes`, 64 characters.
pub fn sha256(bytes: &[u8]) -> String {
    hex(&sha256_of(bytes))
}

/// SHA-256 of `bytes`.
pub fn sha256_of(bytes: &[u8]) -> [u8; 32] {
    Sha256::digest(bytes).into()
}

#[cfg(test)]
mod tests {
    #[test]
    fn the_digest_of_abc_is_that_of_the_standard() {
        let abc = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";
        assert_eq!(super::sha256(b"abc"), abc);
    }
}
