//! Name patterns with `*` and `?`.

/// Whether `name` as a whole matches one of `patterns`, without regard to ASCII case.
pub(super) fn matches_any(patterns: &[String], name: &str) -> bool {
    patterns.iter().any(|pattern| matches(pattern, name))
}

/// Whether `name` as a whole matches `pattern`. Takes at most `O(pattern · name)` steps: only the last `*` is retried.
fn matches(pattern: &str, name: &str) -> bool {
    let (mut pattern, mut name) = (pattern.chars(), name.chars());
    // What to go back to: the pattern behind the last `*`, and the name from the character that `*` takes next.
    let mut retry = None;
    loop {
        let before = name.clone();
        match (pattern.next(), name.next()) {
            (None, None) => return true,
            (Some('*'), _) => {
                retry = Some((pattern.clone(), before.clone()));
                name = before;
            }
            (Some(p), Some(c)) if p == '?' || p.eq_ignore_ascii_case(&c) => {}
            _ => {
                let Some((after_star, taken)) = &mut retry else { return false };
                if taken.next().is_none() {
                    return false;
                }
                (pattern, name) = (after_star.clone(), taken.clone());
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::matches;

    /// The definition, by recursion; exponential, for short inputs only.
    fn oracle(pattern: &[char], name: &[char]) -> bool {
        match pattern.split_first() {
            None => name.is_empty(),
            Some(('*', rest)) => (0..=name.len()).any(|taken| oracle(rest, &name[taken..])),
            Some((p, rest)) => {
                name.first().is_some_and(|c| *p == '?' || p.eq_ignore_ascii_case(c)) && oracle(rest, &name[1..])
            }
        }
    }

    /// All strings over `alphabet` of up to `length` characters.
    fn strings(alphabet: &[char], length: usize) -> Vec<String> {
        let mut all = vec![String::new()];
        let mut from = 0;
        for _ in 0..length {
            let longer: Vec<String> =
                all[from..].iter().flat_map(|s| alphabet.iter().map(move |c| format!("{s}{c}"))).collect();
            from = all.len();
            all.extend(longer);
        }
        all
    }

    #[test]
    fn agrees_with_the_definition_on_all_short_strings() {
        for pattern in strings(&['a', 'B', '*', '?'], 4) {
            for name in strings(&['A', 'b'], 5) {
                let chars = |s: &str| s.chars().collect::<Vec<_>>();
                assert_eq!(matches(&pattern, &name), oracle(&chars(&pattern), &chars(&name)), "{pattern} on {name}");
            }
        }
    }

    #[test]
    fn texture_names() {
        assert!(matches("*water*", "*WATER1"));
        assert!(matches("hint*", "HintSkip"));
        assert!(matches("caf?", "café"));
        assert!(!matches("clip", "playerclip"));
    }

    #[test]
    fn many_stars_stay_cheap() {
        let name = "a".repeat(20_000);
        assert!(!matches(&format!("{}b", "*a".repeat(50)), &name));
    }
}
