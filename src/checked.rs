//! Checked configurations: constructors at run time and at compile time, and stored forms.

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
/// Each becomes a function for any float and, in [`Constant`](crate::Constant), a `const fn` for
/// `f32` and for `f64` with the same body: [`constant!`](crate::constant) calls these. A body
/// names the configuration, not `Self`; `of` and `as_f64` convert a number. The brackets of a helper
/// hold further generics, such as `[, const N: usize]`.
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
            pub(super) fn $helper<T: crate::Real $($generic)*>(
                $($given: $given_type),*
            ) -> $result $helper_body
        )*

        impl<T: crate::Real $(, const $n: usize)?> $config<T $(, $n)?> {
            $(
                $(#[$doc])*
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

/// `Deserialize` of a configuration: reads these fields, refuses others, and returns what the
/// constructors make of the fields.
macro_rules! deserialize_checked {
    ($config:ident<$T:ident> { $($(#[$attribute:meta])* $field:ident: $kind:ty,)+ } => $made:block) => {
        #[cfg(feature = "serde")]
        const _: () = {
            #[derive(serde::Deserialize)]
            #[serde(
                deny_unknown_fields,
                bound(deserialize = "T: crate::Real + serde::Deserialize<'de>")
            )]
            struct Stored<$T> {
                $($(#[$attribute])* $field: $kind,)+
            }

            impl<'de, $T> serde::Deserialize<'de> for $config<$T>
            where
                $T: crate::Real + serde::Deserialize<'de>,
            {
                fn deserialize<D: serde::Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
                    let Stored { $($field,)+ } = Stored::<$T>::deserialize(from)?;
                    let made = || -> Result<Self, crate::Error> { $made };
                    made().map_err(serde::de::Error::custom)
                }
            }
        };
    };
}
pub(crate) use deserialize_checked;
