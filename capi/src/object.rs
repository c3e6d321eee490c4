//! Reads, checks and writes the memory behind a pointer from C.
//!
//! An [`Object`] is memory that the caller owns. It contains a magic word, Rust data, and the
//! inverted magic word. The first word reveals uninitialised memory, except with a probability of
//! 2^-64. The last word reveals a write beyond the end of an array.

use crate::bowden_result;
use crate::result::Refused;
use crate::settings::Marked;
use core::ffi::CStr;
use core::ops::Range;
use core::ptr;
use core::slice;

/// Memory that the caller owns and that contains Rust data.
///
/// # Safety
/// `Self` is `repr(C)` of an array of `u64` and nothing else.
pub(crate) unsafe trait Object: Sized {
    /// The type of the data.
    type Inner: Copy;
    /// The magic word, different for every type.
    const MAGIC: u64;
    /// Checks that the data fits between the two words and is aligned.
    const FITS: () = assert!(
        size_of::<Self::Inner>() + 2 * size_of::<u64>() <= size_of::<Self>()
            && align_of::<Self::Inner>() <= align_of::<Self>()
            && align_of::<Self>() == align_of::<u64>()
    );
}

/// The address of the data, after the first word.
fn inner_of<O: Object>(object: *mut O) -> *mut O::Inner {
    let () = O::FITS;
    object.cast::<u64>().wrapping_add(1).cast()
}

fn last_of<O: Object>(object: *mut O) -> *mut u64 {
    object
        .cast::<u64>()
        .wrapping_add(size_of::<O>() / size_of::<u64>() - 1)
}

fn is_placed<X>(at: *const X) -> Result<(), bowden_result> {
    if at.is_null() {
        Err(bowden_result::ErrorNull)
    } else if !at.is_aligned() {
        Err(bowden_result::ErrorMisaligned)
    } else {
        Ok(())
    }
}

/// Initialises an object with `inner` and overwrites its previous contents.
///
/// # Safety
/// `object` is null or points to writable memory of its type.
pub(crate) unsafe fn start<O: Object>(
    object: *mut O,
    inner: O::Inner,
) -> Result<(), bowden_result> {
    is_placed(object)?;
    // SAFETY: placed, and memory of its type: the three places lie within it by `O::FITS`. No
    // interrupt takes the object for a good one before all of it is there.
    unsafe {
        ptr::write_volatile(object.cast::<u64>(), 0);
        ptr::write(inner_of(object), inner);
        ptr::write_volatile(last_of(object), !O::MAGIC);
        ptr::write_volatile(object.cast::<u64>(), O::MAGIC);
    }
    Ok(())
}

/// Checks that an object was initialised.
///
/// # Safety
/// `object` is null or points to memory of its type.
unsafe fn is_started<O: Object>(object: *const O) -> Result<(), bowden_result> {
    is_placed(object)?;
    let last = last_of(object.cast_mut());
    // SAFETY: placed, and memory of its type. Volatile: the words count as they are there.
    let (first, last) = unsafe {
        (
            ptr::read_volatile(object.cast::<u64>()),
            ptr::read_volatile(last),
        )
    };
    if first == O::MAGIC && last == !O::MAGIC {
        Ok(())
    } else {
        Err(bowden_result::ErrorUninitialised)
    }
}

/// The data of an initialised object.
///
/// # Safety
/// `object` is null or points to memory of its type that nobody else uses during the call.
pub(crate) unsafe fn kept<'a, O: Object>(
    object: *mut O,
) -> Result<&'a mut O::Inner, bowden_result> {
    // SAFETY: both words are those that `start` writes after the inner one, which lies within
    // the object and is aligned by `O::FITS`; nobody else uses it.
    unsafe {
        is_started(object)?;
        Ok(&mut *inner_of(object))
    }
}

/// The data of an initialised object, for reading only.
///
/// # Safety
/// `object` is null or points to memory of its type that nobody writes during the call.
pub(crate) unsafe fn seen<'a, O: Object>(object: *const O) -> Result<&'a O::Inner, bowden_result> {
    // SAFETY: as of `kept`; nobody writes to it.
    unsafe {
        is_started(object)?;
        Ok(&*inner_of(object.cast_mut()).cast_const())
    }
}

/// Reads a value from the caller. Every bit pattern of the value is valid, because it consists of
/// numbers.
///
/// # Safety
/// `from` is null or points to a value of its type, which consists of numbers and pointers.
pub(crate) unsafe fn read<X: Copy>(from: *const X) -> Result<X, bowden_result> {
    is_placed(from)?;
    // SAFETY: placed, and of numbers and pointers only.
    Ok(unsafe { ptr::read(from) })
}

