//! The page in a real browser.

use crate::fixture::CPU;
use std::{
    env,
    path::PathBuf,
    process::{Command, Output},
};

/// The browser, where there is one.
pub fn chromium() -> Option<PathBuf> {
    if let Some(path) = env::var_os("NEARFIELD_CHROMIUM") {
        return Some(path.into());
    }
    let folders = env::var_os("PATH")?;
    env::split_paths(&folders).map(|folder| folder.join("chromium")).find(|path| path.is_file())
}

fn browse(arguments: &[&str]) -> Output {
    let profile = tempfile::tempdir().unwrap();
    let profile = format!("--user-data-dir={}", profile.path().display());
    let page = format!("file://{}", CPU.written[0].display());
    // Containers refuse the sandbox, and the page is our own.
    let common = ["--headless", "--no-sandbox", "--disable-gpu", "--enable-logging=stderr", &profile];
    Command::new(chromium().unwrap()).args(common).args(arguments).arg(page).output().unwrap()
}

pub fn a_browser_shows_every_figure() {
    let dom = String::from_utf8(browse(&["--dump-dom"]).stdout).unwrap();
    let figures = CPU.written.iter().filter(|path| path.extension().is_some_and(|e| e == "svg")).count();
    assert_eq!(dom.matches("<figure").count(), figures);
    assert_eq!(dom.matches("<svg role=\"img\"").count(), figures);
    assert_eq!(dom.matches("</svg>").count(), figures, "the parser kept every picture whole");
    let picture = CPU.folder.path().join("screen.picture.png");
    let shot = format!("--screenshot={}", picture.display());
    let output = browse(&["--window-size=1200,9000", &shot]);
    let log = String::from_utf8_lossy(&output.stderr);
    assert!(!log.contains("CONSOLE"), "{log}");
    let file = std::fs::File::open(&picture).unwrap_or_else(|error| panic!("{error}: {log}"));
    let mut reader = png::Decoder::new(std::io::BufReader::new(file)).read_info().unwrap();
    let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut pixels).unwrap();
    // The first figure's colours are on the screen: Okabe and Ito's blue and vermilion.
    let bytes = info.color_type.samples();
    for color in [[0, 114, 178], [213, 94, 0]] {
        let count = pixels.chunks(bytes).filter(|pixel| pixel[..3] == color).count();
        assert!(count > 100, "{color:?}: {count}");
    }
}
