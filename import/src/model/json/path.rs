//! Where a value stands, as a path from the root.

use super::{Document, Entry, Kind};

/// Most bytes of a path that are shown; the middle of a longer one is left out.
const MAX_SHOWN: usize = 400;

impl Document<'_> {
    /// The place of a value: `$.model.union[3].sphere.radius`.
    pub(in crate::model) fn path(&self, target: Entry) -> String {
        let mut path = "$".to_owned();
        let mut at = self.root();
        while at != target {
            let Some(child) = self.step(at, target, &mut path) else { break };
            at = child;
        }
        without_middle(&path)
    }

    /// The value directly in `container` that is or holds `target`.
    fn step(&self, container: Entry, target: Entry, path: &mut String) -> Option<Entry> {
        let holds = |entry: Entry| entry <= target && target.0 < self.record(entry).next;
        if self.kind(container) == Kind::List {
            let (index, child) = self.items(container).enumerate().find(|(_, item)| holds(*item))?;
            path.push_str(&format!("[{index}]"));
            return Some(child);
        }
        let (key, child) = self.members(container).find(|(key, value)| *key == target || holds(*value))?;
        path.push_str(&step_of_key(&self.text(key)));
        // A key has the place of its value.
        Some(if key == target { target } else { child })
    }
}

fn step_of_key(key: &str) -> String {
    let is_plain = key.chars().all(|c| c.is_alphanumeric() || c == '_' || c == '-') && !key.is_empty();
    if is_plain {
        return format!(".{key}");
    }
    format!("[{}]", serde_json::to_string(key).unwrap_or_default())
}

fn without_middle(path: &str) -> String {
    if path.len() <= MAX_SHOWN {
        return path.to_owned();
    }
    let boundary = |at: usize| (0..=at).rev().find(|at| path.is_char_boundary(*at)).unwrap_or(0);
    let (head, tail) = (boundary(MAX_SHOWN / 2), boundary(path.len() - MAX_SHOWN / 2));
    format!("{}…{}", &path[..head], &path[tail..])
}
