//! Grey images: PGM by hand (its grammar is a dozen lines), PNG through `png`.

use super::MapError;
use std::io::Cursor;
use std::path::Path;

/// A map of a square kilometre at 0.1 m; more is a mistake.
pub(super) const MOST_PIXELS: usize = 100_000_000;

/// Grey pixels, by row from the top, each from the left.
#[derive(Clone, Debug, PartialEq)]
pub struct Grey {
    /// Pixels in a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// 0 black to 255 white, colours averaged; none where the image is transparent.
    pub pixels: Vec<Option<u8>>,
}

impl Grey {
    /// Reads a PGM or PNG file; its first bytes say which.
    pub fn load(file: &Path) -> Result<Self, MapError> {
        let bytes = std::fs::read(file).map_err(|source| MapError::Unreadable { file: file.into(), source })?;
        Self::from_bytes(&bytes).map_err(|message| MapError::Image { file: file.into(), message })
    }

    /// Reads the bytes of a PGM or PNG file; says what is wrong otherwise.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, String> {
        match bytes {
            [b'P', b'2' | b'5', ..] => from_pgm(bytes),
            [0x89, b'P', b'N', b'G', ..] => from_png(bytes),
            _ => Err(format!(
                "it begins with {:?}, neither PGM nor PNG",
                String::from_utf8_lossy(&bytes[..bytes.len().min(4)])
            )),
        }
    }
}

/// Checks the size of an image.
fn sized(width: usize, height: usize) -> Result<usize, String> {
    match width.checked_mul(height) {
        Some(count) if (1..=MOST_PIXELS).contains(&count) => Ok(count),
        _ => Err(format!("its size is {width} x {height} pixels")),
    }
}

fn from_pgm(bytes: &[u8]) -> Result<Grey, String> {
    let mut rest = &bytes[2..];
    let width = next_number(&mut rest).map_err(|found| format!("width: {found}"))?;
    let height = next_number(&mut rest).map_err(|found| format!("height: {found}"))?;
    let white = next_number(&mut rest).map_err(|found| format!("largest grey: {found}"))?;
    let count = sized(width, height)?;
    if !(1..=65_535).contains(&white) {
        return Err(format!("largest grey = {white}, not in 1..=65535"));
    }
    let scaled = |value: usize| Some((value.min(white) * 255 / white) as u8);
    let pixels: Vec<Option<u8>> = if bytes[1] == b'2' {
        let mut value = |pixel: usize| next_number(&mut rest).map_err(|found| format!("pixel {pixel}: {found}"));
        (0..count).map(|pixel| value(pixel).map(scaled)).collect::<Result<_, _>>()?
    } else {
        // A single white space ends the header.
        let data = rest.get(1..).unwrap_or_default();
        let wide = if white < 256 { 1 } else { 2 };
        if data.len() < count * wide {
            return Err(format!("it has {} bytes of pixels, {width} x {height} need {}", data.len(), count * wide));
        }
        let value = |bytes: &[u8]| bytes.iter().fold(0, |value, byte| value * 256 + usize::from(*byte));
        data.chunks_exact(wide).take(count).map(|bytes| scaled(value(bytes))).collect()
    };
    Ok(Grey { width, height, pixels })
}

/// The next number of a PGM header, past white space and comments; what stands there instead otherwise.
fn next_number(rest: &mut &[u8]) -> Result<usize, String> {
    while let Some((&byte, after)) = rest.split_first() {
        if byte == b'#' {
            let line = rest.iter().position(|byte| *byte == b'\n').unwrap_or(rest.len());
            *rest = &rest[line..];
        } else if byte.is_ascii_whitespace() {
            *rest = after;
        } else {
            break;
        }
    }
    let digits = rest.iter().take_while(|byte| byte.is_ascii_digit()).count();
    let (number, after) = rest.split_at(digits);
    let Some(number) = std::str::from_utf8(number).ok().and_then(|digits| digits.parse().ok()) else {
        return Err(match rest.len() {
            0 => "the file ends there".into(),
            long => format!("found {:?}, not a number", String::from_utf8_lossy(&rest[..long.min(8)])),
        });
    };
    *rest = after;
    Ok(number)
}

