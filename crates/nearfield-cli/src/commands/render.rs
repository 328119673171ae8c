//! `nearfield render`: pictures.

use super::{configuration, note_radii, print_note};
use crate::{
    arguments::render::{ColorName, FrameRange, RenderArguments, ShapeName},
    failure::Failure,
    progress::PictureBar,
};
use nearfield::{
    Boundary, System,
    config::{Config, TypeConfig},
    configuration_system,
    io::{self, Configuration, Format, Frames, IoError},
    render::{self, Image, Options, Renderer, View},
    system,
};
use std::path::{Path, PathBuf};

pub fn run(arguments: &RenderArguments) -> Result<(), Failure> {
    render::check_png(&arguments.output).map_err(nearfield::Error::from)?;
    let options = options(arguments);
    options.validate().map_err(nearfield::Error::from)?;
    match arguments.frames {
        Some(range) => series(arguments, options, range),
        None => single(arguments, options),
    }
}

fn options(arguments: &RenderArguments) -> Options {
    let [azimuth, elevation] = arguments.orbit;
    Options {
        view: View {
            projection: arguments.projection.into(),
            azimuth,
            elevation,
            zoom: arguments.zoom,
            size: arguments.size,
        },
        shape: arguments.shape.into(),
        radius: arguments.radius,
        color_by: arguments.color.into(),
        color_map: arguments.colormap.into(),
        color_range: arguments.color_range,
        focus: arguments.focus,
        background: arguments.background,
        draw_box: !arguments.no_box,
        draw_legend: !arguments.no_legend,
        label: arguments.label.clone(),
        samples: arguments.samples,
    }
}

fn single(arguments: &RenderArguments, options: Options) -> Result<(), Failure> {
    let system = if is_config(&arguments.input) {
        start(arguments)?
    } else {
        let frame = io::ReadOptions { frame: arguments.frame.0, ..io::ReadOptions::default() };
        let mut reader = Reader::new(arguments)?;
        reader.system(io::read(&arguments.input, &frame)?)?
    };
    if arguments.cutoff.is_some() {
        note_radii(&system.radii);
    }
    let renderer = Renderer::new(&system, options)?;
    draw(&renderer, &system, 1)?.write_png(&arguments.output)?;
    print_note(&format!("wrote {} particles to {}", system.particles.len(), arguments.output.display()));
    Ok(())
}

/// One picture a frame; the first sets camera, sizes and colours of all.
fn series(arguments: &RenderArguments, options: Options, range: FrameRange) -> Result<(), Failure> {
    let input = &arguments.input;
    let file = io::input_name(input);
    if is_config(input) || (input != Path::new("-") && Format::of(input)? != Format::ExtendedXyz) {
        return Err(IoError::SingleFrame { file }.into());
    }
    let mut reader = Reader::new(arguments)?;
    let mut next = frames(input)?;
    let mut renderer = None;
    let (mut n_pictures, mut n_frames) = (0, 0);
    while n_frames <= range.last {
        let Some(frame) = next()? else { break };
        let index = n_frames;
        n_frames += 1;
        if index < range.first || !(index - range.first).is_multiple_of(range.step) {
            continue;
        }
        let named = |failure: Failure| failure.within(format!("frame {index}"));
        let system = reader.system(frame).map_err(named)?;
        if renderer.is_none() {
            renderer = Some(Renderer::new(&system, options.clone())?);
        }
        let Some(renderer) = &renderer else { break };
        n_pictures += 1;
        draw(renderer, &system, n_pictures).map_err(named)?.write_png(numbered(&arguments.output, n_pictures))?;
    }
    if n_pictures == 0 {
        return Err(IoError::NoSuchFrame { file, frame: range.first, found: n_frames }.into());
    }
    let first = numbered(&arguments.output, 1);
    print_note(&format!("wrote {n_pictures} pictures, the first to {}", first.display()));
    Ok(())
}

type NextFrame = Box<dyn FnMut() -> io::Result<Option<Configuration>>>;

