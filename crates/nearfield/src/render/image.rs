//! Pixels, and PNG files of them.

use super::{Error, Result, color::Rgb};
use crate::io::atomic_write;
use std::{io, path::Path};

/// A picture.
#[derive(Clone, PartialEq, Eq)]
pub struct Image {
    pub(super) width: u32,
    pub(super) height: u32,
    /// Red, green, blue, opacity of each pixel, by rows from the top; sRGB, colours not multiplied by opacity.
    pub(super) pixels: Vec<[u8; 4]>,
}

impl Image {
    /// Width and height, \[pixels\].
    pub fn size(&self) -> [u32; 2] {
        [self.width, self.height]
    }

    /// Red, green, blue and opacity of a pixel, counted from the upper left corner.
    ///
    /// # Panics
    /// Outside the picture.
    pub fn pixel(&self, x: u32, y: u32) -> [u8; 4] {
        assert!(x < self.width && y < self.height, "pixel {x}, {y} of {} x {}", self.width, self.height);
        self.pixels[(y * self.width + x) as usize]
    }

    /// Lays a colour over a pixel, in part; nothing happens outside the picture.
    pub(super) fn blend(&mut self, x: i64, y: i64, color: Rgb, coverage: f32) {
        if x < 0 || y < 0 || x >= i64::from(self.width) || y >= i64::from(self.height) {
            return;
        }
        let pixel = &mut self.pixels[y as usize * self.width as usize + x as usize];
        let under = f32::from(pixel[3]) / 255.0 * (1.0 - coverage);
        let opacity = coverage + under;
        if opacity > 0.0 {
            for (channel, color) in pixel.iter_mut().zip(color) {
                *channel = ((coverage * f32::from(color) + under * f32::from(*channel)) / opacity).round() as u8;
            }
            pixel[3] = (255.0 * opacity).round() as u8;
        }
    }

    /// Writes a PNG file, whole or not at all. Opaque pictures have no opacity channel.
    ///
    /// # Errors
    /// [`Error::Extension`], or [`crate::io::IoError::Write`].
    pub fn write_png(&self, path: impl AsRef<Path>) -> crate::Result<()> {
        let path = path.as_ref();
        check_png(path)?;
        let bytes = self.encode().map_err(|source| crate::io::IoError::Write { path: path.to_owned(), source })?;
        Ok(atomic_write(path, |out| out.write_all(&bytes))?)
    }

    fn encode(&self) -> io::Result<Vec<u8>> {
        let mut bytes = Vec::new();
        let mut encoder = png::Encoder::new(&mut bytes, self.width, self.height);
        encoder.set_depth(png::BitDepth::Eight);
        encoder.set_compression(png::Compression::High);
        encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
        let opaque = self.pixels.iter().all(|pixel| pixel[3] == u8::MAX);
        let data: Vec<u8> = if opaque {
            encoder.set_color(png::ColorType::Rgb);
            self.pixels.iter().flat_map(|&[red, green, blue, _]| [red, green, blue]).collect()
        } else {
            encoder.set_color(png::ColorType::Rgba);
            self.pixels.as_flattened().to_vec()
        };
        encoder.write_header()?.write_image_data(&data)?;
        Ok(bytes)
    }
}

/// Fails for a file name that does not say PNG.
pub fn check_png(path: &Path) -> Result<()> {
    let png = path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("png"));
    if png { Ok(()) } else { Err(Error::Extension(path.to_owned())) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Cursor;

    fn decoded(image: &Image) -> (png::ColorType, [u32; 2], Vec<u8>) {
        let mut reader = png::Decoder::new(Cursor::new(image.encode().unwrap())).read_info().unwrap();
        let mut data = vec![0; reader.output_buffer_size().unwrap()];
        let info = reader.next_frame(&mut data).unwrap();
        (info.color_type, [info.width, info.height], data)
    }

    #[test]
    fn a_png_holds_the_pixels_and_opacity_only_where_there_is_some() {
        let pixels = vec![[1, 2, 3, 255], [4, 5, 6, 255], [7, 8, 9, 255], [0, 0, 0, 255], [9, 9, 9, 255], [8; 4]];
        let mut image = Image { width: 3, height: 2, pixels };
        assert_eq!(decoded(&image), (png::ColorType::Rgba, [3, 2], image.pixels.as_flattened().to_vec()));
        image.pixels[5] = [8, 8, 8, 255];
        let (color, _, data) = decoded(&image);
        assert_eq!((color, &data[..6]), (png::ColorType::Rgb, &[1, 2, 3, 4, 5, 6][..]));
    }

    #[test]
    fn other_extensions_than_png_are_refused() {
        for name in ["picture.jpg", "picture", "png"] {
            assert!(check_png(Path::new(name)).is_err(), "{name}");
        }
        assert!(check_png(Path::new("a.PNG")).is_ok());
    }
}
