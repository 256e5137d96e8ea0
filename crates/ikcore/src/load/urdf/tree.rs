//! The tree of links and joints, and the path through it from base to tip.

use std::collections::HashMap;

use super::document::Document;
use crate::error::{Error, Result, suggestion};

/// The joints as a tree with one root.
pub(super) struct Tree<'a> {
    document: &'a Document,
    /// The joint between each link and its parent.
    joint_above: HashMap<&'a str, usize>,
    root: &'a str,
}

/// A joint on the path from base to tip.
#[derive(Debug, Clone, Copy)]
pub(super) struct TreeStep {
    pub(super) joint: usize,
    /// True if the path leads from child to parent.
    pub(super) reversed: bool,
}

impl<'a> Tree<'a> {
    /// Checks that every link has at most one parent, and all have the same root.
    pub(super) fn new(document: &'a Document) -> Result<Self> {
        let joint_above = joints_above(document)?;
        let links = || document.model.links.iter().map(|link| link.name.as_str());
        let roots: Vec<&str> = links().filter(|link| !joint_above.contains_key(link)).collect();
        let mut tree = Self { document, joint_above, root: "" };
        for link in links() {
            tree.refuse_cycle(link)?;
        }
        match roots[..] {
            [root] => tree.root = root,
            _ => {
                let problem = format!("no joint leads to any of the links {}: a tree has one root", quoted(&roots));
                return Err(Error::Urdf { line: None, problem });
            }
        }
        Ok(tree)
    }

    pub(super) fn root(&self) -> &'a str {
        self.root
    }

    /// The link of this name.
    pub(super) fn link(&self, name: &str) -> Result<&'a str> {
        let model = &self.document.model;
        let links = || model.links.iter().map(|link| link.name.as_str());
        let moved_by = model.joints.iter().find(|joint| joint.name == name).map(|joint| &joint.child.link);
        links().find(|link| *link == name).ok_or_else(|| Error::UnknownLink {
            robot: model.name.clone(),
            name: name.into(),
            suggestion: match moved_by {
                Some(link) => format!(" (did you mean '{link}', the link that the joint of this name moves?)"),
                None => suggestion(name, links()),
            },
            known: links().collect::<Vec<_>>().join(", "),
        })
    }

    /// The only leaf link below `base`.
    pub(super) fn only_leaf_below(&self, base: &str) -> Result<&'a str> {
        let model = &self.document.model;
        let is_leaf = |link: &str| model.joints.iter().all(|joint| joint.parent.link != link);
        let is_below = |link: &'a str| link == base || self.links_above(link).any(|ancestor| ancestor == base);
        let links = model.links.iter().map(|link| link.name.as_str());
        let leaves: Vec<&str> = links.filter(|link| is_leaf(link) && is_below(link)).collect();
        match leaves[..] {
            [leaf] => Ok(leaf),
            _ => Err(Error::AmbiguousTip { robot: model.name.clone(), leaves: leaves.join(", ") }),
        }
    }

    /// The joints from `base` to `tip`: up to the common ancestor, then down.
    pub(super) fn path(&self, base: &'a str, tip: &'a str) -> Result<Vec<TreeStep>> {
        if base == tip {
            let problem = format!("base and tip are both '{base}': a chain needs two links");
            return Err(Error::Urdf { line: None, problem });
        }
        let mut up: Vec<usize> = self.joints_above(base).collect();
        let mut down: Vec<usize> = self.joints_above(tip).collect();
        while let (Some(a), Some(b)) = (up.last(), down.last())
            && a == b
        {
            up.pop();
            down.pop();
        }
        let up = up.into_iter().map(|joint| TreeStep { joint, reversed: true });
        let down = down.into_iter().rev().map(|joint| TreeStep { joint, reversed: false });
        Ok(up.chain(down).collect())
    }

    /// The joints from a link up to the root.
    fn joints_above(&self, link: &'a str) -> impl Iterator<Item = usize> {
        let joints = &self.document.model.joints;
        let above = |link: &str| self.joint_above.get(link).copied();
        std::iter::successors(above(link), move |joint| above(&joints[*joint].parent.link))
    }

    /// The links from a link's parent up to the root.
    fn links_above(&self, link: &'a str) -> impl Iterator<Item = &'a str> {
        self.joints_above(link).map(|joint| self.document.model.joints[joint].parent.link.as_str())
    }

    /// Checks that the parents of `start` do not lead back to it.
    fn refuse_cycle(&self, start: &'a str) -> Result<()> {
        let mut cycle = vec![start];
        for link in self.links_above(start).take(self.document.model.links.len()) {
            cycle.push(link);
            if link == start {
                cycle.reverse();
                let problem = format!("the joints form a cycle: {}", cycle.join(" -> "));
                return Err(self.document.error_at(self.joint_above[start], problem));
            }
        }
        Ok(())
    }
}

/// Returns the joint above each link. An error for a joint between links that do not exist, or two joints to one link.
fn joints_above(document: &Document) -> Result<HashMap<&str, usize>> {
    let model = &document.model;
    let links: Vec<&str> = model.links.iter().map(|link| link.name.as_str()).collect();
    let known: std::collections::HashSet<&str> = links.iter().copied().collect();
    let mut above = HashMap::new();
    for (index, joint) in model.joints.iter().enumerate() {
        let name = &joint.name;
        for (end, link) in [("parent", &joint.parent.link), ("child", &joint.child.link)] {
            if !known.contains(link.as_str()) {
                let (hint, known) = (suggestion(link, links.iter().copied()), links.join(", "));
                let problem = format!("{end} link '{link}' of joint '{name}' does not exist{hint}; links: {known}");
                return Err(document.error_at(index, problem));
            }
        }
        let child = joint.child.link.as_str();
        if let Some(other) = above.insert(child, index) {
            let other = &model.joints[other].name;
            let problem =
                format!("link '{child}' is the child of two joints, '{other}' and '{name}': a tree has no loops");
            return Err(document.error_at(index, problem));
        }
    }
    Ok(above)
}

fn quoted(names: &[&str]) -> String {
    names.iter().map(|name| format!("'{name}'")).collect::<Vec<_>>().join(", ")
}
