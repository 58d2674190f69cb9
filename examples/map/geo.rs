/*!
`GeoJSON` files: polygons with a height.

Longitudes and latitudes are laid flat around the middle of the file: east is a longitude times the
cosine of the middle latitude, in metres. That is right for a town, and distorts a continent.
*/

use super::footprint::{Footprint, Sort};
use anyhow::{Context, Result, bail, ensure};
use geojson::{Feature, GeoJson, Geometry, GeometryValue, JsonObject, JsonValue, Position};
use std::{collections::BTreeMap, path::Path};

/// The mean radius of the earth, in metres.
const EARTH: f64 = 6_371_008.8;

/// Where heights are looked for unless one name is given, and what one unit of it measures.
const HEIGHTS: [(&str, f64); 6] = [
    ("height", 1.0),
    ("building:height", 1.0),
    ("HEIGHT", 1.0),
    ("building:levels", 3.0),
    ("levels", 3.0),
    ("num_floors", 3.0),
];

/// Where the lower end is looked for.
const BASES: [(&str, f64); 3] =
    [("min_height", 1.0), ("building:min_height", 1.0), ("building:min_level", 3.0)];

/// What has no height rises so far.
const FLAT: f64 = 4.0;

/// The footprints of a file.
#[derive(Debug)]
pub(crate) struct Map {
    pub(crate) footprints: Vec<Footprint>,
    /// The longitude and latitude of the middle.
    pub(crate) middle: [f64; 2],
    /// What was left out or guessed, in words.
    pub(crate) notes: Vec<String>,
}

/// Polygons in degrees, and from where to where they rise.
struct Shape {
    rings: Vec<Vec<[f64; 2]>>,
    heights: [f64; 2],
}

/// Reads a file. `height` names the property that heights come from.
pub(crate) fn read(path: &Path, height: Option<&str>) -> Result<Map> {
    let name = || path.display().to_string();
    let bytes = std::fs::read(path).with_context(name)?;
    let text = std::str::from_utf8(&bytes).with_context(name)?;
    let json: GeoJson = text.parse().with_context(name)?;
    let mut reader = Reader { height, shapes: vec![], counts: BTreeMap::new(), has_height: false };
    match json {
        GeoJson::Geometry(geometry) => reader.geometry(&geometry, None),
        GeoJson::Feature(feature) => reader.feature(&feature),
        GeoJson::FeatureCollection(all) => {
            for feature in &all.features {
                reader.feature(feature);
            }
        }
    }
    let told = || reader.counts.iter().map(|(what, count)| format!("{count} {what}"));
    if reader.shapes.is_empty() {
        let told: String = told().map(|note| format!("; {note}")).collect();
        bail!("{}: there is no polygon in it{told}", name());
    }
    if let (Some(height), false) = (height, reader.has_height) {
        bail!("{}: no polygon has a property {height:?} that is a height", name());
    }
    let notes = told().collect();
    let middle = middle(&reader.shapes);
    let footprints: Vec<Footprint> =
        reader.shapes.into_iter().map(|shape| shape.laid_flat(middle)).collect();
    ensure!(!footprints.is_empty(), "{}: there is nothing in it", name());
    Ok(Map { footprints, middle, notes })
}

struct Reader<'a> {
    height: Option<&'a str>,
    shapes: Vec<Shape>,
    /// How many there are of each sort that is told.
    counts: BTreeMap<&'static str, u64>,
    has_height: bool,
}

