//! Functions that are compiled once, here, and not in every program that calls them.
//!
//! The machine code of a generic function is made where its types become known, in the calling crate, at each of its
//! builds. Functions that depend on the type of the vectors alone, of which there are five ([`Vector`](crate::Vector)
//! is sealed), are compiled here instead: trees and hulls are built here, and the searches of `gjk-raycast` use their
//! bodies only behind pointers. The rest in a caller's crate is short: the shapes' own methods, and the closed forms
//! that are tried before a search.

use core::any::{Any, TypeId};

use glam::{DVec2, Vec2, Vec3, Vec3A};

use crate::Vector;

/// The table for `V` of five, for [`Vec2`], [`Vec3`], [`Vec3A`], [`DVec2`] and [`DVec3`](glam::DVec3).
///
/// It compares types without a loop: if told to keep code small, the compiler would leave a loop as it is, and all five
/// tables in the program.
#[doc(hidden)]
#[inline(always)]
pub fn of_vectors<V: Vector, T: 'static>([vec2, vec3, vec3a, dvec2, dvec3]: [&'static dyn Any; 5]) -> &'static T {
    let of = TypeId::of::<V>();
    let found = match () {
        () if of == TypeId::of::<Vec2>() => vec2,
        () if of == TypeId::of::<Vec3>() => vec3,
        () if of == TypeId::of::<Vec3A>() => vec3a,
        () if of == TypeId::of::<DVec2>() => dvec2,
        () => dvec3,
    };
    found.downcast_ref().expect("`Vector` is sealed, and these are its types")
}

/// The constant `TABLE` of a type that is generic over vectors, a table, in a static of this crate for each type of
/// vectors.
#[doc(hidden)]
#[macro_export]
macro_rules! compiled_table {
    ($Table:ident<$V:ident> of $Of:ident) => {{
        use $crate::glam::{DVec2, DVec3, Vec2, Vec3, Vec3A};
        static VEC2: $Table<Vec2> = $Of::<Vec2>::TABLE;
        static VEC3: $Table<Vec3> = $Of::<Vec3>::TABLE;
        static VEC3A: $Table<Vec3A> = $Of::<Vec3A>::TABLE;
        static DVEC2: $Table<DVec2> = $Of::<DVec2>::TABLE;
        static DVEC3: $Table<DVec3> = $Of::<DVec3>::TABLE;
        $crate::of_vectors::<$V, $Table<$V>>([&VEC2, &VEC3, &VEC3A, &DVEC2, &DVEC3])
    }};
}

/// Declares a function whose body is compiled here for each type of vector; a call selects that of its own type.
///
/// The compiler knows the type at the call, and leaves the others out. The selection is a function of its own: inlined,
/// it would make callers save registers for a search that the first test of a pair mostly avoids.
#[doc(hidden)]
#[macro_export]
macro_rules! compiled_once {
    (
        $(#[$attribute:meta])*
        $visibility:vis fn $name:ident<$V:ident>($($argument:ident: $T:ty),* $(,)?) -> $R:ty $body:block
    ) => {
        $(#[$attribute])*
        #[allow(clippy::type_complexity, reason = "the type is written once")]
        #[inline(never)]
        $visibility fn $name<$V: $crate::Vector>($($argument: $T),*) -> $R {
            fn once<$V: $crate::Vector>($($argument: $T),*) -> $R $body
            struct Compiled<$V: $crate::Vector>(fn($($T),*) -> $R);
            impl<$V: $crate::Vector> Compiled<$V> {
                const TABLE: Self = Self(once::<$V>);
            }
            $crate::compiled_table!(Compiled<$V> of Compiled).0($($argument),*)
        }
    };
}