/// Reads settings from the caller. The mark is read first; without it nothing else is read.
///
/// # Safety
/// `from` is null or points to a `u32`. If that word is the mark, `from` points to a value of its
/// type.
pub(crate) unsafe fn read_settings<S: Marked>(from: *const S) -> Result<S, Refused> {
    is_placed(from)?;
    // SAFETY: placed, and a `u32` is first.
    S::is_marked(unsafe { ptr::read(from.cast::<u32>()) })?;
    // SAFETY: placed, and of numbers only; the mark says that it is the struct.
    Ok(unsafe { ptr::read(from) })
}

/// Reads `count` values of an array into `places`. The pointer to an empty array may be null.
///
/// # Safety
/// `from` is null or points to `count` values, which consist of numbers.
pub(crate) unsafe fn read_all<X: Copy, Y>(
    from: *const X,
    count: usize,
    places: &mut [Y],
    own: impl Fn(X) -> Y,
) -> Result<(), bowden_result> {
    let places = places
        .get_mut(..count)
        .ok_or(bowden_result::ErrorCapacity)?;
    if count == 0 {
        return Ok(());
    }
    is_placed(from)?;
    for (index, place) in places.iter_mut().enumerate() {
        // SAFETY: placed, and there are so many.
        *place = own(unsafe { ptr::read(from.wrapping_add(index)) });
    }
    Ok(())
}

/// Writes a value to the memory of the caller.
///
/// # Safety
/// `to` is null or points to writable memory of its type.
pub(crate) unsafe fn write<X: Copy>(to: *mut X, value: X) -> Result<(), bowden_result> {
    is_placed(to)?;
    // SAFETY: placed, and memory of its type.
    unsafe { ptr::write(to, value) };
    Ok(())
}

/// Checks that a pointer is writable, before a step changes its state.
pub(crate) fn writable<X>(to: *const X) -> Result<(), bowden_result> {
    is_placed(to)
}

/// An array of numbers that the caller lends to an object for as long as the object is used.
#[repr(C)]
#[derive(Clone, Copy)]
pub(crate) struct Lent<X> {
    first: *mut X,
    count: usize,
}

impl<X: Copy> Lent<X> {
    /// Checks that the array is aligned and lies within the address space.
    ///
    /// # Safety
    /// `first` is null or points to writable memory for `count` numbers. The memory stays valid for
    /// as long as the array or a copy of it is used, and nobody else uses it during a call.
    pub(crate) unsafe fn new(first: *mut X, count: usize) -> Result<Self, bowden_result> {
        is_placed(first)?;
        let end = count
            .checked_mul(size_of::<X>())
            .filter(|bytes| isize::try_from(*bytes).is_ok())
            .and_then(|bytes| first.addr().checked_add(bytes));
        match end {
            Some(_) => Ok(Self { first, count }),
            None => Err(bowden_result::ErrorCapacity),
        }
    }

    /// The addresses of the bytes.
    fn bytes(&self) -> Range<usize> {
        self.first.addr()..self.first.wrapping_add(self.count).addr()
    }

    /// Whether the two arrays share a byte.
    pub(crate) fn overlaps(&self, other: &Self) -> bool {
        meet(&self.bytes(), &other.bytes())
    }

    /// Whether the array and the object share a byte.
    pub(crate) fn overlaps_object<O: Object>(&self, object: *const O) -> bool {
        let end = object.wrapping_add(1);
        meet(&self.bytes(), &(object.addr()..end.addr()))
    }

    /// Writes the same number to every element.
    pub(crate) fn fill(&mut self, value: X) {
        for index in 0..self.count {
            // SAFETY: writable memory for so many, as of `new`.
            unsafe { ptr::write(self.first.wrapping_add(index), value) };
        }
    }
}

/// Whether two ranges overlap.
fn meet(one: &Range<usize>, other: &Range<usize>) -> bool {
    one.start < other.end && other.start < one.end
}

impl<X> AsRef<[X]> for Lent<X> {
    fn as_ref(&self) -> &[X] {
        // SAFETY: placed, so many, and of no more bytes than there can be, as of `new`; whoever lends
        // it or calls `fill` has written numbers there, and nobody writes to it during a call.
        unsafe { slice::from_raw_parts(self.first, self.count) }
    }
}

impl<X> AsMut<[X]> for Lent<X> {
    fn as_mut(&mut self) -> &mut [X] {
        // SAFETY: as of `as_ref`; nobody else uses it during a call.
        unsafe { slice::from_raw_parts_mut(self.first, self.count) }
    }
}

/// A literal that ends with a NUL.
pub(crate) fn read_text(text: &'static str) -> &'static CStr {
    CStr::from_bytes_with_nul(text.as_bytes()).unwrap_or(c"")
}
