//! Tree of links and joints, and the path from base to tip.

use std::collections::{HashMap, HashSet};

use super::document::{Document, UrdfKind};
use crate::error::{Error, Result, shortened, suggestion};
use crate::wording::listed;

/// Largest number of links of a cycle that a message lists.
const CYCLE_SHOWN: usize = 10;

/// Joints as a tree with one root.
pub(super) struct Tree<'a> {
    document: &'a Document,
    /// Joint between each link and its parent.
    joint_above: HashMap<&'a str, usize>,
    root: &'a str,
}

/// Joint on the path from base to tip.
#[derive(Debug, Clone, Copy)]
pub(super) struct TreeStep {
    pub(super) joint: usize,
    /// True if the path leads from child to parent.
    pub(super) reversed: bool,
}

impl<'a> Tree<'a> {
    /// Checks that every link has at most one parent, and that all links have the same root.
    pub(super) fn new(document: &'a Document) -> Result<Self> {
        let joint_above = joints_above(document)?;
        let mut tree = Self { document, joint_above, root: "" };
        tree.refuse_cycles()?;
        let roots: Vec<&str> = tree.links().filter(|link| !tree.joint_above.contains_key(link)).collect();
        match roots[..] {
            [root] => tree.root = root,
            _ => {
                let quoted: Vec<String> = roots.iter().map(|name| format!("'{name}'")).collect();
                let roots = listed(quoted.iter().map(String::as_str));
                let problem = format!("no joint leads to any of the links {roots}: a tree has one root");
                return Err(Error::Urdf { line: None, problem: problem.into() });
            }
        }
        Ok(tree)
    }

