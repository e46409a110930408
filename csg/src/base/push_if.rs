//! Lists of what fulfils a condition, where a processor would mostly guess wrong whether it does.

/// Adds an element to a list where a condition holds, without a branch on it: the element is put there in any case, and the list ends before it where the condition does not hold.
#[inline]
pub(crate) fn push_if<T>(list: &mut Vec<T>, element: T, condition: bool) {
    list.push(element);
    list.truncate(list.len() - usize::from(!condition));
}
