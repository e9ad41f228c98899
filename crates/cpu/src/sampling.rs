//! Directions towards lights and into an environment, drawn at random: what shadow rays and the Monte Carlo renderer go along.

pub mod environment;
pub mod lights;
