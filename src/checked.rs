//! Checked configurations: run-time and compile-time constructors, and serialised forms.

/// The checked constructors of a configuration.
///
/// ```text
/// checked! {
///     Config<T>;                       or Config<T, N>;
///     fn helper[](argument: Type) -> Type { … }
///     pub fn try_new(argument: T) { … }
///     pub fn with_more[self config](argument: T) { … }
/// }
/// ```
/// Each constructor becomes a generic function and, in [`Constant`](crate::Constant), two
/// `const fn` with the same body, for `f32` and `f64`. [`constant!`](crate::constant) calls these.
/// A body uses the name of the configuration instead of `Self`. It contains no `?` and no `for`,
/// because they are not constant. `of` and `as_f64` convert a number. The brackets of a helper
/// contain further generics, such as `[, const N: usize]`.
macro_rules! checked {
    (
        $config:ident<T $(, $n:ident)?>;
        $(fn $helper:ident[$($generic:tt)*]($($given:ident: $given_type:ty),*) -> $result:ty
            $helper_body:block)*
        $(
            $(#[$doc:meta])*
            pub fn $name:ident $([$this:ident $it:ident])? ($($arg:ident: $kind:ty),*) $body:block
        )+
    ) => {
        $(
            #[allow(clippy::question_mark)]
            pub(super) fn $helper<T: crate::Real $($generic)*>(
                $($given: $given_type),*
            ) -> $result $helper_body
        )*

        impl<T: crate::Real $(, const $n: usize)?> $config<T $(, $n)?> {
            $(
                $(#[$doc])*
                #[allow(clippy::question_mark)]
                pub fn $name($($this,)? $($arg: $kind),*) -> Result<Self, crate::Error> {
                    $(let $it = $this;)?
                    $body
                }
            )+
        }

        crate::checked! {
            @ f32, $config<T $(, $n)?>, [$(const $n: usize)?]
            $(fn $helper[$($generic)*]($($given: $given_type),*) -> $result $helper_body)*
            $(pub fn $name($($it: $config<T>,)? $($arg: $kind),*) $body)+
        }
        crate::checked! {
            @ f64, $config<T $(, $n)?>, [$(const $n: usize)?]
            $(fn $helper[$($generic)*]($($given: $given_type),*) -> $result $helper_body)*
            $(pub fn $name($($it: $config<T>,)? $($arg: $kind),*) $body)+
        }
    };

    (
        @ $float:ty, $config:ty, [$($n:tt)*]
        $(fn $helper:ident[$(, $($generic:tt)+)?]($($given:tt)*) -> $result:ty $helper_body:block)*
        $(pub fn $name:ident($($arg:tt)*) $body:block)+
    ) => {
        #[allow(dead_code, clippy::cast_possible_truncation, clippy::cast_lossless)]
        const _: () = {
            type T = $float;
            const fn of(x: f64) -> T {
                x as T
            }
            const fn as_f64(x: T) -> f64 {
                x as f64
            }
            $(const fn $helper<$($($generic)+)?>($($given)*) -> $result $helper_body)*

            impl<$($n)*> crate::Constant<$config> {
                $(
                    #[doc(hidden)]
                    pub const fn $name($($arg)*) -> Result<$config, crate::Error> $body
                )+
            }
        };
    };
}
pub(crate) use checked;

/// Plain data: the derived traits and the serialised form of such a type.
///
/// Deserialising rejects unknown fields. The names of variants are in kebab case. Write `<T: Real>`
/// if the serialised form of a field requires this bound on `T`; the type itself does not.
macro_rules! data {
    () => {};
    (
        $(#[$attr:meta])*
        $vis:vis $kind:ident $name:ident $(<T $(: $real:ident)? $(, const $n:ident: usize)?>)?
        { $($body:tt)* }
        $($more:tt)*
    ) => {
        crate::data! {
            @ $kind [$($($real)?)?]
            $(#[$attr])* $vis $kind $name $(<T $(, const $n: usize)?>)? { $($body)* }
        }
        crate::data! { $($more)* }
    };
    (@ enum $real:tt $($item:tt)+) => {
        crate::data! { @ $real [rename_all = "kebab-case", deny_unknown_fields] $($item)+ }
    };
    (@ struct $real:tt $($item:tt)+) => {
        crate::data! { @ $real [deny_unknown_fields] $($item)+ }
    };
    (@ [Real] [$($serde:tt)*] $($item:tt)+) => {
        crate::data! {
            @ []
            [$($serde)*, bound(
                serialize = "T: crate::Real + serde::Serialize",
                deserialize = "T: crate::Real + serde::Deserialize<'de>"
            )]
            $($item)+
        }
    };
    (@ [] [$($serde:tt)*] $($item:tt)+) => {
        #[derive(Debug, Clone, Copy, PartialEq)]
        #[cfg_attr(
            feature = "serde",
            derive(serde::Serialize, serde::Deserialize),
            serde($($serde)*)
        )]
        #[cfg_attr(feature = "defmt", derive(defmt::Format))]
        $($item)+
    };
}
pub(crate) use data;

/// A configuration or a state, and its serialised form.
///
/// Deserialising reads the fields and rejects unknown ones. The block after `=>` makes the value
/// from the fields. Without a block, the fields are the value, and all numbers must be finite.
macro_rules! stored {
    (
        $(#[doc = $doc:expr])*
        $(#[derive($($derive:ident),+)])?
        $vis:vis struct $name:ident<T $(, const $n:ident: usize)?> {
            $(
                $(#[doc = $field_doc:expr])*
                $(#[serde($($serde:tt)*)])?
                $field_vis:vis $field:ident: $kind:ty,
            )+
        }
        $(=> $made:block)?
    ) => {
        $(#[doc = $doc])*
        #[derive(Debug, Clone, Copy, PartialEq $(, $($derive),+)?)]
        #[cfg_attr(
            feature = "serde",
            derive(serde::Serialize),
            serde(bound(serialize = "T: crate::Real + serde::Serialize"))
        )]
        #[cfg_attr(feature = "defmt", derive(defmt::Format))]
        $vis struct $name<T $(, const $n: usize)?> {
            $(
                $(#[doc = $field_doc])*
                $(#[cfg_attr(feature = "serde", serde($($serde)*))])?
                $field_vis $field: $kind,
            )+
        }

        impl<T: crate::Real $(, const $n: usize)?> crate::checked::Finite for $name<T $(, $n)?> {
            fn all_finite(&self) -> bool {
                true $(&& crate::checked::Finite::all_finite(&self.$field))+
            }
        }

        #[cfg(feature = "serde")]
        const _: () = {
            #[derive(serde::Deserialize)]
            #[serde(
                deny_unknown_fields,
                bound(deserialize = "T: crate::Real + serde::Deserialize<'de>")
            )]
            struct Stored<T $(, const $n: usize)?> {
                $(
                    $(#[serde($($serde)*)])?
                    $field: $kind,
                )+
            }

            #[allow(unused_imports, unused_variables)]
            impl<'de, T $(, const $n: usize)?> serde::Deserialize<'de> for $name<T $(, $n)?>
            where
                T: crate::Real + serde::Deserialize<'de>,
            {
                fn deserialize<D: serde::Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
                    use crate::checked::finite;
                    let Stored { $($field,)+ } = Stored::<T $(, $n)?>::deserialize(from)?;
                    let made = || -> Result<Self, crate::Error> {
                        $(return $made;)?
                        #[allow(unreachable_code)]
                        finite(Self { $($field,)+ })
                    };
                    made().map_err(serde::de::Error::custom)
                }
            }
        };
    };
}
pub(crate) use stored;

/// Whether all numbers of a state are finite. A NaN or an infinity could persist indefinitely.
#[cfg_attr(not(any(feature = "serde", kani)), allow(dead_code))]
pub(crate) trait Finite {
    fn all_finite(&self) -> bool;
}

impl<T: crate::Real> Finite for T {
    #[inline]
    fn all_finite(&self) -> bool {
        self.is_finite()
    }
}

impl<X: Finite> Finite for Option<X> {
    #[inline]
    fn all_finite(&self) -> bool {
        self.as_ref().is_none_or(X::all_finite)
    }
}

impl<X: Finite, const N: usize> Finite for [X; N] {
    #[inline]
    fn all_finite(&self) -> bool {
        self.iter().all(X::all_finite)
    }
}

impl<T: crate::Real> Finite for crate::effect::Motion<T> {
    fn all_finite(&self) -> bool {
        [self.position, self.velocity, self.acceleration].all_finite()
    }
}

/// Types without numbers, and types that are checked when they are deserialised.
macro_rules! finite_anyway {
    ($([$($generic:tt)*] $kind:ty;)+) => {
        $(impl<$($generic)*> Finite for $kind {
            fn all_finite(&self) -> bool {
                true
            }
        })+
    };
}
finite_anyway! {
    [] bool;
    [] u16;
    [] u32;
    [] i32;
    [] crate::control::status::Latch;
    [] crate::control::End;
    [] crate::transmission::Mode;
    [T] crate::hysteresis::BoucWen<T>;
    [T] crate::hysteresis::BoucWenState<T>;
}

/// A state, if all its numbers are finite.
#[cfg(feature = "serde")]
pub(crate) fn finite<S: Finite>(state: S) -> Result<S, crate::Error> {
    if state.all_finite() {
        Ok(state)
    } else {
        Err(crate::Error::NonFinite("state"))
    }
}

/// Default longest `dt` of a serialised form: no limit.
#[cfg(feature = "serde")]
pub(crate) fn any_dt<T: crate::Real>() -> T {
    T::HIGHEST
}

/// The serialised form of a configuration that is made from its settings, which are another type.
macro_rules! stored_as {
    ($name:ident<T $(, $n:ident)?> as $form:ty: |$it:ident| $to:expr, $from:expr) => {
        #[cfg(feature = "serde")]
        const _: () = {
            impl<T $(, const $n: usize)?> serde::Serialize for $name<T $(, $n)?>
            where
                T: crate::Real + serde::Serialize,
            {
                fn serialize<S: serde::Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
                    let $it = self;
                    <$form as serde::Serialize>::serialize(&$to, to)
                }
            }

            impl<'de, T $(, const $n: usize)?> serde::Deserialize<'de> for $name<T $(, $n)?>
            where
                T: crate::Real + serde::Deserialize<'de>,
            {
                fn deserialize<D: serde::Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
                    let form = <$form as serde::Deserialize>::deserialize(from)?;
                    $from(form).map_err(serde::de::Error::custom)
                }
            }
        };
    };
}
pub(crate) use stored_as;
