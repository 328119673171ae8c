//! Figures by plotters, as SVG and PNG.

use super::{
    chart::{Axis, Figure, Panel, Style},
    palette::{GRID, INK, Marker, PAPER, Rgb, SHADE},
    ticks,
};
use crate::{Error, Result};
use plotters::{
    coord::{
        Shift,
        ranged1d::{DefaultFormatting, KeyPointHint, Ranged},
    },
    prelude::*,
    style::{
        FontStyle, register_font,
        text_anchor::{HPos, Pos, VPos},
    },
};
use std::{ops::Range, sync::Once};

/// Height of a row of the legend, \[pixels\].
pub(super) const LEGEND_HEIGHT: u32 = 26;
/// Pixels of a PNG picture for one of the SVG's.
const PNG_SCALE: u32 = 2;
const FONT: &[u8] = include_bytes!("../render/font/Roboto-Latin.ttf");
const FAMILY: &str = "sans-serif";

type Area<'a, DB> = DrawingArea<DB, Shift>;
type Drawn<DB> = Result<(), DrawingAreaErrorKind<<DB as DrawingBackend>::ErrorType>>;

/// The figure as the text of an SVG file.
///
/// # Errors
/// [`Error::Figure`].
pub(super) fn svg(figure: &Figure) -> Result<String> {
    let mut text = String::new();
    let root = SVGBackend::with_string(&mut text, figure.size()).into_drawing_area();
    draw(figure, &root, 1).map_err(|error| failed(figure, &error))?;
    drop(root);
    Ok(text)
}

/// The figure as the content of a PNG file.
///
/// # Errors
/// [`Error::Figure`].
pub(super) fn png(figure: &Figure) -> Result<Vec<u8>> {
    let (width, height) = figure.size();
    let (width, height) = (width * PNG_SCALE, height * PNG_SCALE);
    let mut pixels = vec![0; (width * height * 3) as usize];
    {
        let root = BitMapBackend::with_buffer(&mut pixels, (width, height)).into_drawing_area();
        draw(figure, &root, PNG_SCALE).map_err(|error| failed(figure, &error))?;
    }
    encode(&pixels, width, height).map_err(|error| failed(figure, &error))
}

fn encode(pixels: &[u8], width: u32, height: u32) -> Result<Vec<u8>, png::EncodingError> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width, height);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.write_header()?.write_image_data(pixels)?;
    Ok(bytes)
}

fn failed(figure: &Figure, error: &dyn std::fmt::Display) -> Error {
    Error::Figure { figure: figure.id.clone(), reason: error.to_string() }
}

fn draw<DB: DrawingBackend>(figure: &Figure, root: &Area<DB>, scale: u32) -> Drawn<DB> {
    static REGISTERED: Once = Once::new();
    // The font is valid: a test draws with it.
    REGISTERED.call_once(|| drop(register_font(FAMILY, FontStyle::Normal, FONT)));
    root.fill(&rgb(PAPER))?;
    let (legend, panels) = root.split_vertically(LEGEND_HEIGHT * figure.legend_rows() * scale);
    draw_legend(figure, &legend, scale)?;
    let columns = figure.columns.max(1);
    let areas = panels.split_evenly((figure.panels.len().div_ceil(columns), columns));
    for (panel, area) in figure.panels.iter().zip(&areas) {
        draw_panel(panel, area, scale)?;
    }
    root.present()
}

fn draw_legend<DB: DrawingBackend>(figure: &Figure, area: &Area<DB>, scale: u32) -> Drawn<DB> {
    let s = scale as i32;
    let style = text(12, scale).pos(Pos::new(HPos::Left, VPos::Center));
    let (width, _) = area.dim_in_pixel();
    let (mut x, mut y) = (12 * s, LEGEND_HEIGHT as i32 * s / 2);
    for series in figure.legend() {
        let length = (32 + 7 * series.name.chars().count() as i32) * s;
        if x + length > width as i32 && x > 12 * s {
            (x, y) = (12 * s, y + LEGEND_HEIGHT as i32 * s);
        }
        let color = rgb(series.look.color);
        match series.style {
            Style::Line => area.draw(&PathElement::new([(x, y), (x + 20 * s, y)], color.stroke_width(2 * scale)))?,
            Style::Dashed => {
                // The marker is between.
                for from in [x - 3 * s, x + 17 * s] {
                    area.draw(&PathElement::new([(from, y), (from + 6 * s, y)], color.stroke_width(2 * scale)))?;
                }
            }
            Style::Bar => area.draw(&Rectangle::new([(x, y - 5 * s), (x + 20 * s, y + 5 * s)], color.filled()))?,
            Style::Hollow | Style::Points => {}
        }
        if series.style != Style::Bar {
            let (color, outline) = (rgb(series.look.color), outline(series.look.marker, scale));
            let at = EmptyElement::at((x + 10 * s, y));
            match series.style {
                Style::Hollow => area.draw(&(at + PathElement::new(outline, color.stroke_width(scale))))?,
                _ => area.draw(&(at + Polygon::new(outline, color.filled())))?,
            }
        }
        area.draw_text(&series.name, &style, (x + 26 * s, y))?;
        x += length + 12 * s;
    }
    Ok(())
}

