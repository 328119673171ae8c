//! The counters of processor packages.

use std::{
    fs,
    path::{Path, PathBuf},
};

/// Linux's powercap interface to the counters of processor packages (Intel and AMD RAPL). Reading them often needs
/// rights that users lack; then there is no meter.
const POWERCAP: &str = "/sys/class/powercap";

/// Adds up what the packages of the machine use, other programs included.
#[derive(Clone, Debug)]
pub(super) struct Rapl {
    counters: Vec<Counter>,
    microjoules: u64,
}

/// A counter that starts again from zero after `range`.
#[derive(Clone, Debug)]
struct Counter {
    path: PathBuf,
    range: u64,
    last: u64,
}

impl Rapl {
    /// The meter of this machine, if there is one.
    pub fn find() -> Option<Self> {
        Self::below(Path::new(POWERCAP))
    }

    fn below(folder: &Path) -> Option<Self> {
        let mut counters: Vec<Counter> =
            fs::read_dir(folder).ok()?.filter_map(|zone| Counter::open(&zone.ok()?.path())).collect();
        counters.sort_by(|a, b| a.path.cmp(&b.path));
        (!counters.is_empty()).then_some(Self { counters, microjoules: 0 })
    }

    /// Energy since the meter was found, \[J\]. To be asked more often than a counter takes to start again: some
    /// minutes under full load.
    pub fn joules(&mut self) -> f64 {
        for counter in &mut self.counters {
            let Some(now) = number(&counter.path) else { continue };
            let passed_end = if now < counter.last { counter.range } else { 0 };
            self.microjoules += now + passed_end - counter.last;
            counter.last = now;
        }
        self.microjoules as f64 * 1e-6
    }
}

impl Counter {
    /// The counter of a whole package; parts of packages would count twice.
    fn open(zone: &Path) -> Option<Self> {
        let name = fs::read_to_string(zone.join("name")).ok()?;
        let path = zone.join("energy_uj");
        let last = number(&path).filter(|_| name.starts_with("package"))?;
        Some(Self { path, range: number(&zone.join("max_energy_range_uj"))?.max(last), last })
    }
}

fn number(path: &Path) -> Option<u64> {
    fs::read_to_string(path).ok()?.trim().parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn packages_are_added_and_counters_may_start_again() {
        let folder = tempfile::tempdir().unwrap();
        let set = |zone: &str, file: &str, text: &str| {
            fs::create_dir_all(folder.path().join(zone)).unwrap();
            fs::write(folder.path().join(zone).join(file), text).unwrap();
        };
        assert!(Rapl::below(folder.path()).is_none());
        for (zone, name, energy) in [("a", "package-0\n", "900"), ("b", "package-1\n", "50"), ("a:0", "core\n", "10")] {
            set(zone, "name", name);
            set(zone, "energy_uj", energy);
            set(zone, "max_energy_range_uj", "1000");
        }
        let mut meter = Rapl::below(folder.path()).unwrap();
        assert_eq!(meter.joules(), 0.0);
        set("a", "energy_uj", "100");
        set("b", "energy_uj", "80");
        set("a:0", "energy_uj", "500");
        assert!((meter.joules() - 230e-6).abs() < 1e-12, "200 past the end of one, 30 of the other");
        fs::remove_file(folder.path().join("a/energy_uj")).unwrap();
        assert!((meter.joules() - 230e-6).abs() < 1e-12, "a counter that cannot be read adds nothing");
    }
}
