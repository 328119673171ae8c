//! Writing on pictures.

use super::{Image, color::Rgb};
use ab_glyph::{Font, FontRef, PxScale, ScaleFont, point};

/// Roboto, reduced to Latin and Greek; see the folder's README.
static FONT: &[u8] = include_bytes!("font/Roboto-Latin.ttf");

/// A size and colour of letters.
pub(super) struct Pen {
    font: FontRef<'static>,
    scale: PxScale,
    color: Rgb,
}

impl Pen {
    /// A pen that writes letters of a height, \[pixels\].
    pub fn new(height: f32, color: Rgb) -> Self {
        let font = FontRef::try_from_slice(FONT).expect("the embedded font is valid, as a test checks");
        Self { font, scale: PxScale::from(height), color }
    }

    /// Width of a text, \[pixels\].
    pub fn width(&self, text: &str) -> f32 {
        self.place(text).1
    }

    /// Writes a text that begins at `x` and is centred about `y`.
    pub fn write(&self, image: &mut Image, x: f32, y: f32, text: &str) {
        let font = self.font.as_scaled(self.scale);
        // Capitals and digits are about 0.7 of the ascent high.
        let baseline = y + 0.36 * font.ascent();
        for (glyph, offset) in self.place(text).0 {
            let glyph = glyph.with_scale_and_position(self.scale, point(x + offset, baseline));
            let Some(outline) = self.font.outline_glyph(glyph) else { continue };
            let corner = outline.px_bounds().min;
            outline.draw(|column, row, coverage| {
                image.blend(
                    corner.x as i64 + i64::from(column),
                    corner.y as i64 + i64::from(row),
                    self.color,
                    coverage,
                );
            });
        }
    }

    /// The letters and where each begins, and the width of all.
    fn place(&self, text: &str) -> (Vec<(ab_glyph::GlyphId, f32)>, f32) {
        let font = self.font.as_scaled(self.scale);
        let (mut x, mut before, mut glyphs) = (0.0, None, Vec::new());
        for letter in text.chars() {
            let glyph = font.glyph_id(letter);
            x += before.map_or(0.0, |before| font.kern(before, glyph));
            glyphs.push((glyph, x));
            x += font.h_advance(glyph);
            before = Some(glyph);
        }
        (glyphs, x)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_font_has_every_letter_that_legends_use() {
        let pen = Pen::new(20.0, [0; 3]);
        let letters = ('!'..='~').chain("−–×√²³⁻¹₀σεμτåé".chars());
        let missing: String = letters.filter(|&letter| pen.font.glyph_id(letter).0 == 0).collect();
        assert_eq!(missing, "");
    }

    #[test]
    fn text_is_written_where_it_is_told() {
        let mut image = Image { width: 80, height: 40, pixels: vec![[255; 4]; 80 * 40] };
        let pen = Pen::new(20.0, [0; 3]);
        let width = pen.width("HH");
        pen.write(&mut image, 30.0, 20.0, "HH");
        let dark = |x: u32, y: u32| image.pixel(x, y)[0] < 128;
        let columns: Vec<u32> = (0..80).filter(|&x| (0..40).any(|y| dark(x, y))).collect();
        let rows: Vec<u32> = (0..40).filter(|&y| (0..80).any(|x| dark(x, y))).collect();
        assert!(columns[0] >= 30 && columns[columns.len() - 1] as f32 <= 30.0 + width, "{columns:?}, {width}");
        let middle = 0.5 * (rows[0] + rows[rows.len() - 1] + 1) as f32;
        assert!((middle - 20.0).abs() <= 1.0, "{rows:?}");
    }
}
