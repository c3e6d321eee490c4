//! The identified model, loaded from the bytes of a model file.

use crate::object::{kept, read, read_all, seen, start, writable, write, Object};
use crate::result::{bowden_about, bowden_result, code, told, Refused};
use crate::{bowden_motion_f32, bowden_motion_f64};
use core::slice;
use core_bowden::effect::Motion;
use core_bowden::model::{Model, ModelState, Sample, Source};

/// Maximum number of terms in a model.
pub const BOWDEN_TERMS: usize = 16;
/// Maximum number of channels in a sample.
pub const BOWDEN_CHANNELS: usize = 16;
/// Maximum size of a model, in bytes. No model with BOWDEN_TERMS terms exceeds this limit.
pub const BOWDEN_MODEL_BYTES: usize = 2048;
/// Size of bowden_model_f32 in 64-bit words.
pub const BOWDEN_MODEL_F32_WORDS: usize = 112;
/// Size of bowden_model_f64 in 64-bit words.
pub const BOWDEN_MODEL_F64_WORDS: usize = 216;

/// The checksum that `bowden identify --model-out` writes after the model.
const CHECKSUM: crc::Crc<u32> = crc::Crc::<u32>::new(&crc::CRC_32_ISO_HDLC);

/// Whether a sample can contain every channel that the model reads.
fn reads_what_there_is<T: core_bowden::Real>(model: &Model<T, BOWDEN_TERMS>) -> bool {
    model.terms().iter().all(|term| match term.source {
        Source::Input => true,
        Source::Channel(index) => usize::from(index) < BOWDEN_CHANNELS,
    })
}

