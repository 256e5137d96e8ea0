//! Layers of the core: a file uses its own module and lower ones, files do not import one another in circles, and a name is
//! declared once.

pub mod imports;

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use imports::{SourceFile, Sources, code_of, paths};

const FOUNDATION: &[&str] = &["message", "error", "interrupt", "rng", "math", "stored", "wording"];

/// Row of the table in docs/architecture.md: a module, and those that it may use besides itself and [`FOUNDATION`].
struct Layer {
    module: String,
    uses: Vec<String>,
}

/// Reads the table, from the lowest layer up.
fn layers() -> Vec<Layer> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/architecture.md");
    let page = std::fs::read_to_string(path).expect("docs/architecture.md");
    let (_, table) = page.split_once("| module | may use | contains |\n").expect("the table of the layers");
    let rows = table.lines().skip(1).take_while(|line| line.starts_with('|'));
    rows.map(|row| {
        let mut cells = row.split('|').skip(1).map(str::trim);
        let mut cell = || cells.next().expect("a row with cells");
        let module = cell().trim_matches('`').to_owned();
        let uses = cell().split(", ").filter(|name| !name.is_empty()).map(str::to_owned).collect();
        Layer { module, uses }
    })
    .collect()
}

/// Name of a solver's progress type, which every solver declares.
const STATE: &str = "State";

fn core() -> Sources {
    Sources::read(&Path::new(env!("CARGO_MANIFEST_DIR")).join("src"))
}

#[test]
fn every_file_keeps_to_its_layer() {
    let layers = layers();
    let faults: Vec<String> = core().files().flat_map(|file| faults_of(file, &layers)).collect();
    assert!(faults.is_empty(), "\n{}\n", faults.join("\n"));
}

#[test]
fn every_layer_uses_those_above_it_in_the_table_and_no_other() {
    let (core, layers) = (core(), layers());
    let mut above: Vec<&str> = vec![];
    for Layer { module, uses } in &layers {
        let used: BTreeSet<String> = core
            .files()
            .filter(|file| room_of(file) == *module)
            .flat_map(|file| modules_used(&file.code).into_iter().map(|(_, used)| used))
            .collect();
        for name in uses {
            assert!(above.contains(&name.as_str()), "'{module}' uses '{name}', which is not above it");
            assert!(used.contains(name), "'{module}' does not use '{name}'");
        }
        above.push(module);
    }
}

