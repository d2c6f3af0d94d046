//! The only writer to standard output. Whoever reads it may stop reading (`| head -1`): what follows is then
//! dropped quietly, and the command goes on with its work and its exit code.

use std::fmt::Display;
use std::io::{self, ErrorKind, Write};

/// Standard output took nothing more, and not because its reader had enough.
#[derive(Debug, thiserror::Error)]
#[error("cannot write to standard output: {0}; send it to a place with room")]
pub struct PrintError(#[from] io::Error);

/// Prints `text` as it is.
pub fn text(text: impl Display) -> Result<(), PrintError> {
    write_to(&mut io::stdout().lock(), &text)
}

/// Prints `text` and ends the line.
pub fn line(text: impl Display) -> Result<(), PrintError> {
    self::text(format_args!("{text}\n"))
}

fn write_to(out: &mut impl Write, text: &impl Display) -> Result<(), PrintError> {
    match write!(out, "{text}").and_then(|()| out.flush()) {
        Err(error) if error.kind() == ErrorKind::BrokenPipe => Ok(()),
        written => Ok(written?),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    struct Refusing(ErrorKind);

    impl Write for Refusing {
        fn write(&mut self, _: &[u8]) -> io::Result<usize> {
            Err(self.0.into())
        }

        fn flush(&mut self) -> io::Result<()> {
            Ok(())
        }
    }

    #[test]
    fn a_reader_that_has_enough_is_no_error_and_a_full_disk_is_one() {
        assert!(write_to(&mut Refusing(ErrorKind::BrokenPipe), &"x").is_ok());
        let message = write_to(&mut Refusing(ErrorKind::StorageFull), &"x").unwrap_err().to_string();
        assert!(message.starts_with("cannot write to standard output"), "{message}");
    }

    #[test]
    fn text_comes_out_as_it_went_in() {
        let mut out = Vec::new();
        write_to(&mut out, &"a\nb").unwrap();
        assert_eq!(out, b"a\nb");
    }
}
