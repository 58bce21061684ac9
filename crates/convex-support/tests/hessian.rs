//! The Hessian of the support value against differences of support points.

use convex_support::glam::{DMat3, DQuat, DVec3};
use convex_support::{
    Affine, Ball, Capsule, Cone, Cuboid, Cylinder, Difference, Ellipsoid, Hint, Hull, InvalidShape, MinkowskiSum,
    Posed, Rounded, SupportMap,
};

type Shape = Box<dyn SupportMap<Vector = DVec3>>;

fn shapes() -> Result<Vec<(&'static str, Shape)>, InvalidShape> {
    let ellipsoid = Ellipsoid::new(DVec3::ONE, DVec3::new(3.0, 1.0, 0.5), DQuat::from_rotation_x(0.3))?;
    let cylinder = Cylinder::<DVec3>::new(2.0, 0.7)?;
    let cone = Cone::<DVec3>::new(1.0, 0.8)?;
    let turned = Posed::new(cylinder, DQuat::from_rotation_z(1.0), DVec3::X)?;
    let sheared = DMat3::from_cols(DVec3::new(1.0, 0.2, 0.0), DVec3::new(-0.4, 2.0, 0.3), DVec3::new(0.0, 0.1, 0.6));
    Ok(vec![
        ("cuboid", Box::new(Cuboid::new(DVec3::ONE)?)),
        ("ellipsoid", Box::new(ellipsoid)),
        ("cylinder", Box::new(cylinder)),
        ("cone", Box::new(cone)),
        ("posed", Box::new(turned)),
        ("rounded", Box::new(Rounded::new(ellipsoid, 0.4)?)),
        ("affine", Box::new(Affine::new(Capsule::<DVec3>::new(1.0, 0.5)?, sheared, DVec3::Z)?)),
        ("sum", Box::new(MinkowskiSum::new(ellipsoid, turned))),
        ("difference", Box::new(Difference::new(cone, ellipsoid))),
        ("hull", Box::new(Hull::new(Ball::new(1.0)?, Rounded::new(cylinder, 0.25)?))),
    ])
}

#[test]
fn hessian_is_the_limit_of_differences() -> Result<(), InvalidShape> {
    let step = 1e-6;
    let mut moved = 0;
    for (name, shape) in shapes()? {
        for i in 0..40 {
            let t = f64::from(i);
            let direction = DVec3::new((1.3 * t).sin() + 0.1, (2.1 * t).cos() - 0.3, (0.7 * t).sin() - 0.2) * 2.0;
            let change = DVec3::new((0.9 * t).cos(), (1.7 * t).sin(), 0.5);
            let at = |s: f64| shape.core_support(direction + change * s, &mut Hint::new());
            let difference = (at(step) - at(-step)) / (2.0 * step);
            for other in [DVec3::new(0.4, (1.1 * t).sin(), (0.3 * t).cos()), DVec3::X, DVec3::Y, DVec3::Z] {
                let [uu, uw, ww] = shape.core_support_hessian(direction, [change, other]);
                assert!((change.dot(difference) - uu).abs() < 1e-6, "{name} {i}: {difference} {uu}");
                assert!((other.dot(difference) - uw).abs() < 1e-6, "{name} {i}: {difference} {uw}");
                let [swapped, _, _] = shape.core_support_hessian(direction, [other, change]);
                assert!((swapped - ww).abs() <= 1e-13, "{name} {i}: {swapped} {ww}");
            }
            moved += usize::from(shape.core_support_hessian(direction, [change; 2])[0] > 0.0);
        }
    }
    assert!(moved > 200, "most of these shapes are curved in most directions, not {moved} of 400");
    Ok(())
}