#[test]
fn files_import_one_another_in_no_circle() {
    let binding = Sources::read(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../ikpy-bind/src"));
    for sources in [core(), binding] {
        let lines: Vec<String> = sources.circles().iter().map(|circle| circle.join(" <-> ")).collect();
        assert!(lines.is_empty(), "files import one another in circles:\n{}\n", lines.join("\n"));
    }
}

#[test]
fn tests_stand_in_the_rooms_of_the_core() {
    let layers = layers();
    let tests = Sources::read(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/rust"));
    for file in tests.files() {
        let room = room_of(file);
        let known = ["main", "common", "interface", "layers", "plain_words", "repeatable"].contains(&&*room)
            || layers.iter().any(|layer| layer.module == room);
        assert!(known, "tests/rust/{}: the core has no room '{room}'", file.path.display());
    }
}

#[test]
fn no_two_types_share_a_name() {
    let core = core();
    let mut places: BTreeMap<&str, BTreeSet<&Path>> = BTreeMap::new();
    for file in core.files() {
        for name in declared_types(&file.code) {
            places.entry(name).or_default().insert(&file.path);
        }
    }
    places.retain(|name, files| files.len() > 1 && *name != STATE);
    assert!(places.is_empty(), "types with one name: {places:#?}");
}

#[test]
fn no_three_files_share_a_name() {
    let core = core();
    let mut places: BTreeMap<String, Vec<&Path>> = BTreeMap::new();
    for file in core.files() {
        let name = file.path.file_name().expect("a name").to_string_lossy();
        places.entry(name.into_owned()).or_default().push(&file.path);
    }
    places.retain(|name, files| files.len() > 2 && name != "mod.rs");
    assert!(places.is_empty(), "files with one name: {places:#?}");
}

#[test]
fn all_ways_to_write_an_import_are_seen() {
    let text = "use crate::robot::Robot;\n\
                pub(crate) use crate::{error::Result, math::{Pose, so3,}, Error};\n\
                // use crate::nothing::Here;\n\
                fn f() -> crate::task::Task { crate::Error::new() }\n\
                use super::super::limits::{self, profile as p};\n";
    let found: Vec<(usize, String)> =
        paths(&code_of(text)).into_iter().map(|(line, path)| (line, path.join("::"))).collect();
    let expected = [
        (1, "crate::robot::Robot"),
        (2, "crate::Error"),
        (2, "crate::error::Result"),
        (2, "crate::math::Pose"),
        (2, "crate::math::so3"),
        (4, "crate::Error::new"),
        (4, "crate::task::Task"),
        (5, "super::super::limits::profile"),
        (5, "super::super::limits::self"),
    ];
    assert_eq!(found, expected.map(|(line, path)| (line, path.to_owned())));
    let modules =
        [(1, "robot"), (2, "error"), (2, "math"), (4, "task")].map(|(line, module)| (line, module.to_owned()));
    assert_eq!(modules_used(&code_of(text)), modules.into());
}

#[test]
fn circles_are_found_through_re_exports() {
    let sources = |a: &str, parent: &str| {
        let files =
            [("lib.rs", "pub mod room;"), ("room/mod.rs", parent), ("room/a.rs", a), ("room/b.rs", "use super::a::A;")];
        Sources::of(files.map(|(path, text)| (PathBuf::from(path), text.to_owned()))).circles()
    };
    let contents = "mod a;\nmod b;\npub use a::A;\npub(crate) use b::B;\n";
    let circle = vec![vec!["room/a.rs".to_owned(), "room/b.rs".to_owned()]];
    assert_eq!(sources("use super::b::B;", contents), circle);
    assert_eq!(sources("use super::B;", contents), circle);
    assert_eq!(sources("fn f() { crate::room::B::new() }", contents), circle);
    assert!(sources("#[cfg(test)]\nmod tests { use super::super::B; }", contents).is_empty());
    assert!(sources("// use super::B;", contents).is_empty());
    let parent_calls_a = "mod a;\nmod b;\npub const C: f64 = 1.0;\nfn f() { a::g() }\n";
    assert_eq!(sources("use super::C;", parent_calls_a), [["room/a.rs", "room/mod.rs"]]);
}

/// Lines of `file` that violate its rule, each as `file:line: rule`.
fn faults_of(file: &SourceFile, layers: &[Layer]) -> Vec<String> {
    let place = file.path.display();
    let module = room_of(file);
    if module == "lib" {
        return Vec::new(); // its contents and re-exports
    }
    let Some(Layer { uses: allowed, .. }) = layers.iter().find(|layer| layer.module == module) else {
        return vec![format!("{place}: module '{module}' has no layer: add it to the table in docs/architecture.md")];
    };
    modules_used(&file.code)
        .into_iter()
        .filter(|(_, used)| {
            let used = used.as_str();
            let foundation = FOUNDATION.contains(&used)
                && (["message", "error"].contains(&used) || !FOUNDATION.contains(&module.as_str()));
            used != module && !foundation && !allowed.iter().any(|name| name == used)
        })
        .map(|(line, used)| format!("{place}:{line}: '{module}' must not use '{used}'"))
        .collect()
}

/// The folder or file of the crate's root that `file` belongs to.
fn room_of(file: &SourceFile) -> String {
    file.path.components().next().expect("a file").as_os_str().to_string_lossy().replace(".rs", "")
}

/// Top-level modules named after `crate::`, with their lines. Names in capitals are re-exports of the root, not modules.
fn modules_used(code: &str) -> BTreeSet<(usize, String)> {
    let modules = paths(code).into_iter().filter(|(_, path)| path[0] == "crate");
    modules
        .filter_map(|(line, path)| Some((line, path.get(1)?.clone())))
        .filter(|(_, name)| name.starts_with(char::is_lowercase))
        .collect()
}

/// Names of the types that `code` declares with any kind of `pub`.
fn declared_types(code: &str) -> impl Iterator<Item = &str> {
    code.lines().filter_map(|line| {
        let rest = line.trim_start().strip_prefix("pub")?;
        let rest = if rest.starts_with('(') { rest.split_once(')')?.1 } else { rest };
        let (keyword, rest) = rest.trim_start().split_once(' ')?;
        let name = rest.split(|c: char| !(c.is_alphanumeric() || c == '_')).next()?;
        ["struct", "enum", "trait", "type", "union"].contains(&keyword).then_some(name)
    })
}
