//! The parts of a search beyond its leanest form, and how options name them.
//!
//! A program that calls a function contains it, whether it ever runs or not. So parts that a query needs rarely are
//! called through a table of functions: a `static` for each type of vectors, compiled with the library. The options
//! made by `new` name the table, and with it all functions in it. Those of `lean` name none, so that a program in which
//! all options are lean has no path to them, and the linker leaves them out. Each query has a table of its own, which
//! names those of the searches that it consists of.

use core::fmt;

/// The table of a query, or none. All tables of one type are the same.
pub(crate) struct Extra<T: 'static>(Option<&'static T>);

impl<T> Extra<T> {
    pub(crate) const NONE: Self = Self(None);

    #[inline(always)]
    pub(crate) const fn of(table: &'static T) -> Self {
        Self(Some(table))
    }

    #[inline(always)]
    pub(crate) const fn get(self) -> Option<&'static T> {
        self.0
    }

    /// A table that this one names.
    #[inline(always)]
    pub(crate) fn part<U>(self, of: impl FnOnce(&'static T) -> &'static U) -> Extra<U> {
        Extra(self.0.map(of))
    }
}

impl<T> Clone for Extra<T> {
    #[inline(always)]
    fn clone(&self) -> Self {
        *self
    }
}

impl<T> Copy for Extra<T> {}

impl<T> PartialEq for Extra<T> {
    fn eq(&self, other: &Self) -> bool {
        self.0.is_some() == other.0.is_some()
    }
}

impl<T> fmt::Debug for Extra<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(if self.0.is_some() { "Full" } else { "Lean" })
    }
}

/// Makes the method that finds the table of a type of vectors, the associated constant `TABLE`, of which there is one
/// in the library.
macro_rules! in_static {
    ($Table:ident) => {
        impl<V: convex_support::Vector> $Table<V> {
            /// All that the table has.
            #[inline(always)]
            pub(crate) fn named() -> $crate::extra::Extra<Self> {
                use convex_support::glam::{DVec2, DVec3, Vec2, Vec3, Vec3A};
                static VEC2: $Table<Vec2> = $Table::TABLE;
                static VEC3: $Table<Vec3> = $Table::TABLE;
                static VEC3A: $Table<Vec3A> = $Table::TABLE;
                static DVEC2: $Table<DVec2> = $Table::TABLE;
                static DVEC3: $Table<DVec3> = $Table::TABLE;
                let all: [&'static dyn core::any::Any; 5] = [&VEC2, &VEC3, &VEC3A, &DVEC2, &DVEC3];
                $crate::extra::Extra::of(convex_support::of_vectors::<V, _>(all))
            }
        }
    };
}

pub(crate) use in_static;