fn draw_panel<DB: DrawingBackend>(panel: &Panel, area: &Area<DB>, scale: u32) -> Drawn<DB> {
    if panel.series.iter().all(|series| series.points.is_empty()) {
        let (width, height) = area.dim_in_pixel();
        let middle = text(13, scale).pos(Pos::new(HPos::Center, VPos::Center));
        return area.draw_text(
            &format!("{}: not measured", panel.title),
            &middle,
            (width as i32 / 2, height as i32 / 2),
        );
    }
    let (x, y) = (Span::of(panel, &panel.x, |p| p.0), Span::of(panel, &panel.y, |p| p.1));
    let mut chart = ChartBuilder::on(area)
        .margin(8 * scale)
        .margin_right(16 * scale)
        .caption(&panel.title, text(13, scale))
        .x_label_area_size((if panel.x.label.is_empty() { 24 } else { 34 }) * scale)
        .y_label_area_size(54 * scale)
        .build_cartesian_2d(x.scale(), y.scale())?;
    if !panel.shade.is_empty() {
        let most = panel.shade.iter().map(|p| p.1).fold(f64::MIN_POSITIVE, f64::max);
        let height = |value: f64| y.range.start + (y.range.end - y.range.start) * 0.9 * value / most;
        let floor = |at: Option<&(f64, f64)>| at.map(|p| (x.place(p.0), y.range.start));
        let outline = panel.shade.iter().map(|p| (x.place(p.0), height(p.1)));
        let corners: Vec<_> =
            floor(panel.shade.first()).into_iter().chain(outline).chain(floor(panel.shade.last())).collect();
        chart.draw_series([Polygon::new(corners, rgb(SHADE).filled())])?;
    }
    chart
        .configure_mesh()
        .light_line_style(TRANSPARENT)
        .bold_line_style(rgb(GRID).stroke_width(scale))
        .axis_style(rgb(INK).stroke_width(scale))
        .label_style(text(11, scale))
        .axis_desc_style(text(12, scale))
        .x_desc(&panel.x.label)
        .y_desc(&panel.y.label)
        .x_labels(20)
        .y_labels(20)
        .x_label_formatter(&|&value| x.label(value))
        .y_label_formatter(&|&value| y.label(value))
        .draw()?;
    let place = |p: &(f64, f64)| (x.place(p.0), y.place(p.1));
    for series in &panel.series {
        let points: Vec<_> = series.points.iter().map(place).collect();
        let color = rgb(series.look.color);
        match series.style {
            Style::Line => {
                chart.draw_series(LineSeries::new(points.iter().copied(), color.stroke_width(2 * scale)))?;
            }
            Style::Dashed => {
                let line = color.stroke_width(2 * scale);
                chart.draw_series(DashedLineSeries::new(points.iter().copied(), 6 * scale, 4 * scale, line))?;
            }
            Style::Bar => {
                let bar = |&(x, top): &(f64, f64)| {
                    let half = 0.5 * bar_width(panel);
                    Rectangle::new([(x - half, y.range.start), (x + half, top)], color.filled())
                };
                chart.draw_series(points.iter().map(bar))?;
            }
            Style::Hollow | Style::Points => {}
        }
        if series.style != Style::Bar {
            let marked: Vec<_> = series.marked.as_ref().unwrap_or(&series.points).iter().map(place).collect();
            let outline = || outline(series.look.marker, scale);
            let at = marked.into_iter().map(EmptyElement::at);
            match series.style {
                Style::Hollow => {
                    chart.draw_series(at.map(|at| at + PathElement::new(outline(), color.stroke_width(scale))))?;
                }
                _ => {
                    chart.draw_series(at.map(|at| at + Polygon::new(outline(), color.filled())))?;
                }
            }
        }
    }
    Ok(())
}

