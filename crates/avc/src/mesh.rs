//! Meshes: the geometry of a form as a list, to be looked at, exported or tested.

use crate::{Glyph, Size};
use glam::Vec3;
use std::collections::HashMap;

/// The geometry of one glyph.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    /// The vertices, relative to the position of the record.
    pub vertices: Vec<Vec3>,
    /// Triangles of these, counterclockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
}

impl Mesh {
    /// All of a form.
    #[must_use]
    pub fn of<G: Glyph>(form: &G::Form<'_>) -> Self {
        let Size { vertices, triangles } = G::size(form);
        if triangles == 0 {
            return Self::default();
        }
        Self {
            vertices: (0..vertices).map(|vertex| G::vertex(form, vertex)).collect(),
            triangles: (0..triangles).map(|triangle| G::triangle(form, triangle)).collect(),
        }
    }

    /// Checks that it is closed and that its triangles look outwards: each edge belongs to two
    /// triangles that go along it in opposite directions, and the volume within is not negative.
    ///
    /// # Errors
    ///
    /// What is wrong, in words.
    pub fn check(&self) -> Result<(), String> {
        let mut edges: HashMap<[u32; 2], i32> = HashMap::new();
        let mut uses: HashMap<[u32; 2], u32> = HashMap::new();
        for (index, &[a, b, c]) in self.triangles.iter().enumerate() {
            if [a, b, c].iter().any(|&vertex| vertex as usize >= self.vertices.len()) {
                return Err(format!(
                    "triangle {index} has a vertex that is not there: {:?}",
                    [a, b, c]
                ));
            }
            if a == b || b == c || c == a {
                return Err(format!("triangle {index} has a vertex twice: {:?}", [a, b, c]));
            }
            for [from, to] in [[a, b], [b, c], [c, a]] {
                let key = [from.min(to), from.max(to)];
                *edges.entry(key).or_default() += if from < to { 1 } else { -1 };
                *uses.entry(key).or_default() += 1;
            }
        }
        let mut odd = uses.iter().filter(|(edge, uses)| **uses != 2 || edges[*edge] != 0);
        if let Some((edge, uses)) = odd.next() {
            return Err(format!(
                "edge {edge:?} belongs to {uses} triangles, in the wrong directions"
            ));
        }
        if let Some(vertex) = self.vertices.iter().find(|vertex| !vertex.is_finite()) {
            return Err(format!("vertex {vertex} is not finite"));
        }
        let volume = self.volume();
        let size = self.vertices.iter().fold(0.0_f64, |size, v| size.max(v.as_dvec3().length()));
        if volume < -1e-5 * size.powi(3) {
            return Err(format!("it is inside out: its volume is {volume}"));
        }
        Ok(())
    }

    /// The volume within.
    #[must_use]
    pub fn volume(&self) -> f64 {
        let six = |&[a, b, c]: &[u32; 3]| {
            let [a, b, c] = [a, b, c].map(|vertex| self.vertices[vertex as usize].as_dvec3());
            a.dot(b.cross(c))
        };
        self.triangles.iter().map(six).sum::<f64>() / 6.0
    }
}
