//! Text in XML.

/// Text for an attribute in XML; characters that XML has no place for are replaced.
pub(crate) fn escaped(text: &str) -> String {
    let mut safe = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => safe.push_str("&amp;"),
            '<' => safe.push_str("&lt;"),
            '>' => safe.push_str("&gt;"),
            '"' => safe.push_str("&quot;"),
            '\u{fffe}' | '\u{ffff}' => safe.push('\u{fffd}'),
            c if c.is_control() => safe.push('\u{fffd}'),
            c => safe.push(c),
        }
    }
    safe
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_legal_in_attributes() {
        assert_eq!(escaped("a<b>&\"c\"\n\0 Wände"), "a&lt;b&gt;&amp;&quot;c&quot;\u{fffd}\u{fffd} Wände");
    }
}
