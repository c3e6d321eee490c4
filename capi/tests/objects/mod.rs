//! Memory as a C caller has it before the call.

/// A struct of numbers, all bits zero.
pub fn blank<T>() -> T {
    // SAFETY: what is made here are structs of numbers, enums that have a zero, and arrays.
    unsafe { std::mem::zeroed() }
}
