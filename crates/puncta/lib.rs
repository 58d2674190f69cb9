//! facade
pub use puncta_core as core;