    fn links(&self) -> impl Iterator<Item = &'a str> {
        self.document.links.iter().map(String::as_str)
    }

    pub(super) fn root(&self) -> &'a str {
        self.root
    }

    /// Finds the link with this name.
    pub(super) fn link(&self, name: &str) -> Result<&'a str> {
        let moved_by = self.document.joints.iter().find(|joint| joint.name == name).map(|joint| &joint.child);
        self.links().find(|link| *link == name).ok_or_else(|| Error::UnknownLink {
            robot: self.document.name.clone(),
            name: shortened(name),
            suggestion: match moved_by {
                Some(link) => format!(" (did you mean '{link}', the link that the joint of this name moves?)"),
                None => suggestion(name, self.links()),
            },
            known: listed(self.links()),
        })
    }

    /// Returns the only leaf link below `base`.
    pub(super) fn only_leaf_below(&self, base: &'a str) -> Result<&'a str> {
        let mut leaves = self.leaves_below(base);
        if let [(leaf, _)] = leaves[..] {
            return Ok(leaf);
        }
        // Arms before wheels and sensors, since a user usually looks for the end of an arm.
        leaves.sort_by_key(|(_, joints)| std::cmp::Reverse(*joints));
        let described: Vec<String> = leaves.iter().map(|(leaf, joints)| format!("{leaf} ({joints})")).collect();
        Err(Error::AmbiguousTip {
            robot: self.document.name.clone(),
            count: leaves.len(),
            leaves: listed(described.iter().map(String::as_str)),
        })
    }

    /// Returns the leaf links below `base` in the order of the document, each with the number of independent joints that move
    /// it.
    fn leaves_below(&self, base: &'a str) -> Vec<(&'a str, usize)> {
        let joints = &self.document.joints;
        let below = self.joints_below();
        let (mut leaves, mut open) = (HashMap::new(), vec![(base, 0)]);
        while let Some((link, moved_by)) = open.pop() {
            match below.get(link) {
                None => _ = leaves.insert(link, moved_by),
                Some(next) => open.extend(next.iter().map(|index| {
                    let joint = &joints[*index];
                    let independent = joint.kind != UrdfKind::Fixed && joint.mimic.is_none();
                    (joint.child.as_str(), moved_by + usize::from(independent))
                })),
            }
        }
        self.links().filter_map(|link| Some((link, *leaves.get(link)?))).collect()
    }

    /// Returns the joints below each link.
    fn joints_below(&self) -> HashMap<&'a str, Vec<usize>> {
        let mut below: HashMap<&str, Vec<usize>> = HashMap::new();
        for (index, joint) in self.document.joints.iter().enumerate() {
            below.entry(&joint.parent).or_default().push(index);
        }
        below
    }

    /// Returns the links that are not on the chain, in the order in which they branch off, parents first. Each has the number
    /// of the link before it, counting the chain's links first, and the joint in between.
    pub(super) fn off_chain(&self, chain: &[&str]) -> Vec<(usize, TreeStep)> {
        let (joints, below) = (&self.document.joints, self.joints_below());
        let mut found: HashSet<&str> = chain.iter().copied().collect();
        let mut links = chain.to_vec();
        let mut beside = vec![];
        let mut number = 0;
        while let Some(&link) = links.get(number) {
            let up = self.joint_above.get(link).map(|joint| (*joint, true, joints[*joint].parent.as_str()));
            let down = below.get(link).into_iter().flatten().map(|j| (*j, false, joints[*j].child.as_str()));
            for (joint, reversed, next) in up.into_iter().chain(down) {
                if found.insert(next) {
                    beside.push((number, TreeStep { joint, reversed }));
                    links.push(next);
                }
            }
            number += 1;
        }
        beside
    }

    /// Returns the joints from `base` to `tip`: up to the common ancestor, then down.
    pub(super) fn path(&self, base: &'a str, tip: &'a str) -> Result<Vec<TreeStep>> {
        if base == tip {
            let problem = format!("base and tip are both '{base}': a chain needs two links");
            return Err(Error::Urdf { line: None, problem: problem.into() });
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

    /// Iterates over the joints from a link up to the root.
    fn joints_above(&self, link: &'a str) -> impl Iterator<Item = usize> {
        let joints = &self.document.joints;
        let above = |link: &str| self.joint_above.get(link).copied();
        std::iter::successors(above(link), move |joint| above(&joints[*joint].parent))
    }

    /// Iterates over the links from a link's parent up to the root.
    fn links_above(&self, link: &'a str) -> impl Iterator<Item = &'a str> {
        self.joints_above(link).map(|joint| self.document.joints[joint].parent.as_str())
    }

    /// Returns an error if the way up from a link is a cycle. The walk stops where an earlier one passed, so that each link
    /// is visited once.
    fn refuse_cycles(&self) -> Result<()> {
        let mut passed_from = HashMap::new();
        for start in self.links() {
            for link in std::iter::once(start).chain(self.links_above(start)) {
                match passed_from.insert(link, start) {
                    None => {}
                    Some(earlier) if earlier == start => return Err(self.cycle_through(link)),
                    Some(_) => break,
                }
            }
        }
        Ok(())
    }

    fn cycle_through(&self, link: &'a str) -> Error {
        let above = self.links_above(link).take_while(|above| *above != link);
        let mut cycle: Vec<&str> = [link].into_iter().chain(above).chain([link]).collect();
        cycle.reverse();
        let links = cycle.len() - 1;
        let problem = match links {
            ..=CYCLE_SHOWN => format!("the joints form a cycle: {}", cycle.join(" -> ")),
            _ => format!("the joints form a cycle of {links} links through '{link}'"),
        };
        self.document.error_at(self.joint_above[link], problem)
    }
}

/// Returns the joint above each link, or an error for a joint between links that do not exist, or two joints to one link.
fn joints_above(document: &Document) -> Result<HashMap<&str, usize>> {
    let links: Vec<&str> = document.links.iter().map(String::as_str).collect();
    let known: HashSet<&str> = links.iter().copied().collect();
    let mut above = HashMap::new();
    for (index, joint) in document.joints.iter().enumerate() {
        let name = &joint.name;
        for (end, link) in [("parent", &joint.parent), ("child", &joint.child)] {
            if !known.contains(link.as_str()) {
                let (hint, known) = (suggestion(link, links.iter().copied()), listed(links));
                let problem = format!("{end} link '{link}' of joint '{name}' does not exist{hint}; links: {known}");
                return Err(document.error_at(index, problem));
            }
        }
        let child = joint.child.as_str();
        if let Some(other) = above.insert(child, index) {
            let other = &document.joints[other].name;
            let problem =
                format!("link '{child}' is the child of two joints, '{other}' and '{name}': a tree has no loops");
            return Err(document.error_at(index, problem));
        }
    }
    Ok(above)
}
