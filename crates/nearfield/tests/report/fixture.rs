//! Results of tiny runs of all suites.

use nearfield::{
    Device,
    bench::{self, Options, Record, Suite, read_records, results_file},
    report,
};
use std::{
    fs,
    path::{Path, PathBuf},
    sync::LazyLock,
};
use tempfile::TempDir;

/// A folder of results and the files of its report.
pub struct Fixture {
    pub folder: TempDir,
    pub written: Vec<PathBuf>,
}

/// The results of this machine's CPU.
pub static CPU: LazyLock<Fixture> = LazyLock::new(|| {
    let folder = tempfile::tempdir().unwrap();
    let options = Options { quick: true, device: Device::Cpu, n: vec![200], seconds: Some(1e-3), ..Options::default() };
    for suite in Suite::ALL {
        bench::run(suite, folder.path(), &options, &mut |_| {}).unwrap();
    }
    let written = report::plot(folder.path(), folder.path()).unwrap();
    Fixture { folder, written }
});

impl Fixture {
    pub fn page(&self) -> String {
        fs::read_to_string(&self.written[0]).unwrap()
    }

    /// Copies the results of a suite, changed, into a folder.
    pub fn copy(&self, suite: Suite, to: &Path, change: impl Fn(&mut Record)) {
        let mut records = read_records(&results_file(self.folder.path(), suite)).unwrap();
        records.iter_mut().for_each(change);
        let lines: String = records.iter().map(|record| serde_json::to_string(record).unwrap() + "\n").collect();
        fs::create_dir_all(to).unwrap();
        fs::write(results_file(to, suite), lines).unwrap();
    }
}
