//! Readers of XML attributes, with errors that name the line, the attribute and its owner.

use roxmltree::Node;

use crate::error::{Error, Result, shortened};
use crate::message::Message;

/// Advice for unexpanded xacro.
const EXPAND: &str = "run `xacro robot.xacro > robot.urdf` and load the result";

/// Removes the XML declaration: its encoding does not apply to a decoded string, and a line break before it, as in
/// triple-quoted strings, would be an XML error. Line numbers are kept.
pub(super) fn without_declaration(text: &str) -> String {
    let start = text.trim_start_matches(|c: char| c == '\u{feff}' || c.is_whitespace());
    let body = match start.strip_prefix("<?xml ").and_then(|declaration| declaration.split_once("?>")) {
        Some((_, body)) => body,
        None => start,
    };
    let cut = &text[..text.len() - body.len()];
    "\n".repeat(cut.matches('\n').count()) + body
}

/// Creates the error for text that is not XML.
pub(super) fn not_xml(error: &roxmltree::Error) -> Error {
    let problem = match error {
        roxmltree::Error::UnknownNamespace(prefix, _) if prefix == "xacro" => {
            format!("xacro is not expanded: {EXPAND}")
        }
        roxmltree::Error::UnknownNamespace(prefix, _) => {
            format!("the namespace prefix '{prefix}' is not declared: add xmlns:{prefix}=\"{prefix}\" to <robot>")
        }
        _ => format!("not XML: {error}"),
    };
    Error::Urdf { line: Some(error.pos().row), problem: problem.into() }
}

/// Returns the line of an element, from 1.
pub(super) fn line(node: Node) -> u32 {
    node.document().text_pos_at(node.range().start).row
}

/// Returns the lines of elements in the order of the text, from 1. Takes one pass, whereas [`line`] reads from the beginning
/// for each element.
pub(super) fn lines<'a, 'x: 'a>(text: &str, nodes: impl Iterator<Item = Node<'a, 'x>>) -> Vec<u32> {
    let (mut at, mut line) = (0, 1);
    nodes
        .map(|node| {
            let start = node.range().start;
            line += text.as_bytes()[at..start].iter().filter(|byte| **byte == b'\n').count() as u32;
            at = start;
            line
        })
        .collect()
}

/// Creates an error located at an element.
pub(super) fn error_at(node: Node, problem: impl Into<Message>) -> Error {
    Error::Urdf { line: Some(line(node)), problem: problem.into() }
}

/// Checks that no element belongs to xacro.
pub(super) fn refuse_xacro(root: Node) -> Result<()> {
    let is_xacro = |node: &Node| node.tag_name().namespace().is_some_and(|uri| uri.ends_with("xacro"));
    match root.descendants().find(is_xacro) {
        None => Ok(()),
        Some(node) => Err(error_at(node, format!("<xacro:{}> is not expanded: {EXPAND}", node.tag_name().name()))),
    }
}

/// Iterates over the child elements with this tag, in any namespace.
pub(super) fn children<'a, 'x: 'a>(node: Node<'a, 'x>, tag: &'a str) -> impl Iterator<Item = Node<'a, 'x>> {
    node.children().filter(move |child| child.is_element() && child.tag_name().name() == tag)
}

/// Returns the text of an attribute. Unexpanded xacro in it is an error.
pub(super) fn attribute<'a>(node: Node<'a, '_>, name: &str) -> Result<Option<&'a str>> {
    match node.attribute(name) {
        Some(text) if text.contains("${") || text.contains("$(") => {
            Err(error_at(node, format!("{name}=\"{}\" is not expanded: {EXPAND}", shortened(text))))
        }
        text => Ok(text),
    }
}

/// Returns a required attribute; `owner` names the element.
pub(super) fn required<'a>(node: Node<'a, '_>, name: &str, owner: &str) -> Result<&'a str> {
    attribute(node, name)?.ok_or_else(|| error_at(node, format!("{owner} has no attribute {name}=\"...\"")))
}

/// Reads three finite numbers, or `None` if the attribute is missing; `what` names the numbers.
pub(super) fn vector(node: Node, name: &str, what: &str) -> Result<Option<[f64; 3]>> {
    let Some(text) = attribute(node, name)? else { return Ok(None) };
    let numbers: Vec<f64> = text.split_whitespace().map_while(|word| word.parse().ok()).collect();
    match <[f64; 3]>::try_from(numbers) {
        Ok(vector) if text.split_whitespace().count() == 3 && vector.iter().all(|x| x.is_finite()) => Ok(Some(vector)),
        _ => Err(error_at(
            node,
            format!("{what} must be 3 finite numbers separated by spaces, got '{}'", shortened(text)),
        )),
    }
}

/// Reads one number, or `None` if the attribute is missing; `what` names the number. It may be infinite, but not NaN.
pub(super) fn number(node: Node, name: &str, what: &str) -> Result<Option<f64>> {
    let Some(text) = attribute(node, name)? else { return Ok(None) };
    match text.trim().parse::<f64>() {
        Ok(number) if !number.is_nan() => Ok(Some(number)),
        _ => Err(error_at(node, format!("{what} must be a number, got '{}'", shortened(text)))),
    }
}
