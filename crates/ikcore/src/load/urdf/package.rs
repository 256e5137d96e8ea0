//! Resolution of a URDF `filename` to a file.

use std::path::{Path, PathBuf};

/// Search path for the files of a URDF.
pub(super) struct Packages {
    /// Folder of the URDF; empty for text.
    directory: PathBuf,
    /// Folders that contain packages, or are packages: from the caller, from the environment, and around the URDF, in this
    /// order.
    roots: Vec<PathBuf>,
}

impl Packages {
    /// Builds the search path: `given`, then `ROS_PACKAGE_PATH`, the `share` folders of `AMENT_PREFIX_PATH`, and the folders
    /// above the URDF.
    pub(super) fn new(given: &[String], directory: Option<&Path>) -> Self {
        let ros = folders_of("ROS_PACKAGE_PATH");
        let ament = folders_of("AMENT_PREFIX_PATH").iter().map(|prefix| prefix.join("share")).collect();
        let directory = directory.map(|folder| std::path::absolute(folder).unwrap_or_else(|_| folder.into()));
        let around = directory.iter().flat_map(|folder| folder.ancestors()).map(Path::to_path_buf).collect();
        let roots = [given.iter().map(PathBuf::from).collect(), ros, ament, around].concat();
        Self { directory: directory.unwrap_or_default(), roots }
    }

    /// Whether the URDF is a file, so that the files that it names will remain available.
    pub(super) fn of_a_file(&self) -> bool {
        !self.directory.as_os_str().is_empty()
    }

    /// Returns the file, or the paths that were tried.
    pub(super) fn find(&self, filename: &str) -> Result<PathBuf, Vec<PathBuf>> {
        let package = ["package://", "model://"].iter().find_map(|scheme| filename.strip_prefix(scheme));
        let candidates = match package {
            Some(rest) => self.in_packages(rest.trim_start_matches('/')),
            None => vec![self.directory.join(filename.strip_prefix("file://").unwrap_or(filename))],
        };
        candidates.iter().find(|file| file.is_file()).cloned().ok_or(candidates)
    }

    /// Returns candidates for `rest`, which has the form "package/path".
    fn in_packages(&self, rest: &str) -> Vec<PathBuf> {
        let (package, path) = rest.split_once('/').unwrap_or((rest, ""));
        let in_root = |root: &PathBuf| match root.file_name() {
            Some(name) if name == package => vec![root.join(path), root.join(rest)],
            _ => vec![root.join(rest)],
        };
        self.roots.iter().flat_map(in_root).collect()
    }
}

/// Returns the folders listed by an environment variable.
fn folders_of(variable: &str) -> Vec<PathBuf> {
    let listed = std::env::var_os(variable).unwrap_or_default();
    std::env::split_paths(&listed).filter(|folder| !folder.as_os_str().is_empty()).collect()
}