/// The frames of a file or of standard input, one at a time.
fn frames(path: &Path) -> Result<NextFrame, Failure> {
    if path == Path::new("-") {
        let mut frames = Frames::new(std::io::stdin().lock(), io::input_name(path));
        return Ok(Box::new(move || frames.next_frame()));
    }
    let mut frames = Frames::open(path)?;
    Ok(Box::new(move || frames.next_frame()))
}

/// `film/frame.png` as `film/frame_0001.png`.
fn numbered(path: &Path, number: usize) -> PathBuf {
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    path.with_file_name(format!("{stem}_{number:04}.png"))
}

fn draw(renderer: &Renderer, system: &System, number: usize) -> Result<Image, Failure> {
    let bar = PictureBar::new(number, renderer.n_rows());
    let image = renderer.draw(system, &|| bar.row_done());
    bar.clear();
    Ok(image?)
}

fn is_config(path: &Path) -> bool {
    path.extension().is_some_and(|extension| extension == "toml")
}

/// The start of a configuration file.
fn start(arguments: &RenderArguments) -> Result<System, Failure> {
    if arguments.config.is_some() {
        return Err(Failure::request("--config is for inputs that are no configuration files themselves"));
    }
    let mut config = configuration(&arguments.input, &[])?;
    if let Some(cutoff) = arguments.cutoff {
        config.interaction.cutoff = cutoff;
    }
    if let Some([x, y, z]) = arguments.boundary {
        (config.boundary.x, config.boundary.y, config.boundary.z) = (x, y, z);
    }
    config.validate()?;
    Ok(system(&config)?)
}

/// Makes systems of what a file holds, only as far as the picture needs: without search radii where none are drawn or
/// searched, and with types by the file's species where no configuration says what they are.
struct Reader<'a> {
    arguments: &'a RenderArguments,
    config: Config,
    /// Whether the types are known: given, or found in the first frame.
    typed: bool,
    boundary: Option<[Boundary; 3]>,
}

impl<'a> Reader<'a> {
    fn new(arguments: &'a RenderArguments) -> Result<Self, Failure> {
        let mut config = match &arguments.config {
            Some(path) => configuration(path, &[])?,
            None => Config::default(),
        };
        if let Some(cutoff) = arguments.cutoff {
            config.interaction.cutoff = cutoff;
        }
        config.validate()?;
        let configured = || arguments.config.as_ref().map(|_| config.boundary.axes());
        let boundary = arguments.boundary.or_else(configured);
        Ok(Self { arguments, typed: arguments.config.is_some(), boundary, config })
    }

    fn system(&mut self, mut configuration: Configuration) -> Result<System, Failure> {
        let arguments = self.arguments;
        let file = io::input_name(&arguments.input);
        if arguments.color == ColorName::Speed && configuration.velocity.is_none() {
            return Err(Failure::request(format!("{file} gives no velocities, which --color speed needs")));
        }
        if !self.typed && !configuration.is_empty() {
            let named = |name: &String| TypeConfig { name: Some(name.clone()), ..TypeConfig::default() };
            self.config.interaction.types = configuration.species.names.iter().map(named).collect();
            self.typed = true;
        }
        let searches = arguments.focus.is_some() || arguments.shape != ShapeName::Points;
        let needs_range = searches || arguments.color == ColorName::Neighbors;
        let given = arguments.cutoff.is_some() || arguments.config.is_some() || configuration.radius.is_some();
        if needs_range && !given {
            let why = "--as, --focus and --color neighbors need a search radius";
            return Err(Failure::request(format!("{file} gives no radii: {why}; say --cutoff C")));
        }
        if !needs_range && arguments.color != ColorName::Energy {
            // Nothing is searched, so any range will do that fits the box.
            configuration.radius = None;
            let lengths = configuration.bounds.map(|bounds| [0, 1, 2].map(|axis| bounds.hi[axis] - bounds.lo[axis]));
            let shortest = lengths.unwrap_or([1.0; 3]).into_iter().fold(f32::INFINITY, f32::min);
            self.config.interaction.cutoff = f64::from(0.25 * shortest);
        }
        Ok(configuration_system(&self.config, &file, configuration, self.boundary)?)
    }
}
