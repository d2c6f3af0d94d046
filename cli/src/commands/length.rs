//! Lengths as users write them.

/// A length in metres, 0..=100.
pub fn metres(text: &str) -> Result<f64, String> {
    let metres = text.parse().ok().filter(|metres: &f64| (0.0..=100.0).contains(metres));
    metres.ok_or_else(|| format!("`{text}` is no length; write metres in 0..=100, for example 0.05"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_length_is_a_number_of_metres() {
        assert_eq!(metres("0.05"), Ok(0.05));
        for text in ["-1", "nan", "far", "101"] {
            assert!(metres(text).unwrap_err().contains("0..=100"), "{text}");
        }
    }
}
