//! What needs what: an order in which everything comes after what it needs, or a circle.

use crate::source::shorten;

/// An order of `0..needs.len()` in which each comes after all that it needs.
///
/// # Errors
/// A circle, each needing the next and the last the first.
pub(super) fn order(needs: &[Vec<usize>]) -> Result<Vec<usize>, Vec<usize>> {
    #[derive(Clone, Copy, PartialEq)]
    enum Mark {
        New,
        Open,
        Done,
    }
    let mut marks = vec![Mark::New; needs.len()];
    let mut order = Vec::with_capacity(needs.len());
    // Depth first, with a stack of our own: each entry is a vertex and how many of its needs were looked at.
    let mut open: Vec<(usize, usize)> = Vec::new();
    for start in 0..needs.len() {
        if marks[start] == Mark::New {
            marks[start] = Mark::Open;
            open.push((start, 0));
        }
        while let Some((vertex, seen)) = open.last_mut() {
            let Some(&next) = needs[*vertex].get(*seen) else {
                marks[*vertex] = Mark::Done;
                order.push(*vertex);
                open.pop();
                continue;
            };
            *seen += 1;
            match marks[next] {
                Mark::New => {
                    marks[next] = Mark::Open;
                    open.push((next, 0));
                }
                Mark::Open => {
                    let circle = open.iter().map(|(vertex, _)| *vertex).skip_while(|vertex| *vertex != next);
                    return Err(circle.collect());
                }
                Mark::Done => {}
            }
        }
    }
    Ok(order)
}

/// A circle for people: `a → b → a`, the middle of a long one left out.
pub(super) fn describe_circle<'n>(circle: &[usize], name: impl Fn(usize) -> &'n str) -> String {
    const MOST: usize = 6;
    let mut shown: Vec<String> = circle.iter().take(MOST).map(|vertex| shorten(name(*vertex))).collect();
    if circle.len() > MOST {
        shown.push("…".to_owned());
    }
    shown.extend(circle.first().map(|vertex| shorten(name(*vertex))));
    shown.join(" → ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn everything_comes_after_what_it_needs() {
        let needs = [vec![2, 1], vec![3], vec![1, 3, 3], vec![]];
        let order = order(&needs).expect("no circle");
        let place = |vertex| order.iter().position(|v| *v == vertex).expect("in the order");
        assert_eq!(order.len(), needs.len());
        for (vertex, needed) in needs.iter().enumerate() {
            assert!(needed.iter().all(|other| place(*other) < place(vertex)), "{order:?}");
        }
    }

    #[test]
    fn a_circle_is_found_and_told() {
        let needs = [vec![1], vec![2, 3], vec![], vec![1]];
        let circle = order(&needs).expect_err("a circle");
        assert_eq!(circle, [1, 3]);
        assert_eq!(describe_circle(&circle, |vertex| ["a", "b", "c", "d"][vertex]), "b → d → b");
        assert_eq!(order(&[vec![0]]), Err(vec![0]));
    }

    #[test]
    fn a_long_chain_needs_no_stack() {
        let needs: Vec<Vec<usize>> =
            (1..=1_000_000).map(|next| if next < 1_000_000 { vec![next] } else { vec![] }).collect();
        assert_eq!(order(&needs).map(|order| order[0]), Ok(999_999));
    }
}
