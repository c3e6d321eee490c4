//! Stored forms: a configuration deserialises through its checks.

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