impl Reader<'_> {
    fn count(&mut self, what: &'static str) {
        *self.counts.entry(what).or_default() += 1;
    }

    fn feature(&mut self, feature: &Feature) {
        match &feature.geometry {
            Some(geometry) => self.geometry(geometry, feature.properties.as_ref()),
            None => self.count("features without a geometry left out"),
        }
    }

    fn geometry(&mut self, geometry: &Geometry, properties: Option<&JsonObject>) {
        match &geometry.value {
            GeometryValue::Polygon { coordinates } => self.polygon(coordinates, properties),
            GeometryValue::MultiPolygon { coordinates } => {
                for polygon in coordinates {
                    self.polygon(polygon, properties);
                }
            }
            GeometryValue::GeometryCollection { geometries } => {
                for geometry in geometries {
                    self.geometry(geometry, properties);
                }
            }
            GeometryValue::Point { .. } | GeometryValue::MultiPoint { .. } => {
                self.count("points left out");
            }
            GeometryValue::LineString { .. } | GeometryValue::MultiLineString { .. } => {
                self.count("lines left out");
            }
        }
    }

    fn polygon(&mut self, rings: &[Vec<Position>], properties: Option<&JsonObject>) {
        let mut kept: Vec<Vec<[f64; 2]>> = Vec::new();
        for (index, ring) in rings.iter().enumerate() {
            let points: Option<Vec<[f64; 2]>> =
                ring.iter().map(|position| degrees(position.as_slice())).collect();
            let Some(mut points) = points else {
                return self.count("polygons left out: a position is no longitude and latitude");
            };
            points.dedup();
            if points.len() > 1 && points.first() == points.last() {
                points.pop();
            }
            match (points.len() >= 3, index) {
                (true, _) => kept.push(points),
                (false, 0) => {
                    return self.count("polygons left out: they have less than 3 corners");
                }
                (false, _) => self.count("holes left out: they have less than 3 corners"),
            }
        }
        if kept.is_empty() {
            return self.count("polygons left out: they have no outline");
        }
        let names: &[(&str, f64)] = match &self.height {
            Some(name) => &[(*name, 1.0)],
            None => &HEIGHTS,
        };
        let top = find(properties, names).filter(|top| *top > 0.0);
        self.has_height |= top.is_some();
        if top.is_none() {
            self.count("polygons have no height");
        }
        let base = find(properties, &BASES).unwrap_or(0.0);
        let top = top.unwrap_or(base + FLAT);
        let base = if base < top { base } else { 0.0 };
        self.shapes.push(Shape { rings: kept, heights: [base, top] });
    }
}

/// A longitude and a latitude.
fn degrees(position: &[f64]) -> Option<[f64; 2]> {
    let [longitude, latitude] = position.first_chunk().copied()?;
    let is_place = (-360.0..=360.0).contains(&longitude) && (-90.0..=90.0).contains(&latitude);
    is_place.then_some([longitude, latitude])
}

/// The first of some properties that is a number, or a text that begins with one.
fn find(properties: Option<&JsonObject>, names: &[(&str, f64)]) -> Option<f64> {
    names.iter().find_map(|(name, unit)| {
        let number = match properties?.get(*name)? {
            JsonValue::Number(number) => number.as_f64()?,
            JsonValue::String(text) => {
                let text = text.trim();
                let end = text.find(|c: char| !(c.is_ascii_digit() || "+-.".contains(c)));
                text.get(..end.unwrap_or(text.len()))?.parse().ok()?
            }
            _ => return None,
        };
        Some(number * unit).filter(|height| height.is_finite())
    })
}

/// The middle of the box around all shapes.
fn middle(shapes: &[Shape]) -> [f64; 2] {
    [0, 1].map(|axis| {
        let all =
            || shapes.iter().flat_map(|shape| &shape.rings).flatten().map(|point| point[axis]);
        let (low, high) =
            (all().fold(f64::INFINITY, f64::min), all().fold(f64::NEG_INFINITY, f64::max));
        low + (high - low) * 0.5
    })
}

impl Shape {
    fn laid_flat(self, [longitude, latitude]: [f64; 2]) -> Footprint {
        let east = EARTH * latitude.to_radians().cos();
        let flat = |[x, y]: [f64; 2]| {
            [east * (x - longitude).to_radians(), EARTH * (y - latitude).to_radians()]
        };
        let ring = |ring: Vec<[f64; 2]>| ring.into_iter().map(flat).collect();
        let rings = self.rings.into_iter().map(ring).collect();
        Footprint { rings, heights: self.heights, sort: Sort::House }
    }
}
