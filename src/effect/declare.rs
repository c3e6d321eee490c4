//! The macro that declares an effect: its type, its properties and its regressor.

/// Declares an effect:
///
/// ```text
/// effect! {
///     /// Documentation.
///     Name { shape: Range, Dimension; … }     or   Name;
///     "name" in "family": "formula", Dimension, reads Quantity …, memory;
///     value(it, state, at) = the regressor of a sample;
///     further functions of the trait
/// }
/// ```
/// `stage Input` before `reads` makes the effect an input stage. Omit `memory` for an effect
/// without memory. In `value`, `it` is the effect. The macro generates the type, `try_new` for the
/// shape parameters, a `Deserialize` that calls `try_new`, and the implementation of
/// [`Regressor`](super::Regressor).
macro_rules! effect {
    ($(#[$doc:meta])* $effect:ident; $($rest:tt)+) => {
        $(#[$doc])*
        #[derive(Debug, Clone, Copy, PartialEq, Eq)]
        #[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
        #[cfg_attr(feature = "defmt", derive(defmt::Format))]
        pub struct $effect;

        impl $crate::effect::info::sealed::Sealed for $effect {}

        $crate::effect::declare::effect! { @ $effect, $effect, [Ok($effect)] {} $($rest)+ }
    };

    ($(#[doc = $doc:expr])* $effect:ident {
        $($(#[doc = $field_doc:expr])* $field:ident: $range:ident, $dimension:expr;)+
    } $($rest:tt)+) => {
        $crate::checked::stored! {
            $(#[doc = $doc])*
            pub struct $effect<T> {
                $($(#[doc = $field_doc])* $field: T,)+
            }
            => { Self::try_new($($field),+) }
        }

        impl<T> $crate::effect::info::sealed::Sealed for $effect<T> {}

        impl<T: $crate::Real> $effect<T> {
            /// The effect with these shape parameters.
            ///
            /// # Errors
            /// [`NonFinite`](crate::Error::NonFinite) or [`OutOfRange`](crate::Error::OutOfRange)
            /// with the name of the invalid shape parameter.
            pub fn try_new($($field: T),+) -> Result<Self, $crate::Error> {
                Ok(Self {
                    $($field: $crate::effect::Range::$range.check($field, stringify!($field))?),+
                })
            }
        }

        $crate::effect::declare::effect! {
            @ $effect, $effect<T>, [Self::try_new($($field),+)]
            { $($field: $range, $dimension;)+ } $($rest)+
        }
    };

    (@ $effect:ident, $own:ty, [$made:expr] { $($field:ident: $range:ident, $dimension:expr;)* }
     $name:literal in $family:literal: $formula:literal, $unit:expr,
     $(stage $stage:ident,)? reads $($reads:ident)* $(, $memory:ident)?;
     value($it:pat_param, $state:pat_param, $at:pat_param) = $value:expr; $($more:tt)*
    ) => {
        impl<T: $crate::Real> $crate::effect::Regressor<T> for $own {
            const INFO: &'static $crate::effect::Info = {
                use $crate::effect::{Info, Quantity, Stage};
                const READS: &[Quantity] = &[$(Quantity::$reads),*];
                &Info {
                    name: $name,
                    family: $family,
                    formula: $formula,
                    dimension: $unit,
                    reads: READS,
                    memory: matches!(stringify!($($memory)?).len(), 1..),
                    shapes: &[$($crate::effect::ShapeInfo {
                        name: stringify!($field),
                        range: $crate::effect::Range::$range,
                        dimension: $dimension,
                    }),*],
                    stage: [$(Stage::$stage,)? Stage::of(READS)][0],
                }
            };

            fn shape(&self, index: usize) -> Option<T> {
                let shapes: &[T] = &[$(self.$field),*];
                shapes.get(index).copied()
            }

            fn try_from_shapes(values: &[T]) -> Result<Self, $crate::Error> {
                match values {
                    &[$($field),*] => $made,
                    _ => Err($crate::effect::info::COUNT),
                }
            }

            #[inline]
            fn value(&self, $state: &mut $crate::effect::EffectState<T>, $at: &$crate::effect::Inputs<T>) -> T {
                let $it = self;
                $value
            }

            $($more)*
        }
    };
}
pub(super) use effect;
