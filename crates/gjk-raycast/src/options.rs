//! What the options of all queries have in common.
//!
//! A program that calls a function contains it, whether it ever runs or not. So functions that a query needs rarely are
//! called through a table: a static for each type of vectors, compiled with the library. The default options name the
//! table, and with it all functions in it. Those of `lean` name none, so that a program in which all options are lean
//! has no path to them, and the linker leaves them out. The table is defined beside the search that calls its
//! functions; to the options it is opaque.

use core::fmt;

/// Iterations after which a query gives up. Polytopes and smooth shapes need a dozen. The cap only bounds the time
/// spent on a support map that breaks its laws.
pub(crate) const MAX_ITERATIONS: usize = 200;

/// Options that may be lean.
pub(crate) trait MayBeLean: Sized {
    /// The table of the functions that are left out then.
    type Table: 'static;
    const TABLE: Self::Table;

    /// The table, compiled with the library.
    fn rare() -> Rare<Self>;
}

/// The table of options, or none if they are lean. All tables of one type are the same.
pub(crate) struct Rare<O: MayBeLean>(pub(crate) Option<&'static O::Table>);

impl<O: MayBeLean> Clone for Rare<O> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<O: MayBeLean> Copy for Rare<O> {}

impl<O: MayBeLean> PartialEq for Rare<O> {
    fn eq(&self, other: &Self) -> bool {
        self.0.is_some() == other.0.is_some()
    }
}

impl<O: MayBeLean> fmt::Debug for Rare<O> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(if self.0.is_some() { "Full" } else { "Lean" })
    }
}

/// The method `new` of options, by `Default`, and their methods `with_…`. Each of these sets the field of its
/// argument's name, unless another field is given.
macro_rules! options {
    (@setters $Options:ident: $($with:ident($argument:ident: $Type:ty $(=> $field:ident = $value:expr)?)),*) => {
        impl<V: Vector> $Options<V> {
            $(options! { @ $with($argument: $Type) $($field = $value;)? $argument = $argument; })*
        }
    };
    (@ $with:ident($argument:ident: $Type:ty) $field:ident = $value:expr; $($rest:tt)*) => {
        #[doc = concat!(
            "With [`", stringify!($field), "`](Self::", stringify!($field), ") set to `", stringify!($value), "`."
        )]
        #[must_use]
        pub const fn $with(mut self, $argument: $Type) -> Self {
            self.$field = $value;
            self
        }
    };
    ($Options:ident: $($setters:tt)*) => {
        impl<V: Vector> $Options<V> {
            /// The default options.
            #[must_use]
            pub fn new() -> Self {
                Self::default()
            }
        }

        options! { @setters $Options: $($setters)* }
    };
}

pub(crate) use options;
