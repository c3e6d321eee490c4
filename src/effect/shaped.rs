//! The effect types. Each shape parameter has a name, a range that is checked, and a private field.

use super::info::ShapeInfo;
use crate::Error;

/// The shape parameters of an effect.
pub(super) trait Shaped<T>: Sized {
    const NAMES: &'static [&'static str];
    const SHAPES: &'static [ShapeInfo];

    fn shape(&self, index: usize) -> Option<T>;
    fn with_shape(&self, index: usize, value: T) -> Result<Self, Error>;
    fn try_from_shapes(values: &[T]) -> Result<Self, Error>;
}

/// The number of values differs from the number of shape parameters.
pub(super) const COUNT: Error =
    Error::Inadmissible("there must be one value for each shape of the effect");

/// Defines the configuration of an effect with shape parameters:
/// `Name { field: Range, Dimension::UNIT; … }`, each field with its doc line.
///
/// Generates the struct, `try_new`, a getter for each field, [`Shaped`], and a `Deserialize`
/// through `try_new`.
macro_rules! shaped {
    ($(#[$doc:meta])* $config:ident {
        $($(#[$field_doc:meta])* $field:ident: $range:ident, $dimension:expr;)+
    }) => {
        $(#[$doc])*
        #[derive(Debug, Clone, Copy, PartialEq)]
        #[cfg_attr(feature = "serde", derive(serde::Serialize))]
        #[cfg_attr(feature = "defmt", derive(defmt::Format))]
        pub struct $config<T> {
            $($field: T),+
        }

        impl<T: $crate::Real> $config<T> {
            /// Checks each shape parameter, once.
            ///
            /// # Errors
            /// [`NonFinite`](crate::Error::NonFinite) or
            /// [`OutOfRange`](crate::Error::OutOfRange) with the name of the shape parameter.
            pub fn try_new($($field: T),+) -> Result<Self, $crate::Error> {
                Ok(Self {
                    $($field: $crate::effect::Range::$range.check($field, stringify!($field))?),+
                })
            }

            $(
                $(#[$field_doc])*
                #[must_use]
                pub fn $field(&self) -> T {
                    self.$field
                }
            )+
        }

        impl<T: $crate::Real> $crate::effect::shaped::Shaped<T> for $config<T> {
            const NAMES: &'static [&'static str] = &[$(stringify!($field)),+];
            const SHAPES: &'static [$crate::effect::ShapeInfo] = &[$(
                $crate::effect::ShapeInfo {
                    name: stringify!($field),
                    range: $crate::effect::Range::$range,
                    dimension: $dimension,
                }
            ),+];

            fn shape(&self, index: usize) -> Option<T> {
                [$(self.$field),+].get(index).copied()
            }

            fn with_shape(&self, index: usize, value: T) -> Result<Self, $crate::Error> {
                let mut shapes = [$(self.$field),+];
                let place = shapes.get_mut(index);
                *place.ok_or($crate::Error::OutOfRange("shape index"))? = value;
                Self::try_from_shapes(&shapes)
            }

            fn try_from_shapes(values: &[T]) -> Result<Self, $crate::Error> {
                match values {
                    &[$($field),+] => Self::try_new($($field),+),
                    _ => Err($crate::effect::shaped::COUNT),
                }
            }
        }

        #[cfg(feature = "serde")]
        const _: () = {
            #[derive(serde::Deserialize)]
            struct Fields<T> {
                $($field: T),+
            }

            impl<'de, T> serde::Deserialize<'de> for $config<T>
            where
                T: $crate::Real + serde::Deserialize<'de>,
            {
                fn deserialize<D: serde::Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
                    let fields = Fields::<T>::deserialize(from)?;
                    Self::try_new($(fields.$field),+).map_err(serde::de::Error::custom)
                }
            }
        };
    };
}
pub(super) use shaped;

/// Defines the type of an effect without shape parameters, with its doc lines.
macro_rules! plain {
    ($(#[$doc:meta])* $plain:ident) => {
        $(#[$doc])*
        #[derive(Debug, Clone, Copy, PartialEq, Eq)]
        #[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
        #[cfg_attr(feature = "defmt", derive(defmt::Format))]
        pub struct $plain;
    };
}
pub(super) use plain;
