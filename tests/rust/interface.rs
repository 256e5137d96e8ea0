//! The public interface of the core is the one that was agreed on: `tests/rust/interface.txt` holds each public path with its
//! signature. Run the tests with `AGREE=1` after a change that is meant, and commit the list.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::{env, fs};

use crate::layers::imports::Sources;

/// What follows `pub` in a declaration.
const KINDS: &[&str] = &["fn", "const", "struct", "enum", "trait", "type", "static", "unsafe"];

#[test]
fn the_public_interface_is_as_agreed() {
    let kept = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/rust/interface.txt");
    let today = interface(&Sources::read(&Path::new(env!("CARGO_MANIFEST_DIR")).join("src")));
    if env::var_os("AGREE").is_some() {
        fs::write(&kept, today.join("\n") + "\n").expect("a writable file");
    }
    let agreed = fs::read_to_string(&kept).expect("a readable file");
    let agreed: BTreeSet<&str> = agreed.lines().collect();
    let today: BTreeSet<&str> = today.iter().map(String::as_str).collect();
    let (lost, new): (Vec<_>, Vec<_>) = (agreed.difference(&today).collect(), today.difference(&agreed).collect());
    assert!(
        lost.is_empty() && new.is_empty(),
        "gone: {lost:#?}\nnew: {new:#?}\nIf this is meant, run the test with AGREE=1."
    );
}

#[test]
fn paths_and_signatures_of_public_items_are_listed() {
    let files = [
        ("lib.rs", "pub mod arm;\nmod parts;\npub use arm::Arm;\n"),
        (
            "arm.rs",
            "pub use crate::parts::{Link, span};\npub(crate) use crate::parts::Hidden;\npub struct Arm {\n    pub q: f64,\n    own: f64,\n}\nimpl Arm {\n    pub fn new(\n        q: f64,\n    ) -> Self {\n        pub fn not() {}\n    }\n    fn own(&self) {}\n}\n",
        ),
        (
            "parts.rs",
            "#[derive(Debug)]\npub enum Link {\n    Fixed,\n    Moving {\n        axis: f64,\n    },\n}\npub struct Hidden;\nimpl Hidden {\n    pub fn lost() {}\n}\npub fn span<T>(t: T) -> f64\nwhere\n    T: Copy,\n{\n    1.0\n}\nimpl Copy for Link {}\n",
        ),
    ];
    let sources = Sources::of(files.map(|(path, text)| (PathBuf::from(path), text.to_owned())));
    let expected = [
        "Arm, arm::Arm: struct Arm { pub q: f64 }",
        "Arm, arm::Arm: fn new(q: f64) -> Self",
        "arm::Link: Copy",
        "arm::Link: enum Link { Fixed, Moving { axis: f64 } }",
        "arm::span: fn span<T>(t: T) -> f64 where T: Copy",
    ];
    let found = interface(&sources);
    assert_eq!(found.iter().map(String::as_str).collect::<BTreeSet<_>>(), BTreeSet::from(expected), "{found:#?}");
}

/// One line for each public item, method and implemented trait.
pub fn interface(sources: &Sources) -> Vec<String> {
    let mut paths: BTreeMap<(&str, String), Vec<String>> = BTreeMap::new();
    let mut open = vec![""];
    while let Some(module) = open.pop() {
        let code = sources.code(module);
        let below = |name: &str| if module.is_empty() { name.to_owned() } else { format!("{module}::{name}") };
        open.extend(
            code.lines()
                .filter_map(|line| line.strip_prefix("pub mod "))
                .filter_map(|line| sources.known(&below(line.trim_end_matches(';')))),
        );
        for name in declarations(code).into_iter().filter_map(|(name, _)| name) {
            paths.entry((module, name.clone())).or_default().push(below(&name));
        }
        for (origin, name) in sources.public_re_exports(module) {
            paths.entry((origin, name.clone())).or_default().push(below(&name));
        }
    }
    let path_of = |module: &str, name: &str| paths.get(&(module, name.to_owned())).map(|all| all.join(", "));
    let mut types: BTreeMap<&str, String> = BTreeMap::new();
    for (module, name) in paths.keys() {
        if name.starts_with(char::is_uppercase) {
            types.insert(name, path_of(module, name).unwrap_or_default());
        }
    }
    let mut lines = vec![];
    for module in sources.modules() {
        for (name, item) in declarations(sources.code(module)) {
            lines.extend(name.and_then(|name| path_of(module, &name)).map(|path| format!("{path}: {item}")));
        }
        for (name, item) in members(sources.code(module)) {
            lines.extend(types.get(name.as_str()).map(|path| format!("{path}: {item}")));
        }
    }
    lines.sort();
    lines
}

