//! Reader of imports in source text: a parser of paths, and the graph of files that they form.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

/// Path as segments, for example `crate`, `math`, `Frame`.
type Segments = Vec<String>;

/// Files of a crate by module path: `robot::model` for `robot/model.rs`, `robot` for `robot/mod.rs`.
pub struct Sources(BTreeMap<String, SourceFile>);

pub struct SourceFile {
    /// Path below the crate's source folder.
    pub path: PathBuf,
    /// Text without comments and unit tests.
    pub code: String,
}

impl Sources {
    /// Reads all files below `folder`.
    pub fn read(folder: &Path) -> Self {
        let files = rust_files(folder).into_iter().map(|path| {
            let text = fs::read_to_string(&path).expect("a readable file");
            (path.strip_prefix(folder).expect("below the folder").to_owned(), text)
        });
        Self::of(files)
    }

    /// Files of these paths and texts.
    pub fn of(files: impl IntoIterator<Item = (PathBuf, String)>) -> Self {
        let file = |(path, text): (PathBuf, String)| {
            let module = path.with_extension("").to_string_lossy().replace('/', "::");
            let module = module.strip_suffix("mod").map_or(module.as_str(), |folder| folder.trim_end_matches("::"));
            let module = if module == "lib" { String::new() } else { module.to_owned() };
            (module, SourceFile { code: code_of(&text), path })
        };
        Self(files.into_iter().map(file).collect())
    }

    pub fn files(&self) -> impl Iterator<Item = &SourceFile> {
        self.0.values()
    }

    pub fn modules(&self) -> impl Iterator<Item = &str> {
        self.0.keys().map(String::as_str)
    }

    /// The module of this path, if there is one.
    pub fn known(&self, module: &str) -> Option<&str> {
        self.0.get_key_value(module).map(|(module, _)| module.as_str())
    }

    pub fn code(&self, module: &str) -> &str {
        &self.0[module].code
    }

    /// The names that a module re-exports to everyone, each with the module that declares it.
    pub fn public_re_exports(&self, module: &str) -> Vec<(&str, String)> {
        let statements = self.code(module).split(';').map(str::trim_start);
        let statements = statements.filter(|statement| statement.starts_with("pub use "));
        let exported = statements.flat_map(|statement| re_exports(&format!("{statement};")));
        let origin = |path: Segments| {
            let name = path.last()?.clone();
            let start = if path[0] == "crate" { vec![] } else { vec!["self".to_owned()] };
            let child = if module.is_empty() { path[0].clone() } else { format!("{module}::{}", path[0]) };
            self.known(&child).filter(|_| path.len() > 1).or_else(|| (path[0] == "crate").then_some(module))?;
            Some((self.resolve(module, &[start, path].concat())?, name))
        };
        exported.filter_map(origin).collect()
    }

    /// Groups of files that import one another in a circle, each as paths in alphabetical order.
    pub fn circles(&self) -> Vec<Vec<String>> {
        let imports: BTreeMap<&str, BTreeSet<&str>> =
            self.0.keys().map(|module| (module.as_str(), self.imports_of(module))).collect();
        let reach: BTreeMap<&str, BTreeSet<&str>> =
            imports.keys().map(|module| (*module, reached(&imports, module))).collect();
        let mut circles = BTreeSet::new();
        for (module, reached) in &reach {
            if reached.contains(module) {
                let circle = reached.iter().filter(|other| reach[*other].contains(module));
                let paths = circle.map(|other| self.0[*other].path.to_string_lossy().into_owned());
                let mut paths: Vec<String> = paths.collect();
                paths.sort();
                circles.insert(paths);
            }
        }
        circles.into_iter().collect()
    }

    /// Modules in other files that this one takes names from. Re-exports do not count.
    fn imports_of(&self, module: &str) -> BTreeSet<&str> {
        let code = without_re_exports(&self.0[module].code);
        let absolute = paths(&code).into_iter().map(|(_, path)| path);
        let from_children = self.children(module).flat_map(|child| paths_from(&code, child));
        let relative = from_children.map(|path| [vec!["self".to_owned()], path].concat());
        let used = absolute.chain(relative).filter_map(|path| self.resolve(module, &path));
        used.filter(|used| *used != module).collect()
    }

    /// Names of the modules directly below this one.
    fn children<'a>(&'a self, module: &'a str) -> impl Iterator<Item = &'a str> {
        let below = move |other: &'a String| {
            let rest = if module.is_empty() { other } else { other.strip_prefix(module)?.strip_prefix("::")? };
            (!rest.is_empty() && !rest.contains("::")).then_some(rest)
        };
        self.0.keys().filter_map(below)
    }

    /// Module whose file declares the name that `path` has in the file of `module`; re-exports are followed.
    fn resolve(&self, module: &str, path: &[String]) -> Option<&str> {
        let mut place: Vec<&str> = module.split("::").filter(|segment| !segment.is_empty()).collect();
        let mut rest = path.iter().map(String::as_str).peekable();
        while let Some(segment) = rest.peek() {
            match *segment {
                "crate" => place.clear(),
                "self" => {}
                "super" => {
                    place.pop();
                }
                name => {
                    place.push(name);
                    if !self.0.contains_key(&place.join("::")) {
                        place.pop();
                        break;
                    }
                }
            }
            rest.next();
        }
        let (found, file) = self.0.get_key_value(&place.join("::"))?;
        let re_exported = rest.next().and_then(|name| {
            let re_export =
                re_exports(&file.code).into_iter().find(|path| path.last().is_some_and(|last| last == name))?;
            let relative = [vec!["self".to_owned()], re_export].concat();
            self.resolve(found, &relative)
        });
        re_exported.or(Some(found))
    }
}

