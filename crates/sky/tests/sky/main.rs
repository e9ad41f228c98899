//! Tests of maps of environments.

#[path = "../common/asset.rs"]
mod asset;

mod environment;