/// The public items at the first column of `code`, each with its name.
fn declarations(code: &str) -> Vec<(Option<String>, String)> {
    let blocks = blocks(code).into_iter().filter_map(|block| {
        let item = block[0].strip_prefix("pub ")?;
        let kind = item.split(' ').next()?;
        KINDS.contains(&kind).then_some((kind, item, block))
    });
    let described = blocks.map(|(kind, item, block)| match kind {
        "struct" | "enum" | "trait" if block.len() > 1 => (name_of(item), joined(&visible(kind, &block))),
        "struct" => (
            name_of(item),
            item.split(if item.contains("(pub ") { ';' } else { '(' })
                .next()
                .unwrap_or_default()
                .trim_end_matches(';')
                .to_owned(),
        ),
        _ => (name_of(item), signature(&block)),
    });
    described.map(|(name, item)| (name, item.strip_prefix("pub ").map_or(item.clone(), str::to_owned))).collect()
}

/// The public methods and the implemented traits of `code`, each with the name of its type.
fn members(code: &str) -> Vec<(String, String)> {
    let mut found = vec![];
    for block in blocks(code).into_iter().filter(|block| block[0].starts_with("impl")) {
        let Some((of_trait, name)) = implementation(&signature(&block)) else { continue };
        if let Some(of_trait) = of_trait {
            found.push((name, of_trait));
            continue;
        }
        let inner: String =
            block[1..].iter().map(|line| format!("{}\n", line.strip_prefix("    ").unwrap_or_default())).collect();
        found.extend(declarations(&inner).into_iter().map(|(_, item)| (name.clone(), item)));
    }
    found
}

/// The trait, if it is one's, and the type of an `impl`.
fn implementation(head: &str) -> Option<(Option<String>, String)> {
    let head = head.split(" where ").next().unwrap_or_default();
    let rest = after_generics(head.trim_start_matches("impl")).trim();
    let (of_trait, of_type) = rest.rsplit_once(" for ").map_or((None, rest), |(name, of)| (Some(name.to_owned()), of));
    name_of(&format!("type {of_type}")).map(|name| (of_trait, name))
}

/// The type of an `impl` that begins with this line.
pub fn type_of(line: &str) -> Option<String> {
    implementation(line).map(|(_, name)| name)
}

/// Text after the parameters `<...>` that it begins with.
fn after_generics(text: &str) -> &str {
    let mut depth = 0;
    for (at, c) in text.char_indices() {
        depth += i32::from(c == '<') - i32::from(c == '>' && !text[..at].ends_with('-'));
        if depth == 0 {
            return if at == 0 { text } else { &text[at + 1..] };
        }
    }
    text
}

/// The name that a declaration gives.
fn name_of(item: &str) -> Option<String> {
    let mut words = item.split(|c: char| !(c.is_alphanumeric() || c == '_'));
    words.find(|word| !(KINDS.contains(word) || word.is_empty())).map(str::to_owned)
}

/// Items that begin at the first column, each as its lines.
fn blocks(code: &str) -> Vec<Vec<&str>> {
    let mut blocks: Vec<Vec<&str>> = vec![];
    for line in code.lines().map(str::trim_end).filter(|line| !line.is_empty()) {
        let begins = ["pub ", "impl"].iter().any(|start| line.starts_with(start));
        match blocks.last_mut() {
            Some(block)
                if !begins
                    && (line.starts_with("where") || !line.starts_with(|c: char| c.is_alphabetic() || c == '#')) =>
            {
                block.push(line)
            }
            _ if begins => blocks.push(vec![line]),
            _ => blocks.push(vec!["other"]),
        }
    }
    blocks.retain(|block| block[0] != "other");
    blocks
}

/// The lines of a type or trait that its users see.
fn visible<'a>(kind: &str, block: &[&'a str]) -> Vec<&'a str> {
    let mut in_attribute = false;
    let plain = block.iter().filter(|line| {
        in_attribute |= line.trim_start().starts_with("#[");
        let hidden = in_attribute;
        in_attribute &= !line.ends_with(']');
        !hidden
    });
    let kept = |line: &&&str| match kind {
        "struct" => line.starts_with("    pub ") || !line.starts_with("    "),
        "enum" => true,
        _ => !line.starts_with("        ") && line.trim() != "}",
    };
    plain.filter(kept).copied().collect()
}

/// A declaration up to its body or value.
fn signature(block: &[&str]) -> String {
    let whole = joined(block);
    let ends = [" { ", " {", "; ", " = "].iter().filter_map(|end| whole.find(end));
    whole[..ends.min().unwrap_or(whole.len())].trim_end_matches([';', '{', ' ']).to_owned()
}

/// Lines as one, without what breaks between lines leave.
fn joined(lines: &[&str]) -> String {
    let line = lines.iter().map(|line| line.trim()).collect::<Vec<_>>().join(" ");
    line.replace("( ", "(")
        .replace(", )", ")")
        .replace(" )", ")")
        .replace(", }", " }")
        .replace(",}", "}")
        .replace(", {", " {")
}