/// Width of a bar where a name is 1 wide.
pub(super) fn bar_width(panel: &Panel) -> f64 {
    0.8 / panel.series.iter().filter(|series| series.style == Style::Bar).count().max(1) as f64
}

/// An axis with its range, in the logarithm where it has one.
struct Span<'a> {
    axis: &'a Axis,
    range: Range<f64>,
    ticks: Vec<f64>,
}

impl<'a> Span<'a> {
    fn of(panel: &Panel, axis: &'a Axis, part: impl Fn(&(f64, f64)) -> f64) -> Self {
        let values = panel.series.iter().flat_map(|series| &series.points).map(part).filter(|v| v.is_finite());
        let values: Vec<f64> = values.filter(|&v| !axis.log || v > 0.0).collect();
        let low = values.iter().copied().fold(f64::INFINITY, f64::min);
        let high = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        if !axis.names.is_empty() {
            let ticks = (0..axis.names.len()).map(|k| k as f64).collect();
            return Self { axis, range: -0.5..axis.names.len() as f64 - 0.5, ticks };
        }
        let (low, high) = if low <= high { (low, high) } else { (1.0, 10.0) };
        if axis.log {
            let (low, high) = if high / low < 1.5 { (low / 1.5, high * 1.5) } else { (low / 1.1, high * 1.15) };
            let ticks = ticks::log(low, high).into_iter().map(f64::log10).collect();
            return Self { axis, range: low.log10()..high.log10(), ticks };
        }
        let (low, high) = (low.min(0.0), if high > 0.0 { high * 1.05 } else { 1.0 });
        Self { axis, range: low..high, ticks: ticks::linear(low, high) }
    }

    fn scale(&self) -> Scale {
        Scale { range: self.range.clone(), ticks: self.ticks.clone() }
    }

    fn place(&self, value: f64) -> f64 {
        if self.axis.log { value.max(f64::MIN_POSITIVE).log10().max(self.range.start) } else { value }
    }

    fn label(&self, value: f64) -> String {
        match self.axis.names.get(value.round() as usize) {
            Some(name) => name.clone(),
            None if self.axis.log => ticks::label(10f64.powf(value)),
            None => ticks::label(value),
        }
    }
}

/// A linear axis of plotters, labelled where we choose.
struct Scale {
    range: Range<f64>,
    ticks: Vec<f64>,
}

impl Ranged for Scale {
    type FormatOption = DefaultFormatting;
    type ValueType = f64;

    fn map(&self, value: &f64, (low, high): (i32, i32)) -> i32 {
        let part = (value - self.range.start) / (self.range.end - self.range.start);
        low + (part * f64::from(high - low)).round() as i32
    }

    fn key_points<Hint: KeyPointHint>(&self, _: Hint) -> Vec<f64> {
        self.ticks.clone()
    }

    fn range(&self) -> Range<f64> {
        self.range.clone()
    }
}

fn rgb((r, g, b): Rgb) -> RGBColor {
    RGBColor(r, g, b)
}

fn text(size: u32, scale: u32) -> TextStyle<'static> {
    TextStyle::from((FAMILY, size * scale).into_font())
}

/// A closed outline about the origin, \[pixels\].
fn outline(marker: Marker, scale: u32) -> Vec<(i32, i32)> {
    let shape: &[(f64, f64)] = match marker {
        Marker::Circle => {
            &[(4.0, 0.0), (3.0, 3.0), (0.0, 4.0), (-3.0, 3.0), (-4.0, 0.0), (-3.0, -3.0), (0.0, -4.0), (3.0, -3.0)]
        }
        Marker::Square => &[(3.0, 3.0), (-3.0, 3.0), (-3.0, -3.0), (3.0, -3.0)],
        Marker::Triangle => &[(0.0, -4.0), (4.0, 3.0), (-4.0, 3.0)],
        Marker::Diamond => &[(0.0, -5.0), (4.0, 0.0), (0.0, 5.0), (-4.0, 0.0)],
        Marker::Cross => &[
            (1.0, 1.0),
            (1.0, 4.0),
            (-1.0, 4.0),
            (-1.0, 1.0),
            (-4.0, 1.0),
            (-4.0, -1.0),
            (-1.0, -1.0),
            (-1.0, -4.0),
            (1.0, -4.0),
            (1.0, -1.0),
            (4.0, -1.0),
            (4.0, 1.0),
        ],
    };
    let at = |&(x, y): &(f64, f64)| ((x * f64::from(scale)) as i32, (y * f64::from(scale)) as i32);
    shape.iter().chain(shape.first()).map(at).collect()
}
