//! What can be chosen: how discs become geometry, what their fragments do, and how much memory is used.

use std::{fmt, str::FromStr};

/// How spheres become fragments. All give the same picture, bit by bit; they differ in what they cost.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Setup {
    /// A strip of four vertices for each instance.
    Instanced,
    /// Two triangles of a list, whose corners are found from the number of the vertex.
    Pulled,
    /// One triangle of a list around each sphere.
    Triangle,
    /// Quads from mesh shaders, where there are such.
    Mesh,
    /// Small spheres pixel by pixel in a compute shader, larger ones as triangles.
    Compute,
}

/// What fragments do.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Fragment {
    /// One pixel for each sphere, at its centre. **Not exact**: to measure what geometry costs.
    Point,
    /// The whole geometry at the nearest depth of the sphere. **Not exact**: to measure what the test
    /// of the sphere costs.
    Proxy,
    /// The sphere.
    Sphere,
    /// The sphere, with a depth buffer beside that lets hardware leave out fragments before they run.
    SphereEarly,
}

impl Setup {
    /// All there are.
    pub const ALL: [Self; 5] =
        [Self::Instanced, Self::Pulled, Self::Triangle, Self::Mesh, Self::Compute];

    const fn name(self) -> &'static str {
        match self {
            Self::Instanced => "instanced",
            Self::Pulled => "pulled",
            Self::Triangle => "triangle",
            Self::Mesh => "mesh",
            Self::Compute => "compute",
        }
    }
}

impl Fragment {
    /// All there are.
    pub const ALL: [Self; 4] = [Self::Point, Self::Proxy, Self::Sphere, Self::SphereEarly];

    /// Whether pictures are exact.
    #[must_use]
    pub const fn is_exact(self) -> bool {
        matches!(self, Self::Sphere | Self::SphereEarly)
    }

    const fn name(self) -> &'static str {
        match self {
            Self::Point => "point",
            Self::Proxy => "proxy",
            Self::Sphere => "sphere",
            Self::SphereEarly => "sphere-early",
        }
    }
}

impl fmt::Display for Setup {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

impl fmt::Display for Fragment {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

impl FromStr for Setup {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        Self::ALL
            .into_iter()
            .find(|setup| setup.name() == text)
            .ok_or_else(|| format!("{text:?} is none of {}", Self::ALL.map(Self::name).join(", ")))
    }
}

impl FromStr for Fragment {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        Self::ALL
            .into_iter()
            .find(|fragment| fragment.name() == text)
            .ok_or_else(|| format!("{text:?} is none of {}", Self::ALL.map(Self::name).join(", ")))
    }
}

/// Whether what lies behind what is drawn is left out.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Skipping {
    /// Bricks and spheres that are hidden are not drawn: the picture is the same.
    #[default]
    Hidden,
    /// Everything is drawn, to measure what skipping saves.
    Nothing,
}

/// How a renderer draws.
#[derive(Clone, Debug, PartialEq)]
pub struct GpuConfig {
    /// How spheres become fragments; `None` for [`Setup::Compute`] where words of 64 bits can be written at
    /// once, and [`Setup::Triangle`] elsewhere.
    pub setup: Option<Setup>,
    /// What fragments do; `None` for [`Fragment::Sphere`].
    pub fragment: Option<Fragment>,
    /// Whether what is hidden is left out.
    pub skipping: Skipping,
    /// How many bytes of records are kept on the GPU: those of 24 bytes each that were drawn
    /// last. Beside them lie the picture, 64 bytes for each brick in play, and some tens of megabytes
    /// for what is set up in a round.
    pub record_bytes: u64,
    /// The smallest radius that a sphere is drawn with, in pixels. 0, the default, is exact. With 0.71
    /// each sphere covers at least one pixel's centre, so that none is lost.
    pub radius_min_pixels: f32,
}

impl Default for GpuConfig {
    fn default() -> Self {
        Self {
            setup: None,
            fragment: None,
            skipping: Skipping::default(),
            record_bytes: 1 << 30,
            radius_min_pixels: 0.0,
        }
    }
}
