//! Forms that a plant is made of, and where a ray meets them.

use glam::DVec3;

/// A solid body.
#[derive(Clone, Copy, Debug)]
pub(super) enum Form {
    /// A box that is turned around z.
    Block {
        center: DVec3,
        half: DVec3,
        /// Sine and cosine of the angle it is turned by.
        turned: (f64, f64),
    },
    /// A cylinder with flat ends.
    Cylinder { foot: DVec3, axis: DVec3, radius: f64 },
    /// A cylinder with a half ball at each end.
    Capsule { foot: DVec3, axis: DVec3, radius: f64 },
    /// A ball that is pressed flat along z.
    Dome { center: DVec3, radius: f64, height: f64 },
}

/// Where a ray meets a body.
#[derive(Clone, Copy, Debug)]
pub(super) struct Hit {
    pub(super) distance: f64,
    /// The direction that the surface faces, towards the start of the ray.
    pub(super) normal: DVec3,
}

impl Form {
    /// A ball around the form.
    pub(super) fn bound(&self) -> (DVec3, f64) {
        match *self {
            Self::Block { center, half, .. } => (center, half.length()),
            Self::Cylinder { foot, axis, radius } => {
                let half = axis.length() * 0.5;
                (foot + axis * 0.5, (half * half + radius * radius).sqrt())
            }
            Self::Capsule { foot, axis, radius } => {
                (foot + axis * 0.5, axis.length() * 0.5 + radius)
            }
            Self::Dome { center, radius, height } => (center, radius.max(height)),
        }
    }

    /// Where a ray that starts outside enters the form. The direction is of length one.
    pub(super) fn hit(&self, eye: DVec3, ray: DVec3) -> Option<Hit> {
        let hit = match *self {
            Self::Block { center, half, turned } => block(eye - center, ray, half, turned),
            Self::Cylinder { foot, axis, radius } => cylinder(eye - foot, ray, axis, radius),
            Self::Capsule { foot, axis, radius } => capsule(eye - foot, ray, axis, radius),
            Self::Dome { center, radius, height } => {
                let flat = DVec3::new(1.0 / radius, 1.0 / radius, 1.0 / height);
                ball((eye - center) * flat, ray * flat).map(|distance| {
                    let normal = ((eye - center) + ray * distance) * flat * flat;
                    Hit { distance, normal: normal / normal.length() }
                })
            }
        };
        hit.filter(|hit| hit.distance > 0.0)
    }
}

fn block(eye: DVec3, ray: DVec3, half: DVec3, (sin, cos): (f64, f64)) -> Option<Hit> {
    let into = |v: DVec3| DVec3::new(v.x * cos + v.y * sin, v.y * cos - v.x * sin, v.z);
    let (eye, ray) = (into(eye), into(ray));
    // Where a direction has a zero, the quotients are infinite, as they should be. They are NaN for
    // a ray that runs in the plane of a side: it does not enter.
    let (first, second) = ((-half - eye) / ray, (half - eye) / ray);
    if first.is_nan() || second.is_nan() {
        return None;
    }
    let near = first.min(second);
    let enter = near.max_element();
    if enter >= first.max(second).min_element() {
        return None;
    }
    let side = if enter == near.x {
        DVec3::new(-ray.x.signum(), 0.0, 0.0)
    } else if enter == near.y {
        DVec3::new(0.0, -ray.y.signum(), 0.0)
    } else {
        DVec3::new(0.0, 0.0, -ray.z.signum())
    };
    let normal = DVec3::new(side.x * cos - side.y * sin, side.y * cos + side.x * sin, side.z);
    Some(Hit { distance: enter, normal })
}

/// Where a ray enters the ball of radius one around the origin.
fn ball(eye: DVec3, ray: DVec3) -> Option<f64> {
    let (a, b, c) = (ray.dot(ray), eye.dot(ray), eye.dot(eye) - 1.0);
    let root = b * b - a * c;
    (root > 0.0).then(|| (-b - root.sqrt()) / a)
}

/// Where a ray enters the infinite cylinder around an axis through the origin: the distance, the
/// place along the axis (0 to 1 within the cylinder), and the normal there.
fn round_side(eye: DVec3, ray: DVec3, axis: DVec3, radius: f64) -> Option<(f64, f64, DVec3)> {
    let length = axis.dot(axis);
    let (along_eye, along_ray) = (eye.dot(axis) / length, ray.dot(axis) / length);
    let (across_eye, across_ray) = (eye - axis * along_eye, ray - axis * along_ray);
    let a = across_ray.dot(across_ray);
    let b = across_eye.dot(across_ray);
    let root = b * b - a * (across_eye.dot(across_eye) - radius * radius);
    if root <= 0.0 || a <= 0.0 {
        return None;
    }
    let distance = (-b - root.sqrt()) / a;
    let normal = (across_eye + across_ray * distance) / radius;
    Some((distance, along_eye + along_ray * distance, normal))
}

