/*!
The hall: laser scans of an industrial hall from several places, as a survey delivers them.

Scanners stand in the hall and turn; each sends rays in columns of equal angles, and a ray returns
the first surface it meets. So density falls off with the square of the distance and with the slant
of the surface, things throw shadows, and floor and roof near a scanner are far denser than others.
Points carry the color of the paint, with dirt and shade, and the `intensity` of the returned light
(0 to 1). Distances have an error of `noise` meters, in the mean.

Lengths are meters, z is up. Coordinates are those of a survey: the middle of the hall's floor lies
at (350000, 5800000, 110), which is the origin of the scene; the hall is 60 m by 24 m, and 10.5 m
high. A few points (`strays`) lie up to 50 lengths of the hall outside, as false returns do, so the
bounding box tells nothing of the hall; they are spread over the file.

The default radius shrinks with the root of `n`, since points lie on surfaces.
*/

mod form;
mod kit;
mod plant;
mod scan;

use super::{
    Make, Row,
    random::{Random, power, share, single, whole},
    spec::{Domain, Key, Kind, Spec},
};
use glam::DVec3;
use kit::HALF_LENGTH;
use scan::{Point, Scan};

/// Where the middle of the hall's floor lies.
pub(super) const ORIGIN: DVec3 = DVec3::new(350_000.0, 5_800_000.0, 110.0);

/// How far the strays lie from the hall at most, in lengths of the hall.
const STRAY_REACH: f64 = 50.0;

pub(super) const KIND: Kind = Kind {
    name: "hall",
    about: "laser scans of an industrial hall in survey coordinates, with stray points far away",
    keys: &[
        Key::count("2000000"),
        Key::derived(
            "r",
            "40 / sqrt(n)",
            |spec| 40.0 / spec.number("n").sqrt(),
            "radius of the points, in meters",
        ),
        Key::new("noise", Domain::Share, "0.002", "error of distances, in meters"),
        Key::new("strays", Domain::Count { min: 0, max: 1000 }, "20", "points far outside"),
        Key::seed(),
    ],
};

#[derive(Clone, Debug)]
pub(super) struct Hall {
    scan: Scan,
    /// How many points there are in all, and how many have been made.
    count: u64,
    made: u64,
    strays: u64,
    radius: f32,
    random: Random,
}

impl Hall {
    pub(super) fn new(spec: &Spec) -> Self {
        let count = spec.count();
        // A scan of a few points is not to be made of strays.
        let strays = spec.whole("strays").min(count / 10);
        Self {
            scan: Scan::new(spec.seed(), count - strays, spec.number("noise")),
            count,
            made: 0,
            strays,
            radius: spec.radius(),
            random: Random::new(spec.seed(), 2),
        }
    }

    /// Whether the next point is a stray: they are spread evenly over the file.
    fn is_stray(&self) -> bool {
        share(self.strays, self.made + 1, self.count) > share(self.strays, self.made, self.count)
    }

    /// A point far outside; distances are as likely to be ten times as large as any other.
    fn stray(&mut self) -> Point {
        let mut direction = self.random.direction();
        direction.z *= 0.3;
        let reach = 2.0 * HALF_LENGTH * power(STRAY_REACH, self.random.unit());
        let place = direction / direction.length() * reach;
        Point { place, color: [120, 120, 130], intensity: 0.02 }
    }
}

impl Make for Hall {
    const COLORS: bool = true;
    const SCALAR: Option<&'static str> = Some("intensity");

    fn row(&mut self) -> Row {
        let stray = self.is_stray();
        self.made += 1;
        let point = if stray { self.stray() } else { self.scan.point() };
        Row {
            position: point.place.to_array().map(single),
            radius: self.radius,
            color: point.color,
            value: single(point.intensity),
            ..Row::default()
        }
    }
}
