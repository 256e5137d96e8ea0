//! The layers of the core: a file uses its own folder and lower layers only.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

const FOUNDATION: &[&str] = &["error", "rng", "math", "stored", "wording"];

/// Which modules a module may use, besides itself and those of [`FOUNDATION`]. No solver knows of robots, no robot of solvers.
const LAYERS: &[(&str, &[&str])] = &[
    ("error", &[]),
    ("rng", &[]),
    ("math", &[]),
    ("stored", &[]),
    ("wording", &[]),
    ("kinematics", &["robot"]),
    ("starts", &["kinematics", "robot"]),
    ("robot", &["kinematics", "starts"]),
    ("load", &["kinematics", "robot"]),
    ("path", &[]),
    ("trajectory", &[]),
    ("objective", &[]),
    ("limits", &["robot", "objective"]),
    ("obstacle", &["robot", "objective"]),
    ("manipulability", &["kinematics", "robot"]),
    ("task", &["kinematics", "robot", "manipulability", "objective"]),
    ("solver", &["objective"]),
    ("problem", &["kinematics", "starts", "robot", "task", "limits", "objective"]),
    ("minimize", &["objective", "solver"]),
    ("ik", &["kinematics", "robot", "objective", "limits", "manipulability", "task", "solver", "problem"]),
    ("batch", &["kinematics", "robot", "objective", "limits", "manipulability", "task", "solver", "problem", "ik"]),
    ("posture", &["kinematics", "robot", "objective", "manipulability", "task", "solver", "ik"]),
    (
        "planning",
        &[
            "kinematics",
            "robot",
            "path",
            "trajectory",
            "objective",
            "limits",
            "obstacle",
            "manipulability",
            "task",
            "solver",
            "problem",
            "ik",
        ],
    ),
    (
        "tracking",
        &[
            "kinematics",
            "robot",
            "path",
            "trajectory",
            "objective",
            "limits",
            "manipulability",
            "task",
            "solver",
            "problem",
            "ik",
        ],
    ),
];

#[test]
fn every_file_keeps_to_its_layer() {
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let faults: Vec<String> = rust_files(&source).iter().flat_map(|file| faults_of(&source, file)).collect();
    assert!(faults.is_empty(), "\n{}\n", faults.join("\n"));
}

#[test]
fn all_ways_to_write_an_import_are_seen() {
    let text = "use crate::robot::Robot;\n\
                pub(crate) use crate::{error::Result, math::{Pose, so3}, Error};\n\
                // use crate::nothing::Here;\n\
                fn f() -> crate::task::Task { crate::Error::new() }\n";
    let found = modules_used(text);
    let expected = [(1, "robot"), (2, "error"), (2, "math"), (4, "task")];
    assert_eq!(found, expected.map(|(line, module)| (line, module.to_string())));
}

/// The lines of `file` that break its rule, each as `file:line: rule`.
fn faults_of(source: &Path, file: &Path) -> Vec<String> {
    let place = file.strip_prefix(source).expect("below src");
    let module = place.components().next().expect("a file").as_os_str().to_string_lossy().replace(".rs", "");
    if module == "lib" {
        return Vec::new(); // its contents and re-exports
    }
    let Some((_, allowed)) = LAYERS.iter().find(|(name, _)| *name == module) else {
        return vec![format!("{}: module '{module}' has no layer: add it to the table", place.display())];
    };
    let text = fs::read_to_string(file).expect("a readable file");
    modules_used(&text)
        .into_iter()
        .filter(|(_, used)| {
            let used = used.as_str();
            let foundation = FOUNDATION.contains(&used) && (used == "error" || !FOUNDATION.contains(&module.as_str()));
            used != module && !foundation && !allowed.contains(&used)
        })
        .map(|(line, used)| format!("{}:{line}: '{module}' must not use '{used}'", place.display()))
        .collect()
}

/// Top-level modules named after `crate::`, with their lines (from 1). Names in capitals are re-exports of the root, not modules.
fn modules_used(text: &str) -> Vec<(usize, String)> {
    let code: String = text.lines().map(|line| line.split("//").next().unwrap_or("").to_owned() + "\n").collect();
    let mut found = BTreeSet::new();
    for (start, _) in code.match_indices("crate::") {
        let line = 1 + code[..start].matches('\n').count();
        let rest = &code[start + "crate::".len()..];
        let names = if let Some(group) = rest.strip_prefix('{') { group_heads(group) } else { vec![head(rest)] };
        found.extend(names.into_iter().filter(|name| name.starts_with(char::is_lowercase)).map(|name| (line, name)));
    }
    found.into_iter().collect()
}

/// The first name of each entry of a braced import, up to its closing brace.
fn group_heads(group: &str) -> Vec<String> {
    let mut depth = 0;
    let mut heads = vec![head(group)];
    for (i, letter) in group.char_indices() {
        match letter {
            '{' => depth += 1,
            '}' if depth == 0 => break,
            '}' => depth -= 1,
            ',' if depth == 0 => heads.push(head(&group[i + 1..])),
            _ => {}
        }
    }
    heads
}

fn head(text: &str) -> String {
    text.trim_start().chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect()
}

fn rust_files(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).expect("a readable folder").map(|entry| entry.expect("an entry").path());
    let (folders, files): (Vec<_>, Vec<_>) = entries.partition(|path| path.is_dir());
    let mut all: Vec<_> = files.into_iter().filter(|path| path.extension().is_some_and(|e| e == "rs")).collect();
    all.extend(folders.iter().flat_map(|folder| rust_files(folder)));
    all.sort();
    all
}
