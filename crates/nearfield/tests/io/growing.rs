//! Files survive a kill: whole or absent, or cut back to their last record.

use nearfield::io::{AppendFile, Configuration, Frames, IoError, Trajectory, atomic_write};
use std::{fs, io};

#[test]
fn a_failed_atomic_write_leaves_the_old_file_and_no_other() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("state");
    atomic_write(&path, |out| out.write_all(b"old")).unwrap();
    let error = atomic_write(&path, |out| {
        out.write_all(&vec![0; 1 << 20])?;
        Err(io::Error::other("disk full"))
    });
    assert!(error.unwrap_err().to_string().ends_with("state: disk full"));
    assert_eq!(fs::read(&path).unwrap(), b"old");
    assert_eq!(fs::read_dir(&folder).unwrap().count(), 1, "the temporary file is gone");
    atomic_write(&path, |out| out.write_all(b"new")).unwrap();
    assert_eq!(fs::read(&path).unwrap(), b"new");
}

#[cfg(unix)]
#[test]
fn atomic_files_have_ordinary_permissions_keep_links_and_leave_devices_alone() {
    use std::os::unix::fs::PermissionsExt;
    let folder = tempfile::tempdir().unwrap();
    let (path, ordinary, link) = (folder.path().join("a"), folder.path().join("b"), folder.path().join("c"));
    atomic_write(&path, |_| Ok(())).unwrap();
    fs::write(&ordinary, "").unwrap();
    let mode = |path| fs::metadata(path).unwrap().permissions().mode();
    assert_eq!(mode(&path), mode(&ordinary));
    std::os::unix::fs::symlink("a", &link).unwrap();
    atomic_write(&link, |out| out.write_all(b"through the link")).unwrap();
    assert_eq!(fs::read(&path).unwrap(), b"through the link");
    assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
    atomic_write("/dev/null", |out| out.write_all(b"nothing")).unwrap();
    assert!(!fs::metadata("/dev/null").unwrap().is_file());
}

#[test]
fn a_resumed_file_goes_on_after_its_checkpoint() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("thermo.csv");
    let mut table = AppendFile::create(&path).unwrap();
    table.append(b"step\n").unwrap();
    table.append(b"1\n").unwrap();
    let length = table.length();
    assert_eq!(length, 7);
    table.append(b"2\npartial re").unwrap();
    table.sync().unwrap();
    let mut resumed = AppendFile::open_at(&path, length).unwrap();
    resumed.append(b"2\n").unwrap();
    assert_eq!((resumed.length(), fs::read_to_string(&path).unwrap().as_str()), (9, "step\n1\n2\n"));
    let error = AppendFile::open_at(&path, 10).unwrap_err();
    assert!(matches!(error, IoError::TooShort { expected: 10, found: 9, .. }), "{error}");
    assert!(matches!(AppendFile::open_at(folder.path().join("none"), 0), Err(IoError::Write { .. })));
    assert_eq!(AppendFile::create(&path).unwrap().length(), 0);
    assert_eq!(fs::metadata(&path).unwrap().len(), 0, "create starts anew");
}

#[test]
fn a_trajectory_has_each_frame_on_disk_at_once_and_resumes_after_a_cut_one() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("trajectory.xyz");
    let frame = |step: u64| Configuration { step: Some(step), ..Configuration::at([[step as f32, 0.5, -1.0]; 3]) };
    let steps = || -> Vec<u64> { Frames::open(&path).unwrap().map(|f| f.unwrap().step.unwrap()).collect() };
    let mut trajectory = Trajectory::create(&path).unwrap();
    trajectory.append(&frame(0)).unwrap();
    trajectory.append(&frame(10)).unwrap();
    assert_eq!(steps(), [0, 10]);
    let length = trajectory.length();
    trajectory.append(&frame(20)).unwrap();
    fs::File::options().write(true).open(&path).unwrap().set_len(trajectory.length() - 5).unwrap();
    assert!(Frames::open(&path).unwrap().last().unwrap().is_err(), "the last frame is cut");
    let mut resumed = Trajectory::open_at(&path, length).unwrap();
    resumed.append(&frame(30)).unwrap();
    assert_eq!(steps(), [0, 10, 30]);
    let uneven = Configuration { radius: Some(vec![1.0]), ..frame(40) };
    assert!(matches!(resumed.append(&uneven), Err(IoError::Unwritable { .. })));
    assert_eq!(steps(), [0, 10, 30]);
}
