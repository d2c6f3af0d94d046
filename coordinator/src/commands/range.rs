//! Lists of whole numbers as users write them: `1..49`, `5,10,20`, `7`.

use std::str::FromStr;

/// Numbers in the order written; `A..B` includes both ends.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Numbers(pub Vec<u64>);

/// Not a list of numbers.
#[derive(Debug, PartialEq, Eq, thiserror::Error)]
#[error("`{0}` is not a list of whole numbers; write 1..49 (both ends included), 5,10,20 or 7; at most {MOST} numbers")]
pub struct NumbersError(String);

const MOST: u64 = 100_000;

impl FromStr for Numbers {
    type Err = NumbersError;

    fn from_str(text: &str) -> Result<Self, NumbersError> {
        let wrong = || NumbersError(text.into());
        let number = |text: &str| text.trim().parse::<u64>().map_err(|_| wrong());
        if let Some((low, high)) = text.split_once("..") {
            let (low, high) = (number(low)?, number(high.trim_start_matches('='))?);
            return if low <= high && high - low < MOST { Ok(Self((low..=high).collect())) } else { Err(wrong()) };
        }
        text.split(',').map(number).collect::<Result<_, _>>().map(Self)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_include_both_ends() {
        assert_eq!("1..4".parse(), Ok(Numbers(vec![1, 2, 3, 4])));
        assert_eq!("0..=2".parse(), Ok(Numbers(vec![0, 1, 2])));
        assert_eq!("5, 10,20".parse(), Ok(Numbers(vec![5, 10, 20])));
        assert_eq!("7".parse(), Ok(Numbers(vec![7])));
    }

    #[test]
    fn anything_else_is_answered_with_examples() {
        for text in ["", "4..1", "a", "1..", "-1", "0..99999999999", "1,,2"] {
            let message = text.parse::<Numbers>().unwrap_err().to_string();
            assert!(message.contains("1..49"), "{message}");
        }
    }
}
