//! Methods that are compared.

use hairline_published::sine_integral::SineIntegral;
use hairline_published::{Method, PublishedMethod, Structure};
use serde::Serialize;

/// A method with its switches: the talk's columns, the talk's exact sine integral, and ours.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum BenchMethod {
    /// Published, without anti-aliasing, by the hierarchy.
    PointBvh,
    /// Published, without anti-aliasing, by lists for each triangle.
    PointLists,
    /// Published, with anti-aliasing, by the hierarchy.
    Filtered,
    /// `Filtered` with the exact sine integral.
    FilteredExact,
    Ours,
}

impl BenchMethod {
    pub const ALL: [Self; 5] = [
        Self::PointBvh,
        Self::PointLists,
        Self::Filtered,
        Self::FilteredExact,
        Self::Ours,
    ];

    pub fn name(self) -> &'static str {
        match self {
            Self::PointBvh => "published, AA off, BVH",
            Self::PointLists => "published, AA off, per triangle",
            Self::Filtered => "published, AA on, BVH",
            Self::FilteredExact => "published, AA on, BVH, exact Si",
            Self::Ours => "ours",
        }
    }

    /// Ours always has it.
    pub fn antialiasing(self) -> bool {
        !matches!(self, Self::PointBvh | Self::PointLists)
    }

    pub fn method(self) -> Method {
        let usual = PublishedMethod::default();
        let published = |switches| Method {
            published: Some(switches),
            ..Method::PUBLISHED
        };
        let point = PublishedMethod {
            anti_aliasing: false,
            ..usual
        };
        match self {
            Self::PointBvh => published(point),
            Self::PointLists => published(PublishedMethod {
                structure: Structure::TriangleLists,
                ..point
            }),
            Self::Filtered => Method::PUBLISHED,
            Self::FilteredExact => published(PublishedMethod {
                si: SineIntegral::Exact,
                ..usual
            }),
            Self::Ours => Method::default(),
        }
    }
}