/// Modules that can be reached from this one by imports.
fn reached<'a>(imports: &BTreeMap<&'a str, BTreeSet<&'a str>>, from: &str) -> BTreeSet<&'a str> {
    let mut reached = BTreeSet::new();
    let mut open: Vec<&str> = imports[from].iter().copied().collect();
    while let Some(module) = open.pop() {
        if reached.insert(module) {
            open.extend(&imports[module]);
        }
    }
    reached
}

/// Removes the comments of `text`, and the unit tests at its end. Lines keep their numbers.
pub fn code_of(text: &str) -> String {
    let code = text.split("#[cfg(test)]\nmod tests").next().unwrap_or_default();
    code.lines().map(|line| line.split("//").next().unwrap_or_default().to_owned() + "\n").collect()
}

/// Paths in `code` that begin with `crate`, `super` or `self`, with their lines (from 1); groups in braces are expanded.
pub fn paths(code: &str) -> Vec<(usize, Segments)> {
    let starts = ["crate", "super", "self"].into_iter().flat_map(|start| occurrences(code, start));
    let mut found = vec![];
    for start in starts {
        let line = 1 + code[..start].matches('\n').count();
        let mut paths = vec![];
        read_tree(&code[start..], &[], &mut paths);
        found.extend(paths.into_iter().map(|path| (line, path)));
    }
    found.sort();
    found
}

/// Paths in `code` that begin with the name `first`.
fn paths_from(code: &str, first: &str) -> Vec<Segments> {
    let mut found = vec![];
    for start in occurrences(code, first) {
        read_tree(&code[start..], &[], &mut found);
    }
    found
}

/// Positions at which a path begins with the name `first`.
fn occurrences(code: &str, first: &str) -> Vec<usize> {
    let begins = |start: &usize| {
        let before = code[..*start].chars().next_back().unwrap_or(' ');
        !(before.is_alphanumeric() || before == '_' || before == ':')
    };
    code.match_indices(&format!("{first}::")).map(|(start, _)| start).filter(begins).collect()
}

/// Reads a path, or a group of paths in braces, appends each to `found` behind `prefix`, and returns the rest of the text.
fn read_tree<'a>(text: &'a str, prefix: &[String], found: &mut Vec<Segments>) -> &'a str {
    let text = text.trim_start();
    if let Some(group) = text.strip_prefix('{') {
        let mut rest = group.trim_start();
        while !rest.is_empty() && !rest.starts_with('}') {
            rest = read_tree(rest, prefix, found);
            rest = rest.find([',', '}']).map_or("", |end| rest[end..].trim_start_matches(',')).trim_start();
        }
        return rest.strip_prefix('}').unwrap_or(rest);
    }
    let end = text.find(|c: char| !(c.is_alphanumeric() || c == '_')).unwrap_or(text.len());
    let (name, rest) = text.split_at(end);
    let path = [prefix, &[name.to_owned()]].concat();
    match rest.strip_prefix("::") {
        Some(next) if next.starts_with(|c: char| c.is_alphanumeric() || c == '_' || c == '{') => {
            read_tree(next, &path, found)
        }
        _ => {
            found.push(path);
            rest
        }
    }
}

/// Paths that `code` re-exports.
fn re_exports(code: &str) -> Vec<Segments> {
    let mut found = vec![];
    for tree in code.split(';').filter_map(re_exported) {
        read_tree(tree, &[], &mut found);
    }
    found
}

fn without_re_exports(code: &str) -> String {
    code.split(';').filter(|statement| re_exported(statement).is_none()).collect::<Vec<_>>().join(";")
}

/// Paths of a statement `pub use ...` or `pub(...) use ...`.
fn re_exported(statement: &str) -> Option<&str> {
    let rest = statement.trim_start().strip_prefix("pub")?;
    let rest = if rest.starts_with('(') { rest.split_once(')')?.1 } else { rest };
    rest.trim_start().strip_prefix("use ")
}

/// Files with the ending `.rs` below `folder`, in order.
pub fn rust_files(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).expect("a readable folder").map(|entry| entry.expect("an entry").path());
    let (folders, files): (Vec<_>, Vec<_>) = entries.partition(|path| path.is_dir());
    let mut all: Vec<_> = files.into_iter().filter(|path| path.extension().is_some_and(|e| e == "rs")).collect();
    all.extend(folders.iter().flat_map(|folder| rust_files(folder)));
    all.sort();
    all
}
