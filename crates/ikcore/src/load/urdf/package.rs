//! The file that a `filename` of a URDF means.

use std::path::{Path, PathBuf};

/// Where files of a URDF are looked for.
pub(super) struct Packages {
    /// The folder of the URDF; empty for text.
    directory: PathBuf,
    /// Folders that hold packages, or are one: those of the caller, then those of the environment, then the ones around the URDF.
    roots: Vec<PathBuf>,
}

impl Packages {
    /// `given` come first, then `ROS_PACKAGE_PATH`, the `fraction` folders of `AMENT_PREFIX_PATH`, and the folders above the URDF.
    pub(super) fn new(given: &[String], directory: Option<&Path>) -> Self {
        let ros = folders_of("ROS_PACKAGE_PATH");
        let ament = folders_of("AMENT_PREFIX_PATH").iter().map(|prefix| prefix.join("share")).collect();
        let directory = directory.map(|folder| std::path::absolute(folder).unwrap_or_else(|_| folder.into()));
        let around = directory.iter().flat_map(|folder| folder.ancestors()).map(Path::to_path_buf).collect();
        let roots = [given.iter().map(PathBuf::from).collect(), ros, ament, around].concat();
        Self { directory: directory.unwrap_or_default(), roots }
    }

    /// Whether the URDF is a file: those that it names will be there later too.
    pub(super) fn of_a_file(&self) -> bool {
        !self.directory.as_os_str().is_empty()
    }

    /// The file, or where it was looked for.
    pub(super) fn find(&self, filename: &str) -> Result<PathBuf, Vec<PathBuf>> {
        let package = ["package://", "model://"].iter().find_map(|scheme| filename.strip_prefix(scheme));
        let candidates = match package {
            Some(rest) => self.in_packages(rest.trim_start_matches('/')),
            None => vec![self.directory.join(filename.strip_prefix("file://").unwrap_or(filename))],
        };
        candidates.iter().find(|file| file.is_file()).cloned().ok_or(candidates)
    }

    /// `rest` is "package/path".
    fn in_packages(&self, rest: &str) -> Vec<PathBuf> {
        let (package, path) = rest.split_once('/').unwrap_or((rest, ""));
        let in_root = |root: &PathBuf| match root.file_name() {
            Some(name) if name == package => vec![root.join(path), root.join(rest)],
            _ => vec![root.join(rest)],
        };
        self.roots.iter().flat_map(in_root).collect()
    }
}

/// The folders that a variable of the environment lists.
fn folders_of(variable: &str) -> Vec<PathBuf> {
    let listed = std::env::var_os(variable).unwrap_or_default();
    std::env::split_paths(&listed).filter(|folder| !folder.as_os_str().is_empty()).collect()
}