fn from_png(bytes: &[u8]) -> Result<Grey, String> {
    let mut decoder = png::Decoder::new(Cursor::new(bytes));
    decoder.set_transformations(png::Transformations::normalize_to_color8());
    let mut reader = decoder.read_info().map_err(|error| error.to_string())?;
    let (width, height) = (reader.info().width as usize, reader.info().height as usize);
    sized(width, height)?;
    let size = reader.output_buffer_size().ok_or("it is too large")?;
    let mut data = vec![0; size];
    reader.next_frame(&mut data).map_err(|error| error.to_string())?;
    let (colour, _) = reader.output_color_type();
    let channels = colour.samples();
    let alpha = matches!(colour, png::ColorType::GrayscaleAlpha | png::ColorType::Rgba);
    let colours = channels - usize::from(alpha);
    let grey = |pixel: &[u8]| {
        let mean = pixel[..colours].iter().map(|value| usize::from(*value)).sum::<usize>() / colours;
        (!alpha || pixel[colours] == 255).then_some(mean as u8)
    };
    Ok(Grey { width, height, pixels: data.chunks_exact(channels).take(width * height).map(grey).collect() })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn message(bytes: &[u8]) -> String {
        Grey::from_bytes(bytes).unwrap_err()
    }

    fn png_of(colour: png::ColorType, data: &[u8]) -> Vec<u8> {
        let mut bytes = Vec::new();
        let mut encoder = png::Encoder::new(&mut bytes, 2, 1);
        encoder.set_color(colour);
        encoder.set_depth(png::BitDepth::Eight);
        encoder.write_header().unwrap().write_image_data(data).unwrap();
        bytes
    }

    #[test]
    fn text_and_binary_pgm_give_the_same_pixels() {
        let text = Grey::from_bytes(b"P2\n# made by hand\n3 2\n255\n0 205 254\n1 2 3\n").unwrap();
        let binary = Grey::from_bytes(&[b"P5 3 2 255\n".as_slice(), &[0, 205, 254, 1, 2, 3]].concat()).unwrap();
        assert_eq!(text, binary);
        assert_eq!((text.width, text.height, text.pixels[2]), (3, 2, Some(254)));
        let wide = Grey::from_bytes(&[b"P5 1 1 65535\n".as_slice(), &[0xff, 0xff]].concat()).unwrap();
        assert_eq!(wide.pixels, [Some(255)]);
    }

    #[test]
    fn png_is_read_grey_coloured_and_transparent() {
        let grey = Grey::from_bytes(&png_of(png::ColorType::Grayscale, &[7, 254])).unwrap();
        assert_eq!(grey.pixels, [Some(7), Some(254)]);
        let colour = Grey::from_bytes(&png_of(png::ColorType::Rgb, &[0, 30, 60, 255, 255, 255])).unwrap();
        assert_eq!(colour.pixels, [Some(30), Some(255)]);
        let through = Grey::from_bytes(&png_of(png::ColorType::GrayscaleAlpha, &[9, 255, 9, 0])).unwrap();
        assert_eq!(through.pixels, [Some(9), None]);
    }

    #[test]
    fn images_that_cannot_be_read_say_where() {
        assert!(message(b"GIF89a").contains("neither PGM nor PNG"));
        assert!(message(b"P2\n3 x 255").contains("height: found \"x 255\""));
        assert!(message(b"P2\n2 1 255\n0").contains("pixel 1: the file ends there"));
        assert!(message(b"P5 2 2 255\nab").contains("2 bytes of pixels, 2 x 2 need 4"));
        assert!(message(b"P5 0 2 255\nab").contains("0 x 2"));
        assert!(message(b"P5 1 1 0\na").contains("largest grey = 0"));
        assert!(!message(&png_of(png::ColorType::Grayscale, &[7, 254])[..40]).is_empty());
    }
}
