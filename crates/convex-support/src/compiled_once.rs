//! Functions that are compiled once, here, and not in every program that asks a question.
//!
//! The machine code of a generic function is made where its types become known, in the crate that calls it, at each of
//! that crate's builds. What depends on the type of the vectors alone, of which there are five
//! ([`Vector`](crate::Vector) is sealed), is made here instead: trees and hulls are built, and the searches of
//! `gjk-raycast` know their bodies only behind pointers. What is left to a caller's crate is short: the shapes' own
//! methods, and the closed forms that are tried before a search.

use core::any::{Any, TypeId};

use glam::{DVec2, Vec2, Vec3, Vec3A};

use crate::Vector;

/// Of five tables, for [`Vec2`], [`Vec3`], [`Vec3A`], [`DVec2`] and [`DVec3`](glam::DVec3), the one for `V`.
///
/// These are comparisons of types and no loop, which the compiler would leave as it is, and all five tables in the
/// program, where it is told to keep code small.
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

/// Declares a function whose body is compiled for each type of vector here; a call finds the one for its own.
///
/// Which of the five it is, the compiler knows where it is called, and leaves the others out. That is a function of its
/// own: within its callers it would have them save registers for a search that the first look at a pair mostly spares.
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
            use $crate::glam::{DVec2, DVec3, Vec2, Vec3, Vec3A};
            fn once<$V: $crate::Vector>($($argument: $T),*) -> $R $body
            struct Compiled<$V: $crate::Vector>(fn($($T),*) -> $R);
            static VEC2: Compiled<Vec2> = Compiled(once::<Vec2>);
            static VEC3: Compiled<Vec3> = Compiled(once::<Vec3>);
            static VEC3A: Compiled<Vec3A> = Compiled(once::<Vec3A>);
            static DVEC2: Compiled<DVec2> = Compiled(once::<DVec2>);
            static DVEC3: Compiled<DVec3> = Compiled(once::<DVec3>);
            let found: &Compiled<$V> = $crate::of_vectors::<$V, _>([&VEC2, &VEC3, &VEC3A, &DVEC2, &DVEC3]);
            found.0($($argument),*)
        }
    };
}
