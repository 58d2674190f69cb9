//! PNG files, for pictures to look at.

use crate::error::{Error, ErrorKind, Fault};
use png::{BitDepth, ColorType, Encoder, SrgbRenderingIntent};
use puncta_core::Image;
use std::{fs::File, io::BufWriter, path::Path};

/// Writes an image.
///
/// # Errors
///
/// When the file cannot be written, or the image does not have a color for each pixel.
pub fn write(path: impl AsRef<Path>, image: &Image) -> Result<(), Error> {
    let write = || {
        let file = BufWriter::new(File::create(path.as_ref())?);
        let mut encoder = Encoder::new(file, image.width, image.height);
        encoder.set_color(ColorType::Rgba);
        encoder.set_depth(BitDepth::Eight);
        encoder.set_source_srgb(SrgbRenderingIntent::Perceptual);
        let failed = |error: png::EncodingError| match error {
            png::EncodingError::IoError(error) => ErrorKind::Io(error),
            other => ErrorKind::Decoder(other.to_string()),
        };
        let mut writer = encoder.write_header().map_err(failed)?;
        writer.write_image_data(image.pixels.as_flattened()).map_err(failed)?;
        writer.finish().map_err(failed)?;
        Ok(())
    };
    write().map_err(|fault: Fault| fault.in_file(path.as_ref()))
}
