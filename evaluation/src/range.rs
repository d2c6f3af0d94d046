//! Lists of whole numbers as users write them: `1..49`, `5,10,20`, `5,10,...,49`, `7`.

use std::str::FromStr;

/// Numbers in the order written; `A..B` includes both ends, `A,B,...,Z` goes on by the last step before the dots
/// and ends with Z: `5,10,...,49` is 5, 10, 15 and so on, 45, 49.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Numbers(pub Vec<u64>);

/// Not a list of numbers.
#[derive(Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "`{0}` is not a list of whole numbers; write 1..49 (both ends included), 5,10,20, 5,10,...,49 or 7; at most {MOST} numbers"
)]
pub struct NumbersError(String);

const MOST: u64 = 100_000;

impl FromStr for Numbers {
    type Err = NumbersError;

    fn from_str(text: &str) -> Result<Self, NumbersError> {
        let wrong = || NumbersError(text.into());
        let number = |text: &str| text.trim().parse::<u64>().map_err(|_| wrong());
        let mut numbers: Vec<u64> = Vec::new();
        let mut items = text.split(',').map(str::trim);
        while let Some(item) = items.next() {
            if item == "..." {
                let last = number(items.next().unwrap_or_default())?;
                let next = series(&numbers, last).ok_or_else(wrong)?;
                numbers.extend(next);
            } else if let Some((low, high)) = item.split_once("..") {
                let (low, high) = (number(low)?, number(high.trim_start_matches('='))?);
                let next = (low <= high && high - low < MOST).then_some(low..=high).ok_or_else(wrong)?;
                numbers.extend(next);
            } else {
                numbers.push(number(item)?);
            }
        }
        if numbers.len() as u64 <= MOST { Ok(Self(numbers)) } else { Err(wrong()) }
    }
}

/// What the dots between the last two of `before` and `last` stand for, `last` included. `None`: that is no
/// rising series of bounded length.
fn series(before: &[u64], last: u64) -> Option<impl Iterator<Item = u64> + use<>> {
    let [.., first, second] = *before else { return None };
    let step = second.checked_sub(first).filter(|&step| step > 0)?;
    let bounded = last > second && (last - second) / step < MOST;
    bounded.then(|| (1..).map(move |n| second + n * step).take_while(move |&next| next < last).chain([last]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dots_repeat_the_step_and_end_with_the_last_number() {
        assert_eq!("5,10,...,25".parse(), Ok(Numbers(vec![5, 10, 15, 20, 25])));
        let bars = [5, 10, 15, 20, 25, 30, 35, 40, 45, 49];
        assert_eq!("5,10,...,49".parse(), Ok(Numbers(bars.to_vec())));
        assert_eq!("1, 2, 4,...,9".parse(), Ok(Numbers(vec![1, 2, 4, 6, 8, 9])));
        assert_eq!("7,1..3,...,5,20".parse(), Ok(Numbers(vec![7, 1, 2, 3, 4, 5, 20])));
    }

    #[test]
    fn ranges_include_both_ends() {
        assert_eq!("1..4".parse(), Ok(Numbers(vec![1, 2, 3, 4])));
        assert_eq!("0..=2".parse(), Ok(Numbers(vec![0, 1, 2])));
        assert_eq!("5, 10,20".parse(), Ok(Numbers(vec![5, 10, 20])));
        assert_eq!("7".parse(), Ok(Numbers(vec![7])));
    }

    #[test]
    fn anything_else_is_answered_with_examples() {
        for text in [
            "",
            "4..1",
            "a",
            "1..",
            "-1",
            "0..99999999999",
            "1,,2",
            "5,...,49",
            "5,10,...",
            "10,5,...,1",
            "5,10,...,10",
            "0,1,...,99999999999",
        ] {
            let message = text.parse::<Numbers>().unwrap_err().to_string();
            assert!(message.contains("1..49"), "{message}");
        }
    }
}
