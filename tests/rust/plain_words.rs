//! The core speaks of robots: no keyword of Python and no flag of the command line is in its messages and its documentation.

use std::fs;
use std::path::Path;

use crate::layers::imports::rust_files;

/// Words of an interface.
const FOREIGN: &[&str] = &["Python", "numpy", "NumPy", "dict", "keyword", "kwargs", "command line", "True", "None"];

/// English sentences may begin with these.
const ENGLISH: &[&str] = &["True", "None"];

#[test]
fn the_core_names_no_syntax_of_python_or_a_shell() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut found = vec![];
    for path in rust_files(&root) {
        let text = fs::read_to_string(&path).expect("a readable file");
        let text = text.split("#[cfg(test)]\nmod tests").next().unwrap_or_default();
        let (literals, comments) = (literals(text), doc_comments(text));
        let faults = literals.iter().filter(|literal| is_foreign(literal));
        let faults = faults.chain(comments.iter().filter(|comment| is_foreign(&without(comment, ENGLISH))));
        found.extend(faults.map(|fault| format!("{}: {fault}", path.display())));
    }
    assert!(
        found.is_empty(),
        "words of an interface in the core; let it name a Setting instead:\n{}\n",
        found.join("\n")
    );
}

#[test]
fn foreign_syntax_is_recognised() {
    for foreign in [
        "give limits=Limits(velocity=...)",
        "ease=True (--ease)",
        "use --ease",
        "margin= needs obstacles",
        "task= of several tips is a dict",
        "call with_capsules(radius=...)",
        "run plan.retime(limits)",
        "prefer=\"nearest\"",
        "free_start is None",
    ] {
        assert!(is_foreign(foreign), "{foreign}");
    }
    for plain in [
        "q = 0, v >= 1, a != b, x == y",
        "at t = {t} s",
        "the targets contradict each other",
        "eq. (11)",
        "a pose (4, 4)",
        "<robot name=\"arm\">",
        "it is near -- too near",
        "from [`Robot::named`]",
        "x <= y",
    ] {
        assert!(!is_foreign(plain), "{plain}");
    }
    assert_eq!(literals("f(\"a \\\" b\", r#\"c\"d\"#, 'x', '\"') // \"e\""), ["a \\\" b", "c\"d"]);
}

/// Whether a text has a keyword argument, a flag, a call of a method or a word of an interface.
fn is_foreign(text: &str) -> bool {
    let is_name = |c: char| c.is_alphanumeric() || c == '_';
    let text = if text.contains('<') { "" } else { text }; // XML
    let keyword = text.match_indices('=').any(|(at, _)| {
        let next = text[at + 1..].chars().next();
        text[..at].ends_with(is_name) && !matches!(next, Some('=' | '>'))
    });
    let flag = text.match_indices("--").any(|(at, _)| {
        let (before, after) = (&text[..at], &text[at + 2..]);
        !before.ends_with(|c: char| c == '-' || is_name(c)) && after.starts_with(|c: char| c.is_ascii_lowercase())
    });
    let called = |at: usize| {
        let name = text[..at].rsplit(|c: char| !is_name(c)).next().unwrap_or_default();
        text[..at - name.len()].ends_with('.') && name.starts_with(char::is_alphabetic)
    };
    let call = text.contains("(...)") || text.match_indices('(').any(|(at, _)| called(at));
    let word =
        FOREIGN.iter().any(|word| text.split(|c: char| !is_name(c) && c != ' ').any(|part| contains_word(part, word)));
    keyword || flag || call || word
}

fn contains_word(text: &str, word: &str) -> bool {
    format!(" {text} ").contains(&format!(" {word} "))
}

fn without(text: &str, words: &[&str]) -> String {
    words.iter().fold(text.to_owned(), |text, word| text.replace(word, ""))
}

/// The string literals of `code`, without quotes.
fn literals(code: &str) -> Vec<String> {
    let (mut found, mut rest) = (vec![], code);
    while let Some(at) = rest.find(['"', '\'', '/']) {
        let (before, here) = (&rest[..at], &rest[at..]);
        let length = if here.starts_with("//") {
            here.find('\n').unwrap_or(here.len())
        } else if here.starts_with('"') && before.ends_with("r#") {
            here.find("\"#").map_or(here.len(), |end| end + 2)
        } else if here.starts_with('"') {
            quoted(here)
        } else if let Some(escaped) = here.strip_prefix("'\\") {
            2 + escaped.find('\'').map_or(0, |end| end + 1)
        } else if here.starts_with('\'') && here.chars().nth(2) == Some('\'') {
            here.char_indices().nth(3).map_or(here.len(), |(end, _)| end)
        } else {
            1
        };
        if here.starts_with('"') {
            found.push(here[..length].trim_matches('#').trim_matches('"').to_owned());
        }
        rest = &here[length..];
    }
    found
}

/// The length of the literal that `text` begins with.
fn quoted(text: &str) -> usize {
    let mut escaped = false;
    let end = text.char_indices().skip(1).find(|(_, c)| {
        let ends = *c == '"' && !escaped;
        escaped = *c == '\\' && !escaped;
        ends
    });
    end.map_or(text.len(), |(end, _)| end + 1)
}

/// The lines of documentation, examples of code left out.
fn doc_comments(text: &str) -> Vec<String> {
    let mut in_code = false;
    let lines = text.lines().map(str::trim_start).filter(|line| line.starts_with("///") || line.starts_with("//!"));
    let lines = lines.filter(|line| {
        let fence = line.contains("```");
        in_code ^= fence;
        !in_code && !fence
    });
    lines.map(str::to_owned).collect()
}
