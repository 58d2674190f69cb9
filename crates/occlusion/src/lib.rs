//! occlusion