macro_rules! model {
    ($f:ident, $magic:literal) => {
        pastey::paste! {
            /// Identified model with its state. Initialise it with bowden_model_load.
            #[repr(C)]
            pub struct [<bowden_model_ $f>] {
                /// Private; do not use.
                pub opaque: [u64; [<BOWDEN_MODEL_ $f:upper _WORDS>]],
            }

            // SAFETY: `repr(C)` of one array of u64.
            unsafe impl Object for [<bowden_model_ $f>] {
                type Inner = (Model<$f, BOWDEN_TERMS>, ModelState<$f, BOWDEN_TERMS>);
                const MAGIC: u64 = $magic;
            }

            /// One sample for a model.
            #[repr(C)]
            #[derive(Debug, Clone, Copy)]
            pub struct [<bowden_model_sample_ $f>] {
                /// Time since the previous sample [s], positive even at the first sample.
                pub dt: $f,
                /// Input of the transmission (x or tau_i) with its velocity and acceleration.
                pub input: [<bowden_motion_ $f>],
                /// Transmitted load: tau_i in torque mode, otherwise a load channel.
                pub load: $f,
                /// All other channels, in the order of the model file; may be null if there are
                /// none.
                pub channels: *const [<bowden_motion_ $f>],
                /// Number of elements in `channels`, at most BOWDEN_CHANNELS.
                pub channel_count: usize,
            }

            /// Converts the channels of a sample to the types of the Rust crate.
            ///
            /// # Safety
            /// `from` is null or points to `count` motions.
            pub(crate) unsafe fn [<channels_ $f>](
                from: *const [<bowden_motion_ $f>],
                count: usize,
            ) -> Result<[Motion<$f>; BOWDEN_CHANNELS], bowden_result> {
                let mut channels = [Motion::default(); BOWDEN_CHANNELS];
                // SAFETY: as of this function.
                unsafe { read_all(from, count, &mut channels, [<bowden_motion_ $f>]::motion)? };
                Ok(channels)
            }

            /// The first `count` channels of a sample.
            pub(crate) fn [<counted_ $f>](
                channels: &[Motion<$f>; BOWDEN_CHANNELS],
                count: usize,
            ) -> &[Motion<$f>] {
                channels.get(..count).unwrap_or(channels)
            }

            /// Loads a model and initialises its state. `bowden identify --model-out FILE.postcard`
            /// and `bowden export --c` write the bytes, which end with four bytes of CRC-32. After
            /// the call, the object no longer needs the bytes.
            ///
            /// `length` is the length of the model including the CRC-32, not the length of a larger
            /// array or sector. `eta` is the initial hysteresis state, from -1 to 1; 0 if unknown.
            /// `about` may be null. Errors:
            ///
            /// - BOWDEN_RESULT_ERROR_MODEL: the bytes are damaged or too many (`about` is
            ///   "checksum"), or the model is of the other precision or of another version, or has
            ///   more than BOWDEN_TERMS terms.
            /// - BOWDEN_RESULT_ERROR_CAPACITY: a term reads a channel whose index is
            ///   BOWDEN_CHANNELS or more, or `length` exceeds BOWDEN_MODEL_BYTES.
            #[no_mangle]
            pub unsafe extern "C" fn [<bowden_model_load_ $f>](
                model: *mut [<bowden_model_ $f>],
                bytes: *const u8,
                length: usize,
                eta: $f,
                about: *mut bowden_about,
            ) -> bowden_result {
                // SAFETY: the caller's rule of pointers: there are `length` bytes.
                unsafe {
                    let tried = readable(bytes, length).and_then(|bytes| {
                        let own = [<of_bytes_ $f>](bytes)?;
                        Ok(start(model, (own, ModelState::with_eta(eta)?))?)
                    });
                    told(tried, about)
                }
            }

            fn [<of_bytes_ $f>](bytes: &[u8]) -> Result<Model<$f, BOWDEN_TERMS>, Refused> {
                let read = postcard::take_from_bytes_crc32::<Model<$f, BOWDEN_TERMS>>;
                match read(bytes, CHECKSUM.digest()) {
                    Ok((own, [])) if reads_what_there_is(&own) => Ok(own),
                    Ok((_, [])) => Err(Refused::capacity("channels")),
                    // Of bytes that are left over the last four are not the checksum.
                    Ok(_) | Err(_) => Err(Refused::model(is_whole(bytes))),
                }
            }

            /// Processes one sample. `output` receives the predicted output [output unit]:
            ///
            ///     y = transmission(input, eta) + sum of gain*regressor
            ///
            /// A sample is bad if dt is not positive, a channel is missing, or a number that the
            /// model reads is not finite. A bad sample leaves the state unchanged and holds the
            /// last good output (BOWDEN_RESULT_HELD).
            #[no_mangle]
            pub unsafe extern "C" fn [<bowden_model_step_ $f>](
                model: *mut [<bowden_model_ $f>],
                sample: *const [<bowden_model_sample_ $f>],
                output: *mut $f,
            ) -> bowden_result {
                // SAFETY: the caller's rule of pointers.
                code((|| unsafe {
                    let given = read(sample)?;
                    let channels = [<channels_ $f>](given.channels, given.channel_count)?;
                    writable(output)?;
                    let (own, state) = kept(model)?;
                    let at = Sample {
                        dt: given.dt,
                        input: given.input.motion(),
                        load: given.load,
                        channels: [<counted_ $f>](&channels, given.channel_count),
                    };
                    let is_good = own.accepts(&at);
                    let value = own.step(state, &at);
                    write(output, value)?;
                    Ok(if is_good { bowden_result::Ok } else { bowden_result::Held })
                })())
            }

            /// Writes the hysteresis state, from -1 to 1, to `eta`.
            #[no_mangle]
            pub unsafe extern "C" fn [<bowden_model_eta_ $f>](
                model: *const [<bowden_model_ $f>],
                eta: *mut $f,
            ) -> bowden_result {
                // SAFETY: the caller's rule of pointers.
                code((|| unsafe {
                    let (_, state) = seen(model)?;
                    write(eta, state.eta())?;
                    Ok(bowden_result::Ok)
                })())
            }

            /// Resets the state and sets the hysteresis state to `eta`, from -1 to 1.
            #[no_mangle]
            pub unsafe extern "C" fn [<bowden_model_reset_ $f>](
                model: *mut [<bowden_model_ $f>],
                eta: $f,
            ) -> bowden_result {
                // SAFETY: the caller's rule of pointers.
                code((|| unsafe {
                    kept(model)?.1 = ModelState::with_eta(eta)?;
                    Ok(bowden_result::Ok)
                })())
            }
        }
    };
}

/// Returns the bytes of the caller.
///
/// # Safety
/// `bytes` is null or points to `length` bytes that nobody writes during the call.
unsafe fn readable<'a>(bytes: *const u8, length: usize) -> Result<&'a [u8], Refused> {
    if bytes.is_null() {
        return Err(bowden_result::ErrorNull.into());
    }
    if length > BOWDEN_MODEL_BYTES {
        return Err(Refused::capacity("bytes"));
    }
    // SAFETY: not null, so many bytes, and no more than an object may have.
    Ok(unsafe { slice::from_raw_parts(bytes, length) })
}

/// Whether the checksum at the end of the bytes is correct.
fn is_whole(bytes: &[u8]) -> bool {
    let Some((model, checksum)) = bytes.split_last_chunk::<4>() else {
        return false;
    };
    CHECKSUM.checksum(model) == u32::from_le_bytes(*checksum)
}

model!(f32, 0x6d6f_6465_6633_3240);
model!(f64, 0x6d6f_6465_6636_3440);
