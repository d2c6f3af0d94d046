//! An error as one sentence.

use std::error::Error;

/// The message of `error` and of what caused it; a cause that the message already contains is left out.
pub fn sentence(error: &dyn Error) -> String {
    let mut text = error.to_string();
    let mut cause = error.source();
    while let Some(error) = cause {
        let message = error.to_string();
        if !text.contains(&message) {
            text += &format!(": {message}");
        }
        cause = error.source();
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[derive(Debug, thiserror::Error)]
    #[error("outer")]
    struct Outer(#[source] std::io::Error);

    #[derive(Debug, thiserror::Error)]
    #[error("outer: {0}")]
    struct Repeating(#[source] std::io::Error);

    #[test]
    fn causes_are_told_once() {
        assert_eq!(sentence(&Outer(std::io::Error::other("inner"))), "outer: inner");
        assert_eq!(sentence(&Repeating(std::io::Error::other("inner"))), "outer: inner");
    }
}