fn cylinder(eye: DVec3, ray: DVec3, axis: DVec3, radius: f64) -> Option<Hit> {
    if let Some((distance, along, normal)) = round_side(eye, ray, axis, radius)
        && (0.0..=1.0).contains(&along)
    {
        return Some(Hit { distance, normal });
    }
    // A flat end: the one that faces the start of the ray.
    let steep = ray.dot(axis);
    let end = if steep > 0.0 { DVec3::ZERO } else { axis };
    let distance = (end - eye).dot(axis) / steep;
    let place = eye + ray * distance - end;
    let normal = axis * (-steep.signum() / axis.length());
    (place.dot(place) <= radius * radius).then_some(Hit { distance, normal })
}

fn capsule(eye: DVec3, ray: DVec3, axis: DVec3, radius: f64) -> Option<Hit> {
    let (distance, along, normal) = round_side(eye, ray, axis, radius)?;
    if (0.0..=1.0).contains(&along) {
        return Some(Hit { distance, normal });
    }
    let end = if along < 0.0 { DVec3::ZERO } else { axis };
    let distance = ball((eye - end) / radius, ray / radius)?;
    Some(Hit { distance, normal: (eye - end + ray * distance) / radius })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::synthetic::random::Random;

    fn forms() -> [Form; 4] {
        let (foot, axis, radius) = (DVec3::new(1.0, -0.5, 0.2), DVec3::new(0.4, 1.5, 2.0), 0.6);
        let center = DVec3::new(-0.3, 0.4, 0.9);
        [
            Form::Block { center, half: DVec3::new(0.5, 1.1, 0.8), turned: (0.6, 0.8) },
            Form::Cylinder { foot, axis, radius },
            Form::Capsule { foot, axis, radius },
            Form::Dome { center, radius: 1.2, height: 0.7 },
        ]
    }

    /// Whether a place lies in a form, by definition and not by rays.
    fn contains(form: &Form, place: DVec3) -> bool {
        match *form {
            Form::Block { center, half, turned: (sin, cos) } => {
                let d = place - center;
                let local = DVec3::new(d.x * cos + d.y * sin, d.y * cos - d.x * sin, d.z);
                local.abs().cmple(half).all()
            }
            Form::Cylinder { foot, axis, radius } => {
                let t = (place - foot).dot(axis) / axis.dot(axis);
                (0.0..=1.0).contains(&t) && (place - foot - axis * t).length() <= radius
            }
            Form::Capsule { foot, axis, radius } => {
                let t = ((place - foot).dot(axis) / axis.dot(axis)).clamp(0.0, 1.0);
                (place - foot - axis * t).length() <= radius
            }
            Form::Dome { center, radius, height } => {
                ((place - center) / DVec3::new(radius, radius, height)).length() <= 1.0
            }
        }
    }

    #[test]
    fn rays_along_the_sides_of_a_block_do_not_confuse_it() {
        let form = forms()[0];
        let Form::Block { center, half, .. } = form else { panic!("the first form is a block") };
        let block = Form::Block { center, half, turned: (0.0, 1.0) };
        let eye = center - DVec3::X * 3.0;
        for (shift, expected) in [(0.0, Some(2.5)), (1.0, Some(2.5)), (1.1, None), (1.2, None)] {
            let distance = block.hit(eye + DVec3::Y * shift, DVec3::X).map(|hit| hit.distance);
            assert_eq!(distance, expected, "{shift} beside the middle");
        }
        assert!(block.hit(eye, DVec3::NEG_X).is_none(), "the block lies behind");
    }

    /// Rays march in small steps; a ray enters where it is first inside.
    #[test]
    fn rays_enter_forms_where_marching_finds_them() {
        let mut random = Random::new(3, 3);
        for form in forms() {
            let (center, bound) = form.bound();
            let (mut hits, mut misses) = (0, 0);
            for _ in 0..2000 {
                let eye = center + random.direction() * bound * random.between(1.01, 4.0);
                let aim = center + random.direction() * bound * random.unit() - eye;
                let (reach, ray) = (aim.length() + 2.0 * bound, aim / aim.length());
                let marched = (0..4000)
                    .map(|i| f64::from(i) / 4000.0 * reach)
                    .find(|t| contains(&form, eye + ray * *t));
                match (form.hit(eye, ray), marched) {
                    (Some(hit), Some(distance)) => {
                        hits += 1;
                        let step = reach / 4000.0;
                        assert!(
                            (-1e-9..step * 1.01).contains(&(distance - hit.distance)),
                            "{form:?}"
                        );
                        assert!((hit.normal.length() - 1.0).abs() < 1e-9, "{form:?} {hit:?}");
                        assert!(hit.normal.dot(ray) < 1e-9, "{form:?} {hit:?}");
                        let place = eye + ray * hit.distance;
                        assert!(contains(&form, place - hit.normal * 1e-6), "{form:?} {hit:?}");
                        assert!(!contains(&form, place + hit.normal * 1e-6), "{form:?} {hit:?}");
                    }
                    (Some(hit), None) => {
                        // Only a chord that is shorter than a step escapes the march.
                        let place = eye + ray * (hit.distance + reach / 4000.0);
                        assert!(!contains(&form, place), "{form:?} {hit:?}");
                    }
                    (None, Some(distance)) => panic!("{form:?} is missed at {distance}"),
                    (None, None) => misses += 1,
                }
            }
            assert!(hits > 100 && misses > 100, "{form:?}: {hits} hits, {misses} misses");
        }
    }
}
